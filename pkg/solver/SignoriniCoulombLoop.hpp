// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "Accelerator.hpp"
#include "SolverOptions.hpp"

#include <algorithm>
#include <cmath>

namespace contactdynamics {

struct LoopResult {
	int iterations = 0;
	double residual = 0; ///< certificate at the last point; not finite when the iterate is not
};

/// The Signorini-Coulomb loop of Jean (1999), 5.4, with its acceleration and stopping rule, over any operator:
///
///     int firstCheck                          sweep after which the certificate is evaluated to gauge the increments; 0: not before they promise
///     bool anyAwake()                         false when no contact needs a visit
///     SweepNorms sweep(Extrapolation)         moves to the extrapolated point, then visits every awake contact once
///     bool mend()                             looks after sleeping contacts; true when one of them was woken
///     double certificate()                    residual over all contacts, at feasible impulses and the velocities they produce
///
/// The increments of a sweep cost nothing and estimate the residual; only when they promise convergence the certificate is evaluated, and only
/// the certificate ends the loop. Every sweep ends at a feasible point, because each visit does.
template <class Operator> LoopResult signoriniCoulombLoop(Operator& op, const SolverOptions& options)
{
	constexpr int mendEvery = 8; // sweeps; a look at a sleeper costs about a quarter of a visit
	LoopResult result;
	if (options.maxIterations == 0 || !op.anyAwake()) {
		result.residual = op.certificate();
		return result;
	}
	Accelerator accelerator;
	Extrapolation extrapolation;
	double promise = options.tolerance; // of the increments, relative
	while (result.iterations < options.maxIterations) {
		const SweepNorms norms = op.sweep(extrapolation);
		++result.iterations;
		const double increment = std::sqrt(std::max(0.0, norms.increment2)), impulse = std::sqrt(std::max(0.0, norms.impulse2));
		if (!std::isfinite(increment) || !std::isfinite(impulse)) {
			result.residual = increment + impulse;
			return result;
		}
		const bool last = result.iterations == options.maxIterations;
		if (last || result.iterations == Operator::firstCheck || increment <= promise * impulse) {
			if (!op.mend() || last) {
				result.residual = op.certificate();
				if (!(result.residual > options.tolerance)) return result;
				// They promised too much: believe them again when they are smaller by what is missing.
				if (impulse > 0) promise = std::min(0.9, 0.95 * options.tolerance / result.residual) * increment / impulse;
			}
		} else if (result.iterations % mendEvery == 0)
			op.mend();
		if (options.acceleration != Acceleration::none) extrapolation = accelerator.next(norms.increment2);
	}
	return result;
}

} // namespace contactdynamics
