// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "Trajectory.hpp"

namespace contactdynamics {

struct LoopResult {
	int iterations = 0;	 ///< sweeps, those of a rival and the share of those over hot spots included
	double residual = 0; ///< certificate at the last point; not finite when the iterate is not
};

/// The Signorini-Coulomb loop of Jean (1999), 5.4, with its acceleration and stopping rule, over any operator (see Trajectory.hpp).
template <class Operator> LoopResult signoriniCoulombLoop(Operator& op, const SolverOptions& options)
{
	if (options.maxIterations == 0 || !op.anyAwake()) return {0, op.certificate()};
	Trajectory<Operator> sweeps(op, options, options.acceleration != Acceleration::none);
	for (int done = 1; done <= options.maxIterations; ++done)
		if (sweeps.advance()) return {done, sweeps.residual()};
	return {options.maxIterations, sweeps.certify()};
}

} // namespace contactdynamics
