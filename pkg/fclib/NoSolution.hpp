// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <pkg/solver/BlockProblem.hpp>

namespace contactdynamics::fclib {

/// Whether a solve that met its tolerance did so only because the impulses grow without bound.
///
/// Where contacts press the same degree of freedom from opposite sides there may be no solution. The iteration then goes on adding impulses while
/// the approach stays, and Siconos's error, divided by |r|, falls below any tolerance in the end. One point does not show it: with impulses much
/// larger than velocities a loose tolerance leaves an approach, too. So the solve goes on to a twentieth of the tolerance; without a solution that
/// takes about twenty times the impulses, otherwise it takes away most of the approach.
/// @param solved  as solve() returned it, with the report of that call
bool growsWithoutBound(const BlockProblem& solved, const SolveReport& report, const SolverOptions& options);

} // namespace contactdynamics::fclib
