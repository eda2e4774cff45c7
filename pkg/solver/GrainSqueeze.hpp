// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "ImpulseSet.hpp"
#include "JoinedGroups.hpp"
#include "Squeeze.hpp"

namespace contactdynamics {

/// The factor of Squeeze.hpp in a collection of grains: - sum r_N u_N over A |H r|, with A an approach. Some body would have to change its velocity
/// by that many times A.
///
/// |H r| is the sum over the bodies of the length of the force impulse, plus that of the torque impulse over the longest arm, each without the
/// blocked directions; for a mean field the symmetric moment over the longest branch, in the components that can give way. The approach of a contact
/// is the one without impulses or the present one, whichever is larger. A is the largest of those of a group with bodies that do not move, plus the
/// sum of those between moving ones, which may have to move apart one after the other (overlaps in a row, a cell that is compressed); at least a
/// hundredth of the largest anywhere. Left out are contacts whose normal compliance gives way, and groups that close nowhere when they stand still.
class GrainSqueeze {
public:
	/// Where something is squeezed, the factor grows to round-off with the sweeps. A ball in a flat wedge that closes may escape as many times as
	/// fast.
	static constexpr double certain = 100;

	/// Whether no contact closes when every body, and the mean field, stands still along all directions in which it can move: then nothing is
	/// squeezed, however slowly a solution is approached (a light grain between a wall and a heavy one).
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
		double uN;		   // at the point, gap velocity included [m/s]
		double approach;   // there or without impulses, whichever is larger [m/s]
		bool closesAnyway; // when everything stands still that can move
		Vector3 impulse, torque;
	};
	struct Held { // a group of bodies, and the contacts so far
		double work = 0, imbalance = 0, driven = 0, among = 0, total = 0;
		bool closesAnyway = false;
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

	void collect(const GrainProblem& point, const ImpulseSet& of);
	double unbalanced(std::int32_t body) const;
	double add(std::int32_t body, const Vector3& impulse, const Vector3& torque);
	double ofMoment(const Matrix3& moment, const GrainProblem& point) const;
};

} // namespace contactdynamics
