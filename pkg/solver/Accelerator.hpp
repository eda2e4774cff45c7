// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "BallPack.hpp"

#include <cmath>

namespace contactdynamics {

/// Chooses where the next sweep starts, from the size of the increments alone: a few numbers of state, no inner product of its own.
///
/// With y_k = G(x_k) the sweep, x_(k+1) = y_k + 1.5 b (y_k - x_k) + b (x_k - x_(k-1)), b = (t - 1) / (t + 1/2), t growing by 1/2 each sweep:
/// momentum of Nesterov's kind (t + 1/2 stands for his (1 + sqrt(1 + 4 t^2)) / 2) with an over-relaxed step. When the increments |y_k - x_k| are
/// twice as large as the smallest since the last restart, the momentum restarts from nothing: an earlier restart wastes it, growth from sweep to
/// sweep as the measure misses a slow divergence.
///
/// Momentum pays on hard problems only: it begins when plain sweeps, at their rate of the last eight, would need sixty more. (Without this, steps of
/// a loose impact that plain sweeps solve in 19 to 41 took 54 to 96.)
///
/// Coulomb's law makes the problem non-monotone, and momentum may wander. When the increments have not lost a tenth within 120 sweeps, 100 sweeps
/// with a light constant momentum settle it (b = 0.2: rotating modes that grow above 0.4 are damped, slow ones go by a third faster than plainly),
/// then momentum has another go; each time both last twice as long. From the first time on, hasStalled(), the loop may set plain Gauss-Seidel
/// against it.
///
/// Sweeps to 1e-4 on steps 160, 180, 190, 200, 250, 300, 350 of a pour of 2000 spheres (mu = 0.42, 7000 to 9000 candidates, warm start) and, cold,
/// on a heap of 216 spheres (mu = 0.5); last, sweeps to 1e-12 on a column of 100. A dash: not in 5000 (pours 3000, column 20000).
///
///     plain Gauss-Seidel                                      1729  3192     -     -     -     -  1280   1934      -
///     restart when increments grow by 2.5 % in a sweep         442   676  1520  1042  1514  1071   398    447    845
///     by 9.5 %                                                 364   554  1269   825  1148   809   296      -  12405
///     by 22 %: diverges                                       1031  2339     -     -     -     -   251      -
///     bound on b, lowered at each restart                      496   813  1734  1185  1667  1205   381    440
///     against the smallest since the restart, by 22 %          347   552  1297   873  1210   872   297      -    953
///     twice as large                                           271   464   987   851   966   690   231      -    954
///     three times as large                                     224   389   831   694  1099   645   193      -   1107
///     … before settling and lead were as they are             271   464   987   851   966  1828   231   1366    954
class Accelerator {
public:
	/// @param startsPlainly  plain sweeps first, while they promise to be done soon
	explicit Accelerator(bool startsPlainly) : easy(startsPlainly) {}

	/// @param increment2  squared size of the increments of the sweep just done, W-norm [J]
	/// @param goal2       below which they promise convergence [J]
	Extrapolation next(double increment2, double goal2)
	{
		if (easy) {
			if (count++ % stretch == 0) {
				// At the rate of the last stretch, how many sweeps are left?
				const double left = stretch * std::log(goal2 / increment2) / std::log(increment2 / before);
				if (count > 1 && !(increment2 < before && left < soon && count < soon)) easy = false;
				before = increment2;
			}
			if (easy) return {};
		}
		if (fromOutside) {
			fromOutside = false;
			return {};
		}
		if (settling > 0) {
			--settling;
			return {0.3, 0.2};
		}
		if (best < 0 || increment2 < 0.8 * best) {
			best = increment2;
			sinceBest = 0;
		} else if (++sinceBest > window) {
			settleDown();
			return {};
		}
		if (smallest < 0 || increment2 < smallest) smallest = increment2;
		if (increment2 > 4 * smallest) {
			restart = 1;
			smallest = increment2;
			return {};
		}
		const double momentum = (restart - 1) / (restart + 0.5);
		restart += 0.5;
		return {1.5 * momentum, momentum};
	}

	/// The point was changed from outside: no momentum from before, nor from the change, which counts as one of the sweep before.
	void restartMomentum()
	{
		restart = 1;
		smallest = -1;
		fromOutside = true;
	}

	/// Momentum has once failed to make progress.
	bool hasStalled() const { return window > patience; }

private:
	void settleDown()
	{
		settling = window / 6 * 5;
		window *= 2;
		best = smallest = -1;
		sinceBest = 0;
		restart = 1;
	}

	static constexpr int stretch = 8, soon = 60, patience = 120; // sweeps
	bool easy;													 // plain sweeps will do
	int count = 0;
	double before = 0;	  // increment a stretch ago
	double restart = 1;	  // t of the class comment
	double smallest = -1; // increment since the restart
	double best = -1;
	int sinceBest = 0, window = patience; // sweeps without progress, now and at most
	bool fromOutside = false;
	int settling = 0; // sweeps with a light momentum that are left
};

} // namespace contactdynamics
