// SPDX-License-Identifier: GPL-2.0-or-later
#include "BlockSolver.hpp"

#include "BlockOperator.hpp"
#include "NewtonFinish.hpp"
#include "SignoriniCoulombLoop.hpp"

#include <optional>

namespace contactdynamics {

namespace {

// Measured on masonry, capsules, rigid boxes and 2D flow of 24 to 2020 contacts: most problems need fewer sweeps than ten Newton steps cost; those
// that do not had better spend some fifty steps at once, because a finish that is cut short has to begin again.
constexpr int fewestSweeps = 100;
constexpr double sweepsPerStep = 10;			 // cost of the sweeps before the first finish, in Newton steps
constexpr double stepsPerSweeps = 4;			 // cost of a later finish, in the sweeps before it
constexpr int fewestSteps = 60, mostSteps = 120; // of a finish

/// Loop and finish in turn; keeps the best point.
template <int D> class BlockSolver {
public:
	BlockSolver(BlockProblem& given, const SolverOptions& wanted, Measure measure)
		: problem(given), options(wanted), blocks(given, measure), best{blocks.certificate(), blocks.impulses()}
	{
	}

	SolveReport run()
	{
		const bool finishes = options.newtonFinish && options.acceleration != Acceleration::none;
		int until = finishes ? fewestSweeps : options.maxIterations;
		while (!solved() && report.iterations < options.maxIterations) {
			if (!sweep(std::min(until, options.maxIterations) - report.iterations)) break;
			if (solved() || !finishes) continue;
			if (!newton) newton.emplace(problem, blocks);
			const double sweepsOfStep = newton->stepCost() / (2.0 * double(problem.blocks.size())), spent = report.iterations;
			const bool last = report.iterations == options.maxIterations;
			if (last ? spent < fewestSweeps : spent < sweepsPerStep * sweepsOfStep) {
				until = int(std::min(1e9, std::max(2 * spent, sweepsPerStep * sweepsOfStep + 1)));
				continue;
			}
			const int steps = int(std::clamp(stepsPerSweeps * spent / sweepsOfStep, double(fewestSteps), double(mostSteps)));
			report.newtonSteps += newton->improve(best, options.tolerance, steps);
			blocks.setImpulses(best.impulses);
			until = int(std::min(1e9, 2 * spent));
		}
		report.residual = best.residual;
		report.status = SolveStatus::notFinite;
		if (!std::isfinite(best.residual)) return report;
		blocks.setRaw(best.impulses);
		report.status = !solved() ? SolveStatus::maxIterations : runsAway() ? SolveStatus::unbounded : SolveStatus::converged;
		blocks.finish(report);
		return report;
	}

private:
	BlockProblem& problem;
	const SolverOptions& options;
	BlockOperator<D> blocks;
	CertifiedPoint<D> best;
	std::optional<NewtonFinish<D>> newton;
	SolveReport report;

	bool solved() const { return best.residual <= options.tolerance; }

	/// Whether the tolerance is met only because the impulses grow without bound. The point stays the best one.
	bool runsAway()
	{
		const CrushedContacts here = blocks.crushed(options.tolerance);
		if (!here.any()) return false;
		for (int i = CrushedContacts::furtherSweeps(report.iterations); i > 0; --i) blocks.sweep({});
		const bool stay = here.stay(blocks.crushed(options.tolerance));
		blocks.setRaw(best.impulses);
		return stay;
	}

	bool sweep(int count)
	{
		SolverOptions round = options;
		round.maxIterations = count;
		const LoopResult result = signoriniCoulombLoop(blocks, round);
		report.iterations += result.iterations;
		const bool finite = std::isfinite(result.residual);
		if (finite) best.keepIfBetter(result.residual, blocks.impulses());
		return finite && result.iterations > 0;
	}
};

} // namespace

template <int D> SolveReport solveBlocks(BlockProblem& problem, const SolverOptions& options, Measure measure)
{
	return BlockSolver<D>(problem, options, measure).run();
}

template SolveReport solveBlocks<2>(BlockProblem&, const SolverOptions&, Measure);
template SolveReport solveBlocks<3>(BlockProblem&, const SolverOptions&, Measure);

} // namespace contactdynamics
