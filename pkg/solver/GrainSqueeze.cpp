// SPDX-License-Identifier: GPL-2.0-or-later
#include "GrainSqueeze.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace contactdynamics {

namespace {

Matrix3 gradientOf(const std::optional<MeanField>& field) { return field ? field->gradient : Matrix3(Matrix3::Zero()); }
Matrix3 gradientStandingStill(const std::optional<MeanField>& field) { return field ? field->standingStill() : Matrix3(Matrix3::Zero()); }

/// U_N + s of a contact [m/s].
/// @param at  velocity of a body at the end of an arm
template <class Velocity> double separation(const Contact& c, const Velocity& at, const Matrix3& gradient)
{
	const Vector3 u = at(c.body2, c.arm2) + c.imageVelocity - at(c.body1, c.arm1) + gradient * (c.arm1 - c.arm2);
	return u.dot(c.normal) + c.gapVelocity;
}

/// The same when every body, and the mean field, stands still along all directions in which it can move.
double separationStandingStill(const Contact& c, const std::vector<Body>& bodies, const Matrix3& gradient)
{
	const auto at = [&](std::int32_t body, const Vector3& arm) -> Vector3 {
		return bodies[body].givenVelocity() + bodies[body].givenAngularVelocity().cross(arm);
	};
	return separation(c, at, gradient);
}

} // namespace

bool GrainSqueeze::mayStandStill(const GrainProblem& problem)
{
	const Matrix3 gradient = gradientStandingStill(problem.meanField);
	return std::all_of(problem.contacts.begin(), problem.contacts.end(),
					   [&](const Contact& c) { return separationStandingStill(c, problem.bodies, gradient) >= 0; });
}

void GrainSqueeze::keepFree(const GrainProblem& problem)
{
	freeBodies = problem.bodies;
	freeField = problem.meanField;
}

GrainProblem GrainSqueeze::from(const GrainProblem& solved) const { return {freeBodies, solved.contacts, solved.rolling, freeField}; }

/// Loaded contacts by falling impulse, and the lengths that go with them.
void GrainSqueeze::collect(const GrainProblem& point, const ImpulseSet& of)
{
	const auto freely = [&](std::int32_t body, const Vector3& arm) -> Vector3 {
		return freeBodies[body].velocity + freeBodies[body].angularVelocity.cross(arm);
	};
	const Matrix3 gradient = gradientOf(freeField), gradientStill = gradientStandingStill(freeField);
	loaded.clear();
	longestArm.assign(point.bodies.size(), 0);
	largestApproach = longestBranch = 0;
	for (std::size_t i = 0; i < point.contacts.size(); ++i) {
		const Contact& c = point.contacts[i];
		const double freeApproach = -separation(c, freely, gradient), uN = c.relativeVelocity.dot(c.normal) + c.gapVelocity;
		largestApproach = std::max(largestApproach, freeApproach);
		const Vector3& r = of.impulses[i];
		if (c.normalCompliance != 0 || !(r.dot(c.normal) > 0)) continue;
		const bool closesAnyway = separationStandingStill(c, freeBodies, gradientStill) < 0;
		loaded.push_back({r.dot(c.normal), std::int32_t(i), uN, std::max({0.0, freeApproach, -uN}), closesAnyway, r, Vector3::Zero()});
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
	closesAnyway = closesAnyway || other.closesAnyway;
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

/// A component at its limit, and pushed against it, does not give way.
double GrainSqueeze::ofMoment(const Matrix3& moment, const GrainProblem& point) const
{
	if (!freeField || longestBranch == 0) return 0;
	const Matrix3 push = 0.5 * (moment + moment.transpose()), L = point.meanField->gradient;
	double left2 = 0;
	for (int i = 0; i < 3; ++i)
		for (int j = 0; j < 3; ++j) {
			const double stretch = 0.5 * (L(i, j) + L(j, i));
			const bool isHeld = std::abs(stretch) >= freeField->limit * (1 - 1e-12) && stretch * push(i, j) > 0;
			if (freeField->inverseMass(i, j) > 0 && !isHeld) left2 += push(i, j) * push(i, j);
		}
	return std::sqrt(left2) / longestBranch;
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
		const bool moves1 = freeBodies[c.body1].moves(), moves2 = freeBodies[c.body2].moves();
		if (!moves1 && !moves2) continue;
		if (moves1 && moves2) groups.join(c.body1, c.body2);
		Held& held = groups.of(moves1 ? c.body1 : c.body2);
		if (moves1) held.imbalance += add(c.body1, -its.impulse, -c.arm1.cross(its.impulse) - its.torque);
		if (moves2) held.imbalance += add(c.body2, its.impulse, c.arm2.cross(its.impulse) + its.torque);
		if (freeField) held.moment += its.impulse * (c.arm1 - c.arm2).transpose();
		held.work -= its.normal * its.uN;
		held.total += its.normal;
		held.closesAnyway = held.closesAnyway || its.closesAnyway;
		if (moves1 && moves2)
			held.among += its.approach;
		else
			held.driven = std::max(held.driven, its.approach);
		if (!held.closesAnyway) continue; // all of it may stand still
		const double approach = std::max(held.driven + held.among, 0.01 * largestApproach);
		const double roundOff = 1e-12 * held.total;
		largest = std::max(largest, held.work / (approach * std::max(roundOff, held.imbalance + ofMoment(held.moment, point))));
	}
	return largest;
}

} // namespace contactdynamics
