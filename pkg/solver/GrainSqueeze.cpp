// SPDX-License-Identifier: GPL-2.0-or-later
#include "GrainSqueeze.hpp"

#include <Eigen/Geometry>

namespace contactdynamics {

bool GrainSqueeze::mayStandStill(const GrainProblem& problem)
{
	const Matrix3 still = problem.meanField ? problem.meanField->standingStill() : Matrix3(Matrix3::Zero());
	const auto at = [&](std::int32_t body, const Vector3& arm) -> Vector3 {
		const Body& b = problem.bodies[body];
		return b.givenVelocity() + b.givenAngularVelocity().cross(arm);
	};
	return std::all_of(problem.contacts.begin(), problem.contacts.end(), [&](const Contact& c) {
		const Vector3 u = at(c.body2, c.arm2) + c.imageVelocity - at(c.body1, c.arm1) + still * (c.arm1 - c.arm2);
		return u.dot(c.normal) + c.gapVelocity >= 0;
	});
}

void GrainSqueeze::keepFree(const GrainProblem& problem)
{
	freeBodies = problem.bodies;
	freeField = problem.meanField;
}

GrainProblem GrainSqueeze::from(const GrainProblem& solved) const { return {freeBodies, solved.contacts, solved.rolling, freeField}; }

double GrainSqueeze::freeApproach(const Contact& c) const
{
	const Body &b1 = freeBodies[c.body1], &b2 = freeBodies[c.body2];
	Vector3 u = b2.velocity + c.imageVelocity - b1.velocity + b2.angularVelocity.cross(c.arm2) - b1.angularVelocity.cross(c.arm1);
	if (freeField) u += freeField->gradient * (c.arm1 - c.arm2);
	return std::max(0.0, -u.dot(c.normal) - c.gapVelocity);
}

/// Loaded contacts by falling impulse, and the lengths that go with them.
void GrainSqueeze::collect(const GrainProblem& point, const ImpulseSet& of)
{
	loaded.clear();
	longestArm.assign(point.bodies.size(), 0);
	largestApproach = longestBranch = 0;
	for (std::size_t i = 0; i < point.contacts.size(); ++i) {
		const Contact& c = point.contacts[i];
		const double approach = freeApproach(c);
		largestApproach = std::max(largestApproach, approach);
		const Vector3& r = of.impulses[i];
		if (c.normalCompliance != 0 || c.tangentialCompliance != 0 || !(r.dot(c.normal) > 0)) continue;
		loaded.push_back({r.dot(c.normal), std::int32_t(i), approach, r, Vector3::Zero()});
		longestArm[c.body1] = std::max(longestArm[c.body1], c.arm1.norm());
		longestArm[c.body2] = std::max(longestArm[c.body2], c.arm2.norm());
		longestBranch = std::max(longestBranch, (c.arm1 - c.arm2).norm());
	}
	auto next = loaded.begin();
	for (std::size_t k = 0; k < point.rolling.size(); ++k) { // both in the order of the contacts
		while (next != loaded.end() && next->id < point.rolling[k].contact) ++next;
		if (next != loaded.end() && next->id == point.rolling[k].contact) next->torque = of.torques[k];
	}
	std::sort(loaded.begin(), loaded.end(),
			  [](const Loaded& a, const Loaded& b) { return a.normal != b.normal ? a.normal > b.normal : a.id < b.id; });
}

void GrainSqueeze::Held::add(const Held& other)
{
	work += other.work;
	imbalance += other.imbalance;
	driven = std::max(driven, other.driven);
	among += other.among;
	total += other.total;
	isDriven = isDriven || other.isDriven;
	moment += other.moment;
}

double GrainSqueeze::unbalanced(std::int32_t body) const
{
	const Body& b = freeBodies[body];
	const Vector3 f = (b.inverseMass.array() > 0).select(force[body], Vector3::Zero());
	const Vector3 t = (b.inverseInertia.diagonal().array() > 0).select(turn[body], Vector3::Zero());
	return f.norm() + (longestArm[body] > 0 ? t.norm() / longestArm[body] : 0);
}

/// By how much that changes what is not in balance.
double GrainSqueeze::add(std::int32_t body, const Vector3& impulse, const Vector3& torque)
{
	const double before = unbalanced(body);
	force[body] += impulse;
	turn[body] += torque;
	return unbalanced(body) - before;
}

double GrainSqueeze::ofMoment(const Matrix3& moment) const
{
	if (!freeField || longestBranch == 0) return 0;
	const Matrix3 push = 0.5 * (moment + moment.transpose());
	return (freeField->inverseMass.array() > 0).select(push, Matrix3::Zero()).norm() / longestBranch;
}

double GrainSqueeze::factor(const GrainProblem& point, const ImpulseSet& of)
{
	collect(point, of);
	force.assign(freeBodies.size(), Vector3::Zero());
	turn.assign(freeBodies.size(), Vector3::Zero());
	groups.reset(freeBodies.size());
	double largest = 0;
	for (const Loaded& its : loaded) {
		const Contact& c = point.contacts[its.id];
		const bool moves1 = moves(freeBodies[c.body1]), moves2 = moves(freeBodies[c.body2]);
		if (!moves1 && !moves2) continue;
		if (moves1 && moves2) groups.join(c.body1, c.body2);
		Held& held = groups.of(moves1 ? c.body1 : c.body2);
		if (moves1) held.imbalance += add(c.body1, -its.impulse, -c.arm1.cross(its.impulse) - its.torque);
		if (moves2) held.imbalance += add(c.body2, its.impulse, c.arm2.cross(its.impulse) + its.torque);
		if (freeField) held.moment += its.impulse * (c.arm1 - c.arm2).transpose();
		const double uN = c.relativeVelocity.dot(c.normal) + c.gapVelocity;
		held.work -= its.normal * uN;
		held.total += its.normal;
		held.isDriven = held.isDriven || !moves1 || !moves2 || freeField || !c.imageVelocity.isZero(0);
		if (moves1 && moves2)
			held.among += its.freeApproach;
		else
			held.driven = std::max({held.driven, its.freeApproach, -uN});
		if (!held.isDriven) continue; // moving bodies alone can always part
		const double approach = std::max(held.driven + held.among, 0.01 * largestApproach);
		const double roundOff = 1e-12 * held.total;
		largest = std::max(largest, held.work / (approach * std::max(roundOff, held.imbalance + ofMoment(held.moment))));
	}
	return largest;
}

} // namespace contactdynamics
