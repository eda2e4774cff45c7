// SPDX-License-Identifier: GPL-2.0-or-later
#include "NoSolution.hpp"

#include <algorithm>
#include <cmath>

namespace contactdynamics::fclib {

namespace {

double largest(const std::vector<double>& values)
{
	double result = 0;
	for (const double value : values) result = std::max(result, std::abs(value));
	return result;
}

} // namespace

bool growsWithoutBound(const BlockProblem& solved, const SolveReport& report, const SolverOptions& options)
{
	if (report.maxApproachSpeed <= options.tolerance * largest(solved.q)) return false;
	BlockProblem further = solved;
	SolverOptions finer = options;
	finer.tolerance /= 20;
	const SolveReport then = solve(further, finer, Measure::siconos);
	return largest(further.impulse) > 5 * largest(solved.impulse) && then.maxApproachSpeed > 0.5 * report.maxApproachSpeed;
}

} // namespace contactdynamics::fclib
