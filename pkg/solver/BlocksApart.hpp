// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "BlockProblem.hpp"

namespace contactdynamics {

/// Solves a block problem whose sizes have been checked and whose contacts do not act on each other: one visit of each is the solution. Without this
/// short way a single contact spends three quarters of its half microsecond in the set-up of the loop. D = 2 or 3.
/// @return false when they do act on each other, when impulses are handed over, or when the tolerance is not met (unsymmetric blocks): impulses
///         and report are then as given
template <int D> bool solveApart(BlockProblem& problem, const SolverOptions& options, Measure measure, SolveReport& report);

} // namespace contactdynamics
