// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "BlockProblem.hpp"
#include "BlockSystem.hpp"

namespace contactdynamics {

/// One semi-smooth Newton step on the function of Alart and Curnier, D = 2 or 3:
///
///     open     r_N - p_N u_N <= 0          r = 0
///     sticking |r_T - p_T u_T| <= m        u = 0
///     sliding  otherwise                   u_N = 0,  r_T = m t,  t along r_T - p_T u_T,    with m = mu (r_N - p_N u_N)
///
/// with p_N = 1 / W_NN and p_T = (D - 1) / trace W_TT. Open contacts leave the system, the others form a sparse unsymmetric one with the blocks of W.
/// It is singular wherever more contacts stick than the bodies can tell apart; the damping, added to the diagonal relative to W_NN and W_TT, picks a
/// solution close to the present impulses (a proximal step). The rows are scaled by p, so that the system has no unit.
template <int D> class NewtonStep {
public:
	using Vector = Eigen::Matrix<double, D, 1>;
	using Block = Eigen::Matrix<double, D, D>;

	explicit NewtonStep(const BlockProblem& problem);

	/// @param r, u     impulses [N s] and their velocities [m/s]
	/// @param damping  added to the scaled diagonal [-], > 0
	/// @param next     out: impulses after a full step, not projected on the cones
	/// @return         false when the system could not be solved: next is then not set
	bool compute(const std::vector<Vector>& r, const std::vector<Vector>& u, double damping, std::vector<Vector>& next);

	/// Estimated cost of compute() when every contact is active, in operations of a sweep: 2 D^3 for each pair of blocks that an elimination without
	/// pivoting meets, and fifty sweeps. Within a factor of two on 15 problems of 24 to 2020 contacts, up to three times too little for a full W.
	double cost() const;

private:
	const BlockProblem& problem;
	std::vector<double> normalScale, tangentScale; // p_N, p_T [kg]
	std::vector<int> position, positionBefore;	   // of a contact in the system, -1: open
	Eigen::VectorXd right, solution;

	BlockSystem<D> system;

	void layOut(int active);
};

} // namespace contactdynamics
