// SPDX-License-Identifier: GPL-2.0-or-later
// From the impulses of the sweeps to a feasible point, its velocities and its residual.
#include "GrainOperator.hpp"

#include "BodyView.hpp"
#include "CoulombCone.hpp"

#include <Eigen/Geometry>

namespace contactdynamics {

namespace {

void finishContact(Contact& c, const Vector3& impulse)
{
	c.impulse = impulse;
	const double rn = impulse.dot(c.normal);
	if (!(rn > 0)) {
		c.status = ContactStatus::none;
		return;
	}
	// The projection on the cone leaves round-off only: a friction below its limit by more than that sticks.
	c.status = (impulse - rn * c.normal).norm() < (1 - 1e-9) * c.friction * rn ? ContactStatus::sticking : ContactStatus::sliding;
}

} // namespace

void GrainOperator::collectImpulses()
{
	const auto& contacts = problem->contacts;
	inRuns(packs.size(), [&](std::size_t i) {
		const BallPack& p = packs[i];
		for (int k = 0; k < 4; ++k) {
			if (p.id[k] < 0) continue;
			const Contact& c = contacts[p.id[k]];
			impulses[p.id[k]] = insideCone({p.impulse[0][k], p.impulse[1][k], p.impulse[2][k]}, c.normal, c.friction);
		}
	});
	inRuns(generals.size(), [&](std::size_t i) {
		const GeneralContact& g = generals[i];
		impulses[g.id] = insideCone(g.frame.transpose() * g.impulse, contacts[g.id].normal, g.friction);
	});
}

void GrainOperator::addImpulse(const Contact& c, const Vector3& impulse)
{
	const auto& bodies = problem->bodies;
	if (movable[c.body1]) {
		velocity(stateOf(c.body1)) -= bodies[c.body1].inverseMass.cwiseProduct(impulse);
		angularVelocity(stateOf(c.body1)) -= bodies[c.body1].inverseInertia * c.arm1.cross(impulse);
	}
	if (movable[c.body2]) {
		velocity(stateOf(c.body2)) += bodies[c.body2].inverseMass.cwiseProduct(impulse);
		angularVelocity(stateOf(c.body2)) += bodies[c.body2].inverseInertia * c.arm2.cross(impulse);
	}
}

/// Sum of the speeds that the relative velocity is made of, as sums of components: a bound, without square roots.
double GrainOperator::speedsAt(const Contact& c) const
{
	const BodyState &b1 = stateOf(c.body1), &b2 = stateOf(c.body2);
	const auto size = [](const auto& vector) { return vector.cwiseAbs().sum(); };
	return size(velocity(b1)) + size(velocity(b2)) + size(angularVelocity(b1)) * size(c.arm1) + size(angularVelocity(b2)) * size(c.arm2) +
		   size(c.imageVelocity) + std::abs(c.gapVelocity) + (hasField() ? size(gradient) * size(c.arm1 - c.arm2) : 0);
}

void GrainOperator::freeVelocities()
{
	const auto& bodies = problem->bodies;
	inRuns(bodies.size(), [&](std::size_t i) {
		BodyState& its = stateOf(std::int32_t(i));
		velocity(its) = bodies[i].velocity;
		angularVelocity(its) = bodies[i].angularVelocity;
	});
}

/// Velocities = free velocities + M^-1 H r: no drift of the sweeps is left in them. Colour by colour, so that no two threads meet at a body.
void GrainOperator::rebuildVelocities()
{
	freeVelocities();
	const auto add = [this](std::int32_t id) {
		if (id >= 0 && !impulses[id].isZero(0)) addImpulse(problem->contacts[id], impulses[id]);
	};
	for (const Group& group : groups)
		share(group.lastChunk - group.firstChunk, [&](std::size_t k) {
			const Chunk& chunk = chunks[group.firstChunk + k];
			for (std::size_t i = chunk.firstPack; i < chunk.firstPack + chunk.packs; ++i)
				for (const std::int32_t id : packs[i].id) add(id);
			for (std::size_t i = chunk.firstGeneral; i < chunk.firstGeneral + chunk.generals; ++i) add(generals[i].id);
		});
}

GrainOperator::Sums GrainOperator::certify(std::size_t first, std::size_t last)
{
	Sums result;
	for (std::size_t i = first; i < last; ++i) {
		Contact& c = problem->contacts[i];
		const BodyState &b1 = stateOf(c.body1), &b2 = stateOf(c.body2);
		Vector3 U = velocity(b2) + c.imageVelocity - velocity(b1) + angularVelocity(b2).cross(c.arm2) - angularVelocity(b1).cross(c.arm1);
		if (hasField()) U += gradient * (c.arm1 - c.arm2);
		c.relativeVelocity = U;
		const double rn = impulses[i].dot(c.normal), un = U.dot(c.normal) + c.gapVelocity + c.normalCompliance * rn;
		result.approach = std::max(result.approach, -un);
		if (un >= 0 && rn <= 0) continue; // open and separating: F = 0
		const double speeds = std::min(speedsAt(c), speedLimit);
		if (c.ball && !isCompliant(c)) {
			const double Wn = b1.inverseMass + b2.inverseMass;
			if (!(Wn > 0)) continue;
			const double Wt = Wn + c.arm1.squaredNorm() * b1.inverseInertia + c.arm2.squaredNorm() * b2.inverseInertia;
			const Vector3 rt = impulses[i] - rn * c.normal, ut = U - U.dot(c.normal) * c.normal;
			const auto F = naturalMap<Vector3>({rn, rt}, {un, ut}, c.friction, Wn, speeds);
			result.residual.add(Wn * F.n * F.n + Wt * F.t.squaredNorm(), Wn * rn * rn + Wt * rt.squaredNorm());
		} else {
			const Matrix3 frame = contactFrame(c.normal);
			Matrix3 W = localDelassus(problem->bodies[c.body1], problem->bodies[c.body2], c, frame);
			W.diagonal() += Vector3(c.normalCompliance, c.tangentialCompliance, c.tangentialCompliance);
			if (!(W(0, 0) > 0)) continue;
			const Vector3 r = frame * impulses[i], u = frame * U + c.tangentialCompliance * r; // of u the tangents are used, of the normal un
			const auto F = naturalMap<Eigen::Vector2d>({rn, r.tail<2>()}, {un, u.tail<2>()}, c.friction, W(0, 0), speeds);
			const Vector3 f(F.n, F.t[0], F.t[1]);
			result.residual.add(f.dot(W * f), r.dot(W * r));
		}
	}
	return result;
}

double GrainOperator::certificate()
{
	collectImpulses();
	rebuildVelocities();
	if (hasField()) sumMoment();
	const std::size_t count = problem->contacts.size();
	sums.assign((count + perRun - 1) / perRun, Sums{});
	share(sums.size(), [&](std::size_t k) { sums[k] = certify(k * perRun, std::min(count, (k + 1) * perRun)); });
	Sums total;
	for (const Sums& one : sums) {
		total.residual.add(one.residual);
		total.approach = std::max(total.approach, one.approach);
	}
	maxApproachSpeed = total.approach;
	return total.residual.value();
}

CrushedContacts GrainOperator::crushed(double tolerance) const
{
	CrushedContacts found(tolerance, largestFreeApproach);
	for (std::size_t i = 0; i < impulses.size(); ++i) {
		const Contact& c = problem->contacts[i];
		const double rN = impulses[i].dot(c.normal);
		const double uN = c.relativeVelocity.dot(c.normal) + c.gapVelocity + c.normalCompliance * rN;
		if (!(rN > 0 && uN < 0)) continue;
		const Body &b1 = problem->bodies[c.body1], &b2 = problem->bodies[c.body2]; // free velocities, until finish()
		Vector3 free = b2.velocity + c.imageVelocity - b1.velocity + b2.angularVelocity.cross(c.arm2) - b1.angularVelocity.cross(c.arm1);
		if (hasField()) free += problem->meanField->gradient * (c.arm1 - c.arm2);
		const double Wnn = localDelassus(b1, b2, c, contactFrame(c.normal))(0, 0) + c.normalCompliance;
		found.add(free.dot(c.normal) + c.gapVelocity, uN, rN, Wnn);
	}
	return found.any() && mayStandStill() ? CrushedContacts(tolerance, 0) : found;
}

/// Whether no contact closes when every body, and the mean field, stands still along all directions in which it can move.
bool GrainOperator::mayStandStill() const
{
	const auto given = [](const Vector3& v, const Vector3& mobility) -> Vector3 { return (mobility.array() == 0).select(v, Vector3::Zero()); };
	const auto at = [&](const Body& b, const Vector3& arm) -> Vector3 {
		return given(b.velocity, b.inverseMass) + given(b.angularVelocity, b.inverseInertia.diagonal()).cross(arm);
	};
	const Matrix3 still = hasField() ? problem->meanField->standingStill() : Matrix3(Matrix3::Zero());
	for (const Contact& c : problem->contacts) {
		const Vector3 u = at(problem->bodies[c.body2], c.arm2) + c.imageVelocity - at(problem->bodies[c.body1], c.arm1) + still * (c.arm1 - c.arm2);
		if (u.dot(c.normal) + c.gapVelocity < 0) return false;
	}
	return true;
}

void GrainOperator::finish(SolveReport& report)
{
	auto& bodies = problem->bodies;
	inRuns(bodies.size(), [&](std::size_t i) {
		const BodyState& its = stateOf(std::int32_t(i));
		bodies[i].velocity = velocity(its);
		bodies[i].angularVelocity = angularVelocity(its);
	});
	if (hasField()) problem->meanField->gradient = gradient;
	report.maxApproachSpeed = maxApproachSpeed;
	inRuns(impulses.size(), [this](std::size_t i) { finishContact(problem->contacts[i], impulses[i]); });
	report.activeContacts =
			int(std::count_if(problem->contacts.begin(), problem->contacts.end(), [](const Contact& c) { return c.status != ContactStatus::none; }));
}

} // namespace contactdynamics
