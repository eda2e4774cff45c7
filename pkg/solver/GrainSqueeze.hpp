// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "ImpulseSet.hpp"
#include "Squeeze.hpp"

namespace contactdynamics {

/// The factor of Squeeze.hpp in a collection of grains: - sum r_N u_N over A |H r|, with A an approach. Some body would have to change its velocity
/// by that many times A.
///
/// |H r| is the sum over the bodies of the length of the force impulse, plus that of the torque impulse over the longest arm, each without the
/// blocked directions; for a mean field that can change it is the symmetric moment over the longest branch. A is the largest free approach of a
/// contact with a driven body, plus those of all contacts between moving ones, which may have to move apart one after the other (overlaps in a row, a
/// cell that is compressed). Compliant contacts are left out: they give way.
class GrainSqueeze {
public:
	/// Of the columns, chains and heaps between walls that move in doc/grains.rst, solvable ones reach it only where half of the contacts overlap, or
	/// at a tolerance of 0.1.
	static constexpr double certain = 10;

	/// Whether no contact closes when every body, and the mean field, stands still along all directions in which it can move: then there is a
	/// solution, however slowly it is approached.
	static bool mayStandStill(const GrainProblem& problem);

	/// Keeps what a solve is about to overwrite.
	void keepFree(const GrainProblem& problem);
	/// The problem as it was, to start from the impulses of a solution.
	GrainProblem from(const GrainProblem& solved) const;

	/// Of any impulses, with the velocities of a point.
	double factor(const GrainProblem& point, const ImpulseSet& of);

private:
	struct Loaded {
		double normal; // impulse [N s]
		std::int32_t id;
		double freeApproach; // [m/s]
		Vector3 impulse, torque;
	};
	struct Held { // a group of bodies, and the contacts so far
		double work = 0, imbalance = 0, driven = 0, among = 0, total = 0;
		bool isDriven = false;
		Matrix3 moment = Matrix3::Zero();

		void add(const Held& other);
	};

	std::vector<Body> freeBodies;
	std::optional<MeanField> freeField;
	std::vector<Loaded> loaded;
	JoinedGroups<Held> groups;
	std::vector<Vector3> force, turn;
	std::vector<double> longestArm;
	double largestApproach = 0, longestBranch = 0;

	static bool moves(const Body& b) { return !b.inverseMass.isZero(0) || !b.inverseInertia.isZero(0); }
	double freeApproach(const Contact& c) const;
	void collect(const GrainProblem& point, const ImpulseSet& of);
	double unbalanced(std::int32_t body) const;
	double add(std::int32_t body, const Vector3& impulse, const Vector3& torque);
	double ofMoment(const Matrix3& moment) const;
};

} // namespace contactdynamics
