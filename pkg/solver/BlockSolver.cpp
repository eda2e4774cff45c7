// SPDX-License-Identifier: GPL-2.0-or-later
#include "BlockSolver.hpp"

#include "BlockOperator.hpp"
#include "BlocksApart.hpp"
#include "CentralPath.hpp"
#include "NewtonFinish.hpp"
#include "SignoriniCoulombLoop.hpp"

#include <limits>
#include <optional>

namespace contactdynamics {

namespace {

// The best of 108 combinations on 46 hard problems of 20 to 790 contacts, 24 tangles and 22 steps of packings; others nearby cost up to a tenth more
// in the mean, and on single problems twelve times as much. In Newton steps:
constexpr double worthFinish = 5; // cost of the sweeps before the first finish
constexpr double soon = 8;		  // sweeps that promise to end within this go on first, to at most twice as many
constexpr double worthPath = 20;  // cost of the sweeps before the path: 25 to 150 linear systems, rarely 250, the longest seen 1100
// Over the cost of the sweeps so far:
constexpr double finishPerSweeps = 2, pathPerSweeps = 8;
constexpr int sweepsBeforeEstimate = 100; // of the price of a Newton step, which takes as long as some ten sweeps
constexpr double fewestMore = 16;		  // sweeps: the rate of fewer says little

/// Loop, finish and path in turn; keeps the best point.
template <int D> class BlockSolver {
public:
	BlockSolver(BlockProblem& given, const SolverOptions& wanted, Measure measure)
		: problem(given), options(wanted), blocks(given, measure), best{blocks.certificate(), {}}
	{
	}

	SolveReport run()
	{
		if (!solved() && problem.contacts() > 0) search();
		report.residual = best.residual;
		report.status = SolveStatus::notFinite;
		if (!std::isfinite(best.residual)) return report;
		if (!atBest) restore();
		blocks.finish(report);
		report.status = !solved() ? SolveStatus::maxIterations : runsAway() ? SolveStatus::unbounded : SolveStatus::converged;
		return report;
	}

private:
	using Vector = Eigen::Matrix<double, D, 1>;

	BlockProblem& problem;
	const SolverOptions& options;
	BlockOperator<D> blocks;
	CertifiedPoint<D> best;									 // without impulses while it is the start
	bool atBest = true;										 // the operator is there
	std::optional<Trajectory<BlockOperator<D>>> accelerated; // the sweeps with momentum under way
	std::optional<CentralPath<D>> path;
	SolveReport report;

	bool solved() const { return best.residual <= options.tolerance; }

	void search()
	{
		if (options.acceleration == Acceleration::none) {
			sweep(options.maxIterations);
			return;
		}
		if (!sweepPlainly() || solved()) return;
		if (!sweepOn(options.newtonFinish ? sweepsBeforeEstimate : options.maxIterations) || solved()) return;
		if (!options.newtonFinish || report.iterations < sweepsBeforeEstimate) return;
		NewtonFinish<D> newton(problem, blocks);
		const double step = inSweeps(newton.stepCost());
		double due = worthFinish * step;
		while (sweepWhilePromising(due, soon * step) && !solved()) {
			const double spent = report.iterations;
			const bool ends = report.iterations == options.maxIterations;
			if (spent < step) return;
			if (!atBest) restore();
			blocks.impulses(best.impulses);
			report.newtonSteps += newton.improve(best, options.tolerance, int(finishPerSweeps * spent / step));
			atBest = false;
			if (!solved() && (ends || spent >= worthPath * step)) follow(step);
			if (solved() || ends) return;
			restore();
			last = best.residual;
			due = 2 * spent;
		}
	}

	/// Sweeps until so many are done, and on to twice as many where few are left. False when the iterate is not finite.
	bool sweepWhilePromising(double due, double few)
	{
		const double most = std::min<double>(options.maxIterations, std::ceil(2 * due));
		double until = std::min(most, std::ceil(due));
		while (sweepOn(int(until))) {
			const double left = sweepsLeft();
			if (solved() || report.iterations >= most || !(left < few)) return true;
			until = std::min(most, std::ceil(report.iterations + std::max(left, fewestMore)));
		}
		return false;
	}

	/// Sweeps that are left at the rate of the last ones.
	double sweepsLeft() const { return rate < 0 ? std::log(options.tolerance / last) / rate : std::numeric_limits<double>::infinity(); }

	double inSweeps(double operations) const { return operations / (2.0 * double(problem.blocks.size())); }

	/// Goes on along the central path as far as the sweeps so far allow. @param step  price of a Newton step: no system is taken to be cheaper
	void follow(double step)
	{
		const auto reached = [&](const std::vector<Vector>& impulses) {
			blocks.setImpulses(impulses);
			certify(blocks, best);
			return solved();
		};
		if (!path) {
			path.emplace(problem);
			report.newtonSteps += path->follow(1, reached); // tells the price of the others
		}
		const double system = std::max(step, inSweeps(path->systemCost()));
		report.newtonSteps += path->follow(int(pathPerSweeps * report.iterations / system), reached);
	}

	/// Plain sweeps as long as they promise to be done soon. False when the iterate is not finite.
	bool sweepPlainly()
	{
		constexpr int round = 8;
		while (report.iterations < options.maxIterations) {
			if (!sweep(round)) return false;
			if (solved()) return true;
			if (report.iterations > round && !(sweepsLeft() < 60)) return true;
		}
		return true;
	}

	void restore()
	{
		best.impulses.empty() ? blocks.start() : blocks.setImpulses(best.impulses);
		accelerated.reset();
		atBest = true;
	}

	/// Whether the tolerance is met only because the impulses grow without bound. The operator is left elsewhere.
	bool runsAway()
	{
		if (report.maxApproachSpeed == 0) return false;
		if (blocks.squeeze() < Squeeze::suspected) return false;
		std::vector<Vector> here;
		blocks.impulses(here);
		signoriniCoulombLoop(blocks, Squeeze::further(options, report.iterations));
		return blocks.squeeze(&here) >= certainSqueezeOfBlocks;
	}

	double last = best.residual; // after the last sweep
	double rate = 0;			 // of its logarithm over the last sweeps, for each of them

	/// At most so many plain sweeps. False when the iterate is not finite.
	bool sweep(int count)
	{
		SolverOptions round = options;
		round.maxIterations = std::min(count, options.maxIterations - report.iterations);
		round.acceleration = Acceleration::none;
		const LoopResult result = signoriniCoulombLoop(blocks, round);
		report.iterations += result.iterations;
		return take(result.residual, result.iterations);
	}

	/// Accelerated sweeps until there are so many in all: the momentum of those before goes on. False when the iterate is not finite.
	bool sweepOn(int until)
	{
		if (!accelerated) accelerated.emplace(blocks, options, true);
		const int before = report.iterations;
		bool ends = false;
		for (; !ends && report.iterations < std::min(until, options.maxIterations); ++report.iterations) ends = accelerated->advance();
		if (report.iterations == before) return true;
		return take(ends ? accelerated->residual() : accelerated->certify(), report.iterations - before);
	}

	/// Keeps the point after so many more sweeps if it is the best one. False when it is not finite.
	bool take(double residual, int sweeps)
	{
		rate = std::log(residual / last) / sweeps;
		last = residual;
		atBest = last < best.residual || !std::isfinite(best.residual);
		if (!std::isfinite(last)) return atBest = false;
		if (!atBest) return true;
		best.residual = last;
		if (!solved()) blocks.impulses(best.impulses); // the end of most solves needs no copy
		return true;
	}
};

} // namespace

template <int D> SolveReport solveBlocks(BlockProblem& problem, const SolverOptions& options, Measure measure)
{
	SolveReport report;
	return solveApart<D>(problem, options, measure, report) ? report : BlockSolver<D>(problem, options, measure).run();
}

template SolveReport solveBlocks<2>(BlockProblem&, const SolverOptions&, Measure);
template SolveReport solveBlocks<3>(BlockProblem&, const SolverOptions&, Measure);

} // namespace contactdynamics
