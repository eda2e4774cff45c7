// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/Body.hpp>
#include <core/State.hpp>
#include <lib/base/Math.hpp>
#include <cstdint>
#include <utility>

namespace yade {

class NewtonIntegrator;
class Scene;

/// What the scene's NewtonIntegrator is about to do in this step, read once. `velGrad` is the gradient it will switch to: a change asked
/// for through O.cell.velGrad takes effect inside the integrator.
struct IntegratorPlan {
	Real h; // time step [s]
	Vector3r gravity;
	int mask;
	int homoDeform;
	bool exactAsphericalRot, densityScaling, periodic;
	Matrix3r velGrad, velGradChange, prevVelGrad; // [1/s]
	Vector3r spinChange;						  // [rad/s]

	IntegratorPlan(const Scene& scene, const NewtonIntegrator& newton);
	/// The same plan with another gradient to switch to.
	void useVelGrad(const Matrix3r& gradient);
	/// What has to be added to a velocity before the step so that a velocity of this gradient is added to it after the step [1/s].
	Matrix3r beforeStep(const Matrix3r& gradient) const;
	/// Velocity before the step that has the same effect on the velocity after it as a displacement before the step, per displacement [1/s]:
	/// the mean field of a periodic cell that changes in this step. Zero otherwise.
	Matrix3r velocityOfDisplacement() const;
};

/// What an impulse changes of a body's velocity: mass and inertia inverted, 0 along blocked degrees of freedom.
struct Mobility {
	Vector3r inverseMass = Vector3r::Zero();	// per global axis [1/kg]
	Matrix3r inverseInertia = Matrix3r::Zero(); // global axes [1/(kg m2)]
};

/// Free motion of one body: its velocity at the end of the step if no contact impulse acted, exactly as the integrator computes it from
/// the forces known so far.
///
/// A body rotated "exactly" (Body.aspherical, no rotation blocked, NewtonIntegrator.exactAsphericalRot) is integrated in its angular
/// momentum. The angular velocity that enters the contact condition is then R I^-1 R^T angMom with the orientation at the start of
/// the step; the angVel the integrator reports afterwards is turned by one step, a difference of order h.
struct FreeMotion {
	Vector3r velocity, angularVelocity;			 // [m/s], [rad/s], global axes
	Vector3r angularMomentum = Vector3r::Zero(); // of aspherical bodies [kg m2/s]; zero otherwise
	Vector3r load = Vector3r::Zero();			 // external force, gravity included [N]
	std::uint8_t heldDOFs = State::DOF_ALL;		 // those that no impulse moves, as in State::blockedDOFs
	bool moved = true;							 // false: the integrator leaves the body alone (mask, other subdomain)
	bool aspherical = false;					 // integrated in angularMomentum
};

/// @param force, torque  total external force and torque on the body, those of clump members included [N], [N m]
/// @throws std::runtime_error  position, velocity, mass or inertia not finite, or mass or inertia not positive along a free degree of
///                             freedom; the message names body, attribute, value and what is allowed.
std::pair<FreeMotion, Mobility> predictFreeMotion(const Scene& scene, const IntegratorPlan& plan, const Body& body, const Vector3r& force,
												  const Vector3r& torque);

} // namespace yade
