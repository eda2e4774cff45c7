// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "CertifiedPoint.hpp"
#include "NewtonStep.hpp"

namespace contactdynamics {

/// A few Newton steps from a point of the sweeps, the damping falling whatever happens. The residual may rise on the way. Each starts where the one
/// before has ended, outside the cones: brought back into them, or swept, the impulses lose what the next step builds on (capsules, boxes at 1e11 Pa:
/// a cycle instead of 3 to 12 steps). The certificate is that of the impulses inside. Finds the active set in a few steps, or not at all.
///
/// Only points with a lower certificate than the best so far are kept, and only those that are not lost (BlockOperator::isLost): damped steps go to
/// infinity at once where there is no solution.
template <int D> class NewtonFinish {
public:
	using Vector = Eigen::Matrix<double, D, 1>;

	NewtonFinish(const BlockProblem& problem, BlockOperator<D>& operations) : blocks(operations), step(problem) {}

	double stepCost() const { return step.cost(); } ///< NewtonStep::cost()

	/// @param best   in: where to start; out: the best point seen
	/// @param most   Newton steps; never more than fifteen
	/// @return       Newton steps done
	int improve(CertifiedPoint<D>& best, double tolerance, int most);

private:
	BlockOperator<D>& blocks;
	NewtonStep<D> step;
	std::vector<Vector> point, velocity, next;
};

} // namespace contactdynamics
