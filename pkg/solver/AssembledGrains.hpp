// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "BlockProblem.hpp"
#include "GrainProblem.hpp"

namespace contactdynamics {

/// The explicit form of a solved collection of rigid bodies, for other solvers and for measures that need W: the solve itself never assembles it.
///
/// W in 3 x 3 blocks by contact, columns of a row in increasing order, compliances on the diagonal; impulse r and velocity u (gap velocity and
/// compliance added) of the solution, each in the frame of its contact, normal first. q = u - W r, so that what the solver held fixed (cohesion,
/// rolling friction) is part of it. Bodies that cannot move link no contacts. A mean field that responds to impulses links every contact with every
/// other: W gains b_i (1/M) b_j for all i and j, a term of rank 6 at most, and is full. Components at their bound count as prescribed.
/// @param solved  as SignoriniCoulombSolver::solve() returned it
/// @param frames  rows n, t1, t2 of each contact
BlockProblem assembled(const GrainProblem& solved, const std::vector<Matrix3>& frames);

} // namespace contactdynamics
