// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "BlockProblem.hpp"

namespace contactdynamics {

/// What other programs and papers call the error of a solution, so that results can be compared. None of it steers the solver.
///
/// With dR_c the change of the impulse of contact c by one more exact local solution, all other impulses held, dV_c = W_cc dR_c the change of its
/// velocity, and sums and means over the N active contacts (those with an impulse before or after):
///
///     quadDV             sqrt( mean |dV|^2 ) / sqrt( mean |W_cc R|^2 )
///     quadDVR            sqrt( mean |dV|^2 |R|^2 ) / mean( R.W_cc R )
///     meanDVoR           sum( R.dV ) / sum( R.W_cc R )                  has a sign: positive where contacts still penetrate
///     quadraticAccuracy  sqrt( sum |dR|^2 / sum |R|^2 )
///     largestAccuracy    max |dR| / sqrt( mean |R|^2 )
///
/// The first three are the norm "Quad" of LMGC90, which stops when |meanDVoR|, quadDV and quadDVR are below its tolerance. The last two are our
/// reading of the accuracy of Jean (1999), 0.15 % in section 9.1: section 8 tells the quadratic from the max distance, but gives no formula; LMGC90
/// goes back to the program of the paper, and the distance is taken to the impulses of one more iteration, as there. All are 0 when no contact is
/// active; the denominators are 1 when no contact has an impulse.
struct ConvergenceNorms {
	double naturalMap = 0; ///< residual of the solver, see NaturalMap.hpp; torques of rolling friction count as given
	double siconos = 0;	   ///< see Measure::siconos
	double quadDV = 0, quadDVR = 0, meanDVoR = 0;
	double quadraticAccuracy = 0, largestAccuracy = 0;
	int active = 0; ///< N
};

/// @param problem  three-dimensional, with impulses; velocities are computed from them
ConvergenceNorms convergenceNorms(const BlockProblem& problem);

} // namespace contactdynamics
