// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "SignoriniCoulombLoop.hpp"

#include <optional>

namespace contactdynamics {

struct GuardedResult : LoopResult {
	bool byRival = false; ///< the point is that of the rival, not of the operator given
};

/// The Signorini-Coulomb loop with momentum, and what keeps it from being much slower than plain Gauss-Seidel or from ending at a worse point.
///
/// Where momentum has stalled, plain Gauss-Seidel starts from the impulses handed over, on an operator of its own, the rival, and catches up as far
/// as it is worth while: it has a turn as long as the geometric mean of its sweeps and of those that it will take in all, at its present rate, is
/// less than the sweeps of the operator. When it is done both have done as many; while it has far to go it has half as many at least. The first
/// certificate that is met ends the loop. Momentum leads: where it stalls, plain sweeps mostly take long, too, and it seldom fails for long. How long
/// a lead is worth while depends on what plain sweeps take, the caller's estimate. Rejected: plain sweeps from where momentum had gone astray (a heap
/// with mu = 1: not in 5000 sweeps what takes 2379 from the start); a rival with a light momentum (of 166 heaps thirteen take more than twice the
/// plain sweeps, one not in 15,000 what these solve in 331); Anderson acceleration of depth 5 or 10 (no convergence in 5000 sweeps on 10 of 16 heaps
/// with mu from 0.3 to 1, where momentum fails on 5: its jumps cross changes of status); plain sweeps shortened to 0.6 (four heaps of seven with mu
/// from 0.8 to 1 still cycle).
///
/// From the 150th sweep on, contacts that sweeps cannot settle are solved on their own (HotSpotSolver.hpp); what that takes counts as sweeps of the
/// operator. More often where momentum has stalled, less often after a dear one (what else was tried: doc/grains.rst).
///
/// Where the sweeps run out, the point with the smallest increments of their second half is taken up again, the last sweeps are plain from there, and
/// the best point by certificate is returned.
///
/// @param lead       sweeps before a rival begins
/// @param makeRival  called once at most: a second operator, started on the same problem
/// @param settle     given the operator, the sweeps that are left and those that it has done: solves the contacts around its largest changes, and
///                   says whether it did, for the price of how many sweeps, and of how many its Newton steps (HotSpotSolver::Outcome)
template <class Operator, class MakeRival, class Settle>
GuardedResult guardedLoop(Operator& op, const SolverOptions& options, int lead, const MakeRival& makeRival, const Settle& settle)
{
	if (options.acceleration == Acceleration::none || options.maxIterations == 0 || !op.anyAwake()) return {signoriniCoulombLoop(op, options), false};
	const int most = options.maxIterations, lastWithMomentum = most - std::min(32, most / 8);
	constexpr int round = 64;														// sweeps before the other one has its turn
	constexpr int firstSpot = 150, betweenSpots = 50, betweenSpotsOnceStalled = 20; // sweeps
	constexpr double pausePerCost = 0.25;											// of a spot
	Trajectory<Operator> own(op, options, true);
	std::optional<Trajectory<Operator>> rival;
	int nextSpot = firstSpot;
	double inSpots = 0; // sweeps
	const auto sweepsOfOwn = [&] { return own.sweeps() + int(inSpots); };
	const auto done = [&] { return sweepsOfOwn() + (rival ? rival->sweeps() : 0); };
	const auto settleSpot = [&] {
		const auto spot = settle(op, lastWithMomentum - done(), own.sweeps());
		inSpots += spot.sweeps;
		if (spot.settled) own.goOnFromHere();
		nextSpot = own.sweeps() +
				   std::max(own.hasStalled() ? betweenSpotsOnceStalled : betweenSpots, int(pausePerCost * (spot.newtonCost + spot.sweeps)));
	};
	const auto advance = [&](Trajectory<Operator>& runner) {
		if (runner.advance()) return true;
		if (done() > most / 2) runner.keepIfBest();
		return false;
	};
	const auto hasRivalItsTurn = [&] {
		if (!rival) return false;
		constexpr double mostForetold = 4; // times the sweeps done: it may stand still for a while, and then be soon done
		const double sweeps = rival->sweeps(), inAll = std::min(mostForetold * sweeps, rival->foretold());
		return std::sqrt(sweeps * inAll) < sweepsOfOwn() + round;
	};
	while (done() < lastWithMomentum) {
		if (!rival && own.hasStalled() && sweepsOfOwn() >= lead) rival.emplace(makeRival(), options, false);
		const bool byRival = hasRivalItsTurn();
		Trajectory<Operator>& runner = byRival ? *rival : own;
		for (int i = rival ? round : 1; i > 0 && done() < lastWithMomentum; --i) {
			if (!byRival && own.sweeps() >= nextSpot) settleSpot();
			if (advance(runner)) return {{done(), runner.residual()}, byRival};
		}
	}
	own.endPlainly();
	while (done() < most)
		if (advance(own)) return {{done(), own.residual()}, false};
	const double residual = own.certifyBest();
	if (rival && rival->certifyBest() < residual) return {{done(), rival->residual()}, true};
	return {{done(), residual}, false};
}

} // namespace contactdynamics
