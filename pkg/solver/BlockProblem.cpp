// SPDX-License-Identifier: GPL-2.0-or-later
#include "BlockProblem.hpp"

#include "BlockOperator.hpp"
#include "BlockSolver.hpp"

#include <stdexcept>
#include <string>

namespace contactdynamics {

namespace {

void require(bool fits, const std::string& otherwise)
{
	if (!fits) throw std::invalid_argument("block problem: " + otherwise);
}

void requireSizes(const BlockProblem& p)
{
	const std::size_t count = p.contacts(), d = std::size_t(p.dimension);
	require(p.dimension == 2 || p.dimension == 3, "dimension is " + std::to_string(p.dimension) + ", must be 2 or 3");
	require(p.rowStart.size() == count + 1 && p.rowStart.front() == 0 && std::size_t(p.rowStart.back()) == p.column.size(),
			"rowStart must have " + std::to_string(count + 1) + " entries, from 0 to the number of blocks");
	require(p.blocks.size() == d * d * p.column.size(), "blocks has " + std::to_string(p.blocks.size()) + " entries");
	require(p.q.size() == d * count, "q has " + std::to_string(p.q.size()) + " entries, must have " + std::to_string(d * count));
	require(p.impulse.size() == d * count, "impulse has " + std::to_string(p.impulse.size()) + " entries, must have " + std::to_string(d * count));
	for (std::size_t i = 0; i < count; ++i) {
		const std::string name = "contact " + std::to_string(i) + ": ";
		require(!(p.friction[i] < 0), name + "friction is " + std::to_string(p.friction[i]) + ", must be >= 0");
		require(p.rowStart[i] <= p.rowStart[i + 1], name + "rowStart decreases");
		bool diagonal = false;
		for (std::int32_t k = p.rowStart[i]; k < p.rowStart[i + 1]; ++k) {
			require(p.column[k] >= 0 && std::size_t(p.column[k]) < count, name + "column " + std::to_string(p.column[k]) + " is out of range");
			diagonal = diagonal || std::size_t(p.column[k]) == i;
		}
		require(diagonal, name + "the row has no diagonal block");
	}
}

bool allFinite(const std::vector<double>& values)
{
	double poison = 0;
	for (const double value : values) poison += 0 * value;
	return poison == 0;
}

template <int D> double residualOfBlocks(BlockProblem& problem, Measure measure)
{
	BlockOperator<D> blocks(problem, measure);
	blocks.takeImpulsesAsGiven();
	return blocks.certificate();
}

} // namespace

double residualOf(const BlockProblem& problem, Measure measure)
{
	requireSizes(problem);
	BlockProblem copy = problem;
	return copy.dimension == 2 ? residualOfBlocks<2>(copy, measure) : residualOfBlocks<3>(copy, measure);
}

SolveReport solve(BlockProblem& problem, const SolverOptions& options, Measure measure)
{
	requireOptions(options);
	requireSizes(problem);
	SolveReport report;
	report.status = SolveStatus::notFinite;
	if (!allFinite(problem.blocks) || !allFinite(problem.q) || !allFinite(problem.friction) || !allFinite(problem.impulse)) return report;
	return problem.dimension == 2 ? solveBlocks<2>(problem, options, measure) : solveBlocks<3>(problem, options, measure);
}

} // namespace contactdynamics
