// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "BlockOperator.hpp"
#include "NewtonStep.hpp"

namespace contactdynamics {

/// Impulses inside their cones, and the certificate there.
template <int D> struct CertifiedPoint {
	double residual = 0;
	std::vector<Eigen::Matrix<double, D, 1>> impulses;
};

/// Newton steps from a point of the sweeps, in two ways one after the other:
///
///     swept     full steps, each followed by two plain sweeps, the damping falling whatever happens. The residual may rise on the way; the
///               sweeps repair what a wrong guess of the active set has done. Finds the active set of stacks in a few steps.
///     searched  steps with a line search on the norm of the function, the damping falling after a long step and rising after a failed one.
///               Slower and surer; without sweeps, because they take it back to where they stall.
///
/// Only points with a lower certificate than the best so far are kept, and only where no contact is crushed (CrushedContacts.hpp): damped steps go to
/// infinity at once where there is no solution.
template <int D> class NewtonFinish {
public:
	using Vector = Eigen::Matrix<double, D, 1>;

	NewtonFinish(const BlockProblem& problem, BlockOperator<D>& operations) : blocks(operations), step(problem), cost(step.cost()) {}

	double stepCost() const { return cost; } ///< operations of a Newton step with all contacts active, an upper estimate

	/// @param best   in: where to start; out: the best point seen
	/// @return       Newton steps done, at most steps
	int improve(CertifiedPoint<D>& best, double tolerance, int steps);

private:
	BlockOperator<D>& blocks;
	NewtonStep<D> step;
	double cost;
	std::vector<Vector> point, velocity, trial, trialVelocity, next;

	int swept(CertifiedPoint<D>& best, double tolerance, int steps);
	int searched(CertifiedPoint<D>& best, double tolerance, int steps);
	void certify(CertifiedPoint<D>& best, double tolerance);
};

} // namespace contactdynamics
