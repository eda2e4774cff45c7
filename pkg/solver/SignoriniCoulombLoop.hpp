// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "Trajectory.hpp"

#include <optional>

namespace contactdynamics {

struct LoopResult {
	int iterations = 0;	  ///< sweeps, those of the rival included
	double residual = 0;  ///< certificate at the last point; not finite when the iterate is not
	bool byRival = false; ///< the point is that of the rival, not of the operator given
};

/// The Signorini-Coulomb loop of Jean (1999), 5.4, with its acceleration and stopping rule, over any operator (see Trajectory.hpp).
///
/// Safeguard of the acceleration: where it has stalled, plain Gauss-Seidel starts from the impulses handed over, on an operator of its own, the
/// rival, catches up and keeps up with it. The first certificate that is met ends the loop; otherwise the better of the two points is returned. From
/// a cold start the rival begins at once: of 166 cold heaps two take more than twice the plain sweeps then (573 against 220, 880 against 414; four
/// when it begins after 1000 sweeps). After a warm start momentum leads by 1000 sweeps: where it stalls there, plain sweeps mostly take thousands,
/// too, and it seldom fails for long (of 301 stored steps of pours none takes over twice the plain sweeps and 250 more, with a lead of 1500 two do;
/// on a pour with mu = 0.55 one takes 400 against 91). Over the plain sweeps of 80 steps each with mu = 0.5, 0.8 and 1: 0.29, 0.60 and 0.93 with this
/// lead, 0.41, 0.71 and 0.97 when it begins at the stall and settling does not grow. Rejected: plain sweeps from where momentum had gone astray (a
/// heap with mu = 1: not in 5000 sweeps what takes 2379 from the start); Anderson acceleration of depth 5 or 10 (no convergence in 5000 sweeps on 10
/// of 16 heaps with mu from 0.3 to 1, where momentum fails on 5: its jumps cross changes of status); plain sweeps shortened to 0.6 (four heaps of
/// seven with mu from 0.8 to 1 still cycle).
///
/// The last sweeps before maxIterations are plain: cut off at 1000 with mu = 1, momentum ended 26 of 80 such steps at a worse point than plain
/// sweeps, 13 this way.
///
/// @param makeRival  called once at most: a pointer to a second operator, started on the same problem; or null for none
template <class Operator, class MakeRival> LoopResult signoriniCoulombLoop(Operator& op, const SolverOptions& options, const MakeRival& makeRival)
{
	if (options.maxIterations == 0 || !op.anyAwake()) return {0, op.certificate(), false};
	Trajectory<Operator> own(op, options, options.acceleration != Acceleration::none);
	std::optional<Trajectory<Operator>> rival;
	constexpr int round = 64;  // sweeps before the other one has its turn
	constexpr int lead = 1000; // sweeps before a rival begins, after a warm start
	const int lastWithMomentum = options.maxIterations - std::min(Operator::plainEnd, options.maxIterations / 8);
	bool mayHaveRival = options.acceleration != Acceleration::none;
	for (int done = 0; done < options.maxIterations;) {
		if (mayHaveRival && own.hasStalled() && (!own.startedWarm() || own.sweeps() >= lead)) {
			mayHaveRival = false;
			if (Operator* second = makeRival()) rival.emplace(*second, options, false);
		}
		const bool byRival = rival && rival->sweeps() < own.sweeps() + round;
		Trajectory<Operator>& runner = byRival ? *rival : own;
		for (int i = rival ? round : 1; i > 0 && done < options.maxIterations; --i) {
			++done;
			if (runner.advance(done < lastWithMomentum)) return {done, runner.residual(), byRival};
		}
	}
	const double residual = own.certify();
	if (!rival || rival->sweeps() == 0) return {options.maxIterations, residual, false};
	if (rival->certify() < residual) return {options.maxIterations, rival->residual(), true};
	return {options.maxIterations, own.certify(), false}; // once more: what is returned is the point certified last
}

/// Without a rival.
template <class Operator> LoopResult signoriniCoulombLoop(Operator& op, const SolverOptions& options)
{
	return signoriniCoulombLoop(op, options, [] { return static_cast<Operator*>(nullptr); });
}

} // namespace contactdynamics
