// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "Accelerator.hpp"
#include "SolverOptions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace contactdynamics {

/// The sweeps of one operator, accelerated or not, and when its certificate is worth looking at. What it needs of the operator:
///
///     int firstCheck                          sweep after which the certificate is evaluated to gauge the increments; 0: not before they promise
///     bool startsPlainly                      plain sweeps before momentum, while they promise to be done soon
///     bool anyAwake()                         false when no contact needs a visit
///     SweepNorms sweep(Extrapolation)         moves to the extrapolated point, then visits every awake contact once
///     bool mend()                             looks after sleeping contacts; true when one of them was woken
///     double certificate()                    residual over all contacts, at feasible impulses and the velocities they produce
///     void keep(), exchangeKept()             copies impulses and torques; goes to those kept, and keeps those left: only for keepIfBest() and what
///     uses it
///
/// The increments of a sweep cost nothing and estimate the residual; only when they promise convergence the certificate is evaluated, and only
/// the certificate ends the loop. Every sweep ends at a feasible point, because each visit does.
template <class Operator> class Trajectory {
public:
	Trajectory(Operator& given, const SolverOptions& options, bool accelerate)
		: op(given), tolerance(options.tolerance), accelerated(accelerate), promise(options.tolerance), accelerator(Operator::startsPlainly)
	{
	}

	/// One sweep. True when it is the last one: the certificate is met, or the iterate is not finite (then residual() is not, either).
	bool advance()
	{
		const SweepNorms norms = op.sweep(extrapolation);
		++count;
		relative2 = norms.increment2 / norms.impulse2;
		noteSmallest();
		// A NaN stays one in this order of the arguments.
		const double increment = std::sqrt(std::max(norms.increment2, 0.0)), impulse = std::sqrt(std::max(norms.impulse2, 0.0));
		if (!std::isfinite(increment) || !std::isfinite(impulse)) {
			last = increment + impulse;
			return true;
		}
		if (count == op.firstCheck || increment <= promise * impulse) {
			if (!op.mend()) {
				last = op.certificate();
				if (!(last > tolerance)) return true;
				// They promised too much: believe them again when they are smaller by what is missing.
				if (impulse > 0) promise = std::min(0.9, 0.95 * tolerance / last) * increment / impulse;
			}
		} else if (stagnates()) {
			if (!op.mend() && !((last = op.certificate()) > tolerance)) return true;
		} else if (count % mendEvery == 0)
			op.mend();
		if (accelerated) extrapolation = accelerator.next(norms.increment2, promise * promise * norms.impulse2);
		return false;
	}

	/// The operator was changed between two sweeps: the next one starts where it is now.
	void goOnFromHere()
	{
		extrapolation = {};
		accelerator.restartMomentum();
	}

	/// Residual of the present point, sleeping contacts looked after.
	double certify()
	{
		op.mend();
		return last = op.certificate();
	}

	/// Keeps the point after the last sweep when its increments are a tenth smaller than those of the one kept, or the first.
	void keepIfBest()
	{
		if (!(relative2 < 0.8 * kept2)) return;
		op.keep();
		kept2 = relative2;
	}

	/// Goes on plainly, from the point kept if its increments are the smaller ones.
	void endPlainly()
	{
		accelerated = false;
		extrapolation = {};
		if (!(kept2 < relative2)) return;
		op.exchangeKept();
		op.keep(); // it stays the best one
		relative2 = kept2;
	}

	/// Residual of the better one of the present point and the one kept, where the operator is then.
	double certifyBest()
	{
		const double here = certify();
		if (!(kept2 < relative2)) return here;
		op.exchangeKept();
		if (certify() > here) {
			op.exchangeKept();
			certify();
		}
		return last;
	}

	double residual() const { return last; } ///< of the last certificate, or not finite
	int sweeps() const { return count; }
	bool hasStalled() const { return accelerator.hasStalled(); }

	/// Sweeps in all until the increments promise convergence, at the mean rate of the last half of them, or up to three quarters; infinite where
	/// they have not become smaller. Plain ones fall by a power of their number, not by a factor each, so that there will rather be more.
	double foretold() const
	{
		const double goal2 = promise * promise;
		const int sinceMark = count - lastMark / 2;
		if (!(smallest2 > goal2)) return count;
		if (!(smallest2 < markBefore2)) return std::numeric_limits<double>::infinity();
		return count + sinceMark * std::log(smallest2 / goal2) / std::log(markBefore2 / smallest2);
	}

private:
	bool isAtPowerOfTwo() const { return (count & (count - 1)) == 0; }

	void noteSmallest()
	{
		if (relative2 < smallest2) smallest2 = relative2;
		if (!isAtPowerOfTwo()) return;
		lastMark = count;
		markBefore2 = std::exchange(lastMark2, smallest2);
	}

	/// Whether the increments have not halved while the sweeps doubled. They may be round-off of larger velocities then, which never falls: where
	/// grains that fly together touch with next to no impulse, only the certificate, which knows the velocities, can tell.
	bool stagnates()
	{
		constexpr int first = 16;
		if (count < first || !isAtPowerOfTwo()) return false;
		const bool so = count > first && !(relative2 < 0.25 * earlier2);
		earlier2 = relative2;
		return so;
	}

	static constexpr int mendEvery = 8; // sweeps; a look at a sleeper costs about a quarter of a visit
	Operator& op;
	const double tolerance;
	bool accelerated;
	double promise; // of the increments, relative
	int count = 0;
	double last = 0;
	// Squared increments relative to the impulses: of the last sweep, of the one kept, of half as many sweeps ago.
	double relative2 = 0, kept2 = std::numeric_limits<double>::infinity(), earlier2 = 0;
	// The smallest one so far: now, at the last power of two of sweeps, at the one before.
	double smallest2 = std::numeric_limits<double>::infinity(), lastMark2 = smallest2, markBefore2 = smallest2;
	int lastMark = 0;
	Accelerator accelerator;
	Extrapolation extrapolation;
};

} // namespace contactdynamics
