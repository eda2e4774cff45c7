// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "BlockProblem.hpp"

namespace contactdynamics {

/// Solves a block problem whose sizes have been checked: sweeps with momentum, then, where they stall, Newton steps and the central path.
///
///     1. The impulses handed over are tried as they are.
///     2. Sweeps, until they have cost five Newton steps; up to twice as many where they promise to end soon.
///     3. A Newton finish of a few steps from the best point (NewtonFinish.hpp).
///     4. Where the sweeps have cost twenty Newton steps: a stretch of the central path (CentralPath.hpp), from its own start.
///     5. Twice as many sweeps from the best point, or more as in 2, another finish, a further stretch of the path, and so on.
///
/// When maxIterations sweeps are done, at least a hundred and worth one Newton step, finish and path have a last go.
///
/// Costs are counted in operations, not in seconds, so that the result does not depend on the machine's load. The point returned is the best of all
/// that were certified. D = 2 or 3.
template <int D> SolveReport solveBlocks(BlockProblem& problem, const SolverOptions& options, Measure measure);

} // namespace contactdynamics
