// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "CertifiedPoint.hpp"
#include "NewtonStep.hpp"

namespace contactdynamics {

/// A few Newton steps from a point of the sweeps, each followed by two plain sweeps, the damping falling whatever happens. The residual may rise on
/// the way; the sweeps repair what a wrong guess of the active set has done. Finds the active set of stacks in a few steps, or not at all.
///
/// Only points with a lower certificate than the best so far are kept, and only those that are not lost (BlockOperator::isLost): damped steps go to
/// infinity at once where there is no solution.
template <int D> class NewtonFinish {
public:
	using Vector = Eigen::Matrix<double, D, 1>;

	NewtonFinish(const BlockProblem& problem, BlockOperator<D>& operations) : blocks(operations), step(problem), cost(step.cost()) {}

	double stepCost() const { return cost; } ///< operations of a Newton step with all contacts active, an upper estimate

	/// @param best   in: where to start; out: the best point seen
	/// @return       Newton steps done
	int improve(CertifiedPoint<D>& best, double tolerance);

private:
	BlockOperator<D>& blocks;
	NewtonStep<D> step;
	double cost;
	std::vector<Vector> point, velocity, next;
};

} // namespace contactdynamics
