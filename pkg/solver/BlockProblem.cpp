// SPDX-License-Identifier: GPL-2.0-or-later
#include "BlockProblem.hpp"

#include "BlockOperator.hpp"
#include "BlockSolver.hpp"

#include <stdexcept>
#include <string>

namespace contactdynamics {

namespace {

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument("block problem: " + what); }

/// Apart from refuseRow(), because words cost more than the solution of a small problem.
bool rowFits(const BlockProblem& p, std::size_t i)
{
	if (p.friction[i] < 0 || p.rowStart[i] < 0 || p.rowStart[i] > p.rowStart[i + 1]) return false;
	if (std::size_t(p.rowStart[i + 1]) > p.column.size()) return false;
	bool diagonal = false, inside = true;
	for (std::int32_t k = p.rowStart[i]; k < p.rowStart[i + 1]; ++k) {
		inside &= std::size_t(p.column[k]) < p.contacts(); // also false when it is negative
		diagonal |= std::size_t(p.column[k]) == i;
	}
	return inside && diagonal;
}

[[noreturn]] void refuseRow(const BlockProblem& p, std::size_t i)
{
	const std::string name = "contact " + std::to_string(i) + ": ";
	if (p.friction[i] < 0) refuse(name + "friction is " + std::to_string(p.friction[i]) + ", must be >= 0");
	const std::int32_t from = p.rowStart[i], to = p.rowStart[i + 1];
	if (from < 0 || from > to || std::size_t(to) > p.column.size())
		refuse(name + "rowStart goes from " + std::to_string(from) + " to " + std::to_string(to) + ", must not decrease nor leave the blocks");
	for (std::int32_t k = from; k < to; ++k)
		if (std::size_t(p.column[k]) >= p.contacts()) refuse(name + "column " + std::to_string(p.column[k]) + " is out of range");
	refuse(name + "the row has no diagonal block");
}

void requireSizes(const BlockProblem& p)
{
	const std::size_t count = p.contacts(), d = std::size_t(p.dimension);
	if (p.dimension != 2 && p.dimension != 3) refuse("dimension is " + std::to_string(p.dimension) + ", must be 2 or 3");
	if (p.rowStart.size() != count + 1 || p.rowStart.front() != 0 || std::size_t(p.rowStart.back()) != p.column.size())
		refuse("rowStart must have " + std::to_string(count + 1) + " entries, from 0 to the number of blocks");
	if (p.blocks.size() != d * d * p.column.size()) refuse("blocks has " + std::to_string(p.blocks.size()) + " entries");
	if (p.q.size() != d * count) refuse("q has " + std::to_string(p.q.size()) + " entries, must have " + std::to_string(d * count));
	if (p.impulse.size() != d * count) refuse("impulse has " + std::to_string(p.impulse.size()) + " entries, must have " + std::to_string(d * count));
	for (std::size_t i = 0; i < count; ++i)
		if (!rowFits(p, i)) refuseRow(p, i);
}

bool allFinite(const std::vector<double>& values)
{
	// Zero times a finite number is zero, times anything else not a number. Four sums, because the processor waits for each addition.
	double poison[4] = {0, 0, 0, 0};
	std::size_t i = 0;
	for (; i + 4 <= values.size(); i += 4)
		for (int k = 0; k < 4; ++k) poison[k] += 0 * values[i + k];
	for (; i < values.size(); ++i) poison[0] += 0 * values[i];
	return poison[0] + poison[1] + poison[2] + poison[3] == 0;
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
