// SPDX-License-Identifier: GPL-2.0-or-later
#include "BlockSolver.hpp"

#include "BlockOperator.hpp"
#include "BlocksApart.hpp"
#include "CentralPath.hpp"
#include "NewtonFinish.hpp"
#include "SignoriniCoulombLoop.hpp"

#include <optional>

namespace contactdynamics {

namespace {

// Measured on masonry, capsules, rigid boxes and 2D flow of 24 to 2020 contacts: most problems need fewer sweeps than ten Newton steps cost.
constexpr int fewestSweeps = 100;
constexpr double sweepsPerStep = 10; // cost of the sweeps before the first finish, in Newton steps
// Fewer where few contacts make a step cheaper than its estimate: tower of 80 contacts 13 against 6.4 ms, one object 1.2 against 0.53 ms. Three in
// all problems was rejected: Capsules 4.7 against 32 ms, and a wall with masses over three decades stayed at 1.1e-8.
constexpr double sweepsPerSmallStep = 3;
constexpr std::size_t smallProblem = 100; // contacts
// A path takes 25 to 150 linear systems, rarely 250, the longest seen 1100: a usual one at a stretch where that costs no more than twenty times the
// sweeps so far, later as many as cost four times the sweeps.
constexpr double usualPath = 250; // systems
constexpr double usualPathPerSweeps = 20, pathPerSweeps = 4;

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
	CertifiedPoint<D> best; // without impulses while it is the start
	bool atBest = true;		// the operator is there
	std::optional<NewtonFinish<D>> newton;
	std::optional<CentralPath<D>> path;
	SolveReport report;

	bool solved() const { return best.residual <= options.tolerance; }

	void search()
	{
		const bool finishes = options.newtonFinish && options.acceleration != Acceleration::none;
		if (options.acceleration == Acceleration::none) {
			sweep(options.maxIterations, options.acceleration);
			return;
		}
		if (!sweepPlainly() || solved()) return;
		int until = finishes ? std::max(fewestSweeps, report.iterations) : options.maxIterations;
		while (!solved() && report.iterations < options.maxIterations) {
			if (!sweep(until - report.iterations, options.acceleration)) break;
			if (solved() || !finishes) continue;
			if (!newton) newton.emplace(problem, blocks);
			const double sweepsOfStep = inSweeps(newton->stepCost()), spent = report.iterations;
			const double before = sweepsOfStep * (problem.contacts() < smallProblem ? sweepsPerSmallStep : sweepsPerStep);
			const bool last = report.iterations == options.maxIterations;
			if (last ? spent < std::max<double>(fewestSweeps, sweepsOfStep) : spent < before) {
				until = int(std::min(1e9, std::max(2 * spent, before + 1)));
				continue;
			}
			if (!atBest) restore();
			blocks.impulses(best.impulses);
			report.newtonSteps += newton->improve(best, options.tolerance);
			atBest = false;
			if (!solved()) follow(last);
			restore();
			until = int(std::min(1e9, 2 * spent));
		}
	}

	double inSweeps(double operations) const { return operations / (2.0 * double(problem.blocks.size())); }

	/// Goes on along the central path as far as the sweeps so far allow. @param last  nothing comes after it: it may not cost more than they say
	void follow(bool last)
	{
		const double spent = report.iterations;
		if (pathPerSweeps * spent < inSweeps(newton->stepCost())) return;
		const auto reached = [&](const std::vector<Vector>& impulses) {
			blocks.setImpulses(impulses);
			certify(blocks, best);
			return solved();
		};
		if (!path) {
			path.emplace(problem);
			report.newtonSteps += path->follow(1, reached); // tells the price of the others
		}
		const double sweepsOfSystem = inSweeps(std::max(newton->stepCost(), path->systemCost()));
		const double usual = last ? 0 : std::min(usualPath, usualPathPerSweeps * spent / sweepsOfSystem);
		report.newtonSteps += path->follow(int(std::min(1e6, std::max(usual, pathPerSweeps * spent / sweepsOfSystem))), reached);
	}

	/// Plain sweeps as long as they promise to be done soon. False when the iterate is not finite.
	bool sweepPlainly()
	{
		double before = best.residual;
		constexpr int round = 8;
		while (report.iterations < options.maxIterations) {
			if (!sweep(round, Acceleration::none)) return false;
			if (solved()) return true;
			const double left = std::log(options.tolerance / last) / std::log(last / before) * round;
			if (report.iterations > round && !(last < before && left < 60)) return true;
			before = last;
		}
		return true;
	}

	void restore()
	{
		best.impulses.empty() ? blocks.start() : blocks.setImpulses(best.impulses);
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

	double last = 0; // residual after the last sweep

	/// At most so many sweeps. False when the iterate is not finite.
	bool sweep(int count, Acceleration acceleration)
	{
		SolverOptions round = options;
		round.maxIterations = std::min(count, options.maxIterations - report.iterations);
		round.acceleration = acceleration;
		const LoopResult result = signoriniCoulombLoop(blocks, round);
		report.iterations += result.iterations;
		last = result.residual;
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
