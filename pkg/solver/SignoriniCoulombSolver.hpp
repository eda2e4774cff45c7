// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "GrainProblem.hpp"
#include "SolveReport.hpp"
#include "SolverOptions.hpp"

#include <memory>

namespace contactdynamics {

/// Solves 0 <= U_N + s _|_ R_N >= 0 with Coulomb's law at all contacts of a collection of rigid bodies: the Signorini-Coulomb loop (Jean 1999, 5.4).
/// Owns the work space, so that a step allocates nothing once warm, but for the Newton steps of some hard ones (HotSpotSolver.hpp). The result is a
/// function of problem and options alone: no memory between calls changes the numbers, and any thread count gives the same bits.
class SignoriniCoulombSolver {
public:
	SignoriniCoulombSolver();
	~SignoriniCoulombSolver();
	SignoriniCoulombSolver(const SignoriniCoulombSolver&) = delete;
	SignoriniCoulombSolver& operator=(const SignoriniCoulombSolver&) = delete;

	/// Solves in place, starting from Contact::impulse. On return every impulse is inside its cone and the body velocities are
	/// free velocity + M^-1 H R of exactly these impulses, MeanField::gradient likewise.
	/// @throws std::invalid_argument  body index out of range or equal, normal not of unit length, friction or a compliance negative, inverse mass
	///                                of the mean field negative or not symmetric, its limit or the tolerance not positive, maxIterations
	///                                negative, threads < 1. The message names contact or field, and the value; the problem is unchanged.
	SolveReport solve(GrainProblem& problem, const SolverOptions& options);

private:
	struct Workspace;
	std::unique_ptr<Workspace> workspace;
};

} // namespace contactdynamics
