// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "SolverOptions.hpp"

#include <algorithm>
#include <limits>

namespace contactdynamics {

/// Tells impulses that grow without bound from a solution: one guard for both operators.
///
/// Where driven walls press a body from opposite sides there is no solution. The iteration then goes on adding impulses while the approach stays, and
/// any residual relative to the impulses falls below any tolerance in the end. What gives it away is virtual work. Let a star mark a solution, u_N
/// include the gap velocity, and r be any impulses with r_N >= 0. With v and u at the present point,
///
///     H r . (v* - v) = sum r . (u* - u),  so  - sum r_N u_N <= H r . (v* - v) + sum r_T . (u_T - u*_T)
///
/// because u*_N >= 0. Without friction (Farkas's lemma) impulses that are in balance on every body, H r = 0, cannot work against contacts that close,
/// unless there is no solution. The *factor* of r is that work over what is not in balance (GrainSqueeze.hpp, BlockSqueeze.hpp); how far any solution
/// is away is at least proportional to it. What some sweeps add to the impulses becomes such an r: without a solution each sweep adds the same in the
/// end, and that is in balance; with one, what is added moves what is still to be moved, be it light grains under a heavy one. With friction the last
/// sum may be positive while contacts stick that will slide: a wedge that is about to lock can deceive it.
///
/// As r may leave out any contact, the loaded ones are added in the order of their impulses, and the factor is the largest of any group that those so
/// far hold together: one grain squeezed in a heap shows.
///
/// Where the factor of a solution is at least suspected (grains: of what the last sweep added, or, after few sweeps, of all impulses; blocks: of all
/// impulses), it is not trusted: further() sweeps go on from it, and where what they add has a factor that is certain, there is none. Rejected:
/// contacts that close with a tenth of their approach though their impulse is a thousand times what stops that alone, before and after further
/// sweeps. 1164 of 11,520 solvable columns on a floor that rises (5 to 200 balls, masses over four decades, tolerances from 1e-2 to 1e-6) were said
/// to have no solution, now none; and chains of ten were not noticed.
struct Squeeze {
	/// Something is still to be changed as much as the approach (grains), or the impulses (blocks). Steps of 10,000 shaken spheres reach 0.7.
	static constexpr double suspected = 1;
	/// Least approach that is looked at, of the largest without impulses: a squeezed chain shares its approach among its contacts.
	static constexpr double leastApproach = 0.003;
	/// In which what is added comes into balance along a chain: some tens for ten grains.
	static constexpr int sweepsToBalance = 100;
	/// As many sweeps as were done, at least those, whatever the residual.
	static SolverOptions further(SolverOptions options, int done)
	{
		options.maxIterations = std::max(sweepsToBalance, done);
		options.tolerance = std::numeric_limits<double>::min();
		return options;
	}
};

} // namespace contactdynamics
