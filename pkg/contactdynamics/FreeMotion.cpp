// SPDX-License-Identifier: GPL-2.0-or-later
#include "FreeMotion.hpp"
#include "BodyCheck.hpp"
#include <core/Cell.hpp>
#include <core/Scene.hpp>
#include <pkg/dem/NewtonIntegrator.hpp>

namespace yade {

IntegratorPlan::IntegratorPlan(const Scene& scene, const NewtonIntegrator& newton)
	: h(scene.dt), gravity(newton.gravity), mask(newton.mask), homoDeform(scene.cell->homoDeform), exactAsphericalRot(newton.exactAsphericalRot),
	  densityScaling(newton.densityScaling), periodic(scene.isPeriodic), prevVelGrad(newton.prevVelGrad)
{
	const Cell& cell = *scene.cell;
	const bool changes = cell.velGradChanged || cell.nextVelGrad != Matrix3r::Zero();
	useVelGrad(changes ? cell.nextVelGrad : cell.velGrad);
}

void IntegratorPlan::useVelGrad(const Matrix3r& gradient)
{
	velGrad = gradient;
	if (periodic) requireFiniteGradient(velGrad);
	velGradChange = velGrad - prevVelGrad;
	const Matrix3r spin = .5 * (velGradChange - velGradChange.transpose());
	spinChange = Vector3r(-spin(1, 2), spin(0, 2), -spin(0, 1));
}

Matrix3r IntegratorPlan::beforeStep(const Matrix3r& gradient) const
{
	return homoDeform > 1 ? Matrix3r((Matrix3r::Identity() + h * prevVelGrad).inverse() * gradient) : gradient;
}

Matrix3r IntegratorPlan::velocityOfDisplacement() const { return periodic && homoDeform ? beforeStep(velGradChange) : Matrix3r(Matrix3r::Zero()); }

std::pair<FreeMotion, Mobility> predictFreeMotion(const Scene& scene, const IntegratorPlan& plan, const Body& body, const Vector3r& force,
												  const Vector3r& torque)
{
	requireUsableState(body, force, torque);
	const State& state = *body.state;
	FreeMotion free;
	Mobility mobility;
	free.velocity = state.vel;
	free.angularVelocity = state.angVel;
	if (plan.mask > 0 && !body.maskCompatible(plan.mask)) { // whatever its velocity says, it stays where it is
		free.velocity = free.angularVelocity = Vector3r::Zero();
		free.moved = false;
	}
#ifdef YADE_MPI
	free.moved = free.moved && scene.subdomain == body.subdomain && !body.getIsSubdomain() && !body.getIsFluidDomainBbox();
#endif
	if (!free.moved) return {free, mobility};
	const Real h = plan.h;
	// The order of operations below is the integrator's: the prediction then differs from it by round-off at most.
	if (body.isDynamic()) {
		const Real scaling = plan.densityScaling ? state.densityScaling : 1;
		requirePositiveScaling(body, scaling);
		free.load = force + state.mass * plan.gravity;
		Vector3r acceleration = Vector3r::Zero();
		for (int axis = 0; axis < 3; axis++) {
			if (state.blockedDOFs & State::axisDOF(axis, false)) continue;
			acceleration[axis] = (force[axis] / state.mass + plan.gravity[axis]) * scaling;
			mobility.inverseMass[axis] = scaling / state.mass;
		}
		if (plan.periodic && plan.homoDeform > 1) acceleration += plan.prevVelGrad * state.vel;
		free.velocity += h * acceleration;

		free.aspherical = plan.exactAsphericalRot && body.isAspherical() && (state.blockedDOFs & State::DOF_RXRYRZ) == State::DOF_NONE;
		if (free.aspherical) {
			const Matrix3r axes = state.ori.toRotationMatrix();
			mobility.inverseInertia = axes * (scaling * state.inertia.cwiseInverse()).asDiagonal() * axes.transpose();
			free.angularMomentum = state.angMom + h * torque;
			free.angularVelocity = mobility.inverseInertia * free.angularMomentum;
		} else {
			Vector3r inverse = Vector3r::Zero();
			for (int axis = 0; axis < 3; axis++)
				if (!(state.blockedDOFs & State::axisDOF(axis, true))) inverse[axis] = scaling / state.inertia[axis];
			mobility.inverseInertia = inverse.asDiagonal();
			free.angularVelocity += h * inverse.cwiseProduct(torque);
		}
		for (int axis = 0; axis < 3; axis++) {
			if (mobility.inverseMass[axis] > 0) free.heldDOFs &= ~State::axisDOF(axis, false);
			if (mobility.inverseInertia(axis, axis) > 0) free.heldDOFs &= ~State::axisDOF(axis, true);
		}
	} else if (plan.periodic && plan.homoDeform > 1) {
		free.velocity += h * plan.prevVelGrad * state.vel;
	}
	if (plan.periodic && plan.homoDeform) {
		free.velocity += plan.velGradChange * state.pos;
		if (!free.aspherical) free.angularVelocity += plan.spinChange;
	}
	return {free, mobility};
}

} // namespace yade
