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
/// rival, catches up and keeps up with it. The first certificate that is met ends the loop; otherwise the better of the two points is returned.
/// Momentum leads: where it stalls, plain sweeps mostly take long, too, and it seldom fails for long. How long a lead is worth while depends on what
/// plain sweeps take, the caller's estimate (of 301 stored steps of pours of 729 none takes over twice the plain sweeps, and over 250 more than
/// they do, with a lead of 1000; two do with 1500). Rejected: plain sweeps from where momentum had gone astray (a heap with mu = 1: not in 5000
/// sweeps what takes 2379 from the start); a rival with a light momentum (of 166 heaps thirteen take more than twice the plain sweeps, one not in
/// 15,000 what these solve in 331); Anderson acceleration of depth 5 or 10 (no convergence in 5000 sweeps on 10 of 16 heaps with mu from 0.3 to 1,
/// where momentum fails on 5: its jumps cross changes of status); plain sweeps shortened to 0.6 (four heaps of seven with mu from 0.8 to 1 still
/// cycle).
///
/// The last sweeps before maxIterations are plain, whoever makes them: cut off at 1000 with mu = 1, momentum ended 26 of 80 such steps at a worse
/// point than plain sweeps, 13 this way.
///
/// @param lead       sweeps before a rival begins
/// @param makeRival  called once at most: a pointer to a second operator, started on the same problem; or null for none
template <class Operator, class MakeRival>
LoopResult signoriniCoulombLoop(Operator& op, const SolverOptions& options, int lead, const MakeRival& makeRival)
{
	if (options.maxIterations == 0 || !op.anyAwake()) return {0, op.certificate(), false};
	Trajectory<Operator> own(op, options, options.acceleration != Acceleration::none);
	std::optional<Trajectory<Operator>> rival;
	constexpr int round = 64; // sweeps before the other one has its turn
	const int lastWithMomentum = options.maxIterations - std::min(Operator::plainEnd, options.maxIterations / 8);
	bool mayHaveRival = options.acceleration != Acceleration::none;
	for (int done = 0; done < options.maxIterations;) {
		if (mayHaveRival && own.hasStalled() && own.sweeps() >= lead) {
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
	if (!rival) return {options.maxIterations, residual, false};
	if (rival->certify() < residual) return {options.maxIterations, rival->residual(), true};
	return {options.maxIterations, own.certify(), false}; // once more: what is returned is the point certified last
}

/// Without a rival.
template <class Operator> LoopResult signoriniCoulombLoop(Operator& op, const SolverOptions& options)
{
	return signoriniCoulombLoop(op, options, 0, [] { return static_cast<Operator*>(nullptr); });
}

} // namespace contactdynamics
