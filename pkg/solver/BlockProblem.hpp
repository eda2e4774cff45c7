// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "SolveReport.hpp"
#include "SolverOptions.hpp"

#include <cstdint>
#include <vector>

namespace contactdynamics {

/// Signorini-Coulomb problem with an explicit sparse W: u = W r + q, per contact 0 <= u_N _|_ r_N >= 0 and Coulomb's law (FCLIB's local problem,
/// condensed deformable bodies). Normal component first in every contact. W need not be exactly symmetric.
struct BlockProblem {
	int dimension = 3;					///< 2 or 3
	std::vector<std::int32_t> rowStart; ///< contacts + 1 entries: the blocks of row i are rowStart[i] ... rowStart[i + 1] - 1
	std::vector<std::int32_t> column;	///< contact of each block; every row has its diagonal block
	std::vector<double> blocks;			///< dimension x dimension each, row by row [1/kg]
	std::vector<double> q;				///< free relative velocity, gap velocity included [m/s]
	std::vector<double> friction;		///< mu of each contact, >= 0
	std::vector<double> impulse;		///< in: start; out: solution [N s]
	std::vector<double> velocity;		///< out: u = W r + q [m/s]

	std::size_t contacts() const { return friction.size(); }
};

/// What "tolerance" bounds.
enum class Measure {
	naturalMap, ///< relative and W-weighted, see NaturalMap.hpp: does not depend on units
	siconos ///< sqrt(sum |r - P_K(r - u - mu |u_T| n)|^2) / max(|q|, |r|, |u|), unscaled if that is <= 2.2e-16: for comparison only, because it adds
			///< impulses and velocities
};

/// Residual of the impulses of a problem (the velocities are computed from them) in either measure.
double residualOf(const BlockProblem& problem, Measure measure);

/// Solves in place, with the loop and the acceleration of SignoriniCoulombSolver and, where that stalls, Newton's method (BlockSolver.hpp), on one
/// thread. A status other than converged does not prove that there is no solution; the impulses returned are then the best that were found.
/// @throws std::invalid_argument  sizes that do not fit each other, a column out of range, a row without diagonal block, friction negative,
///                                options out of range. The message names the contact and the value.
SolveReport solve(BlockProblem& problem, const SolverOptions& options, Measure measure = Measure::naturalMap);

} // namespace contactdynamics
