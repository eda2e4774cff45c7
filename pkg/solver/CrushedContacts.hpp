// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <algorithm>

namespace contactdynamics {

/// Tells impulses that grow without bound from a solution: one guard for both operators.
///
/// Where driven walls press a body from opposite sides there is no solution. The iteration then goes on adding impulses while the approach stays, and
/// any residual relative to the impulses falls below any tolerance in the end. A contact is *crushed* when it still closes with a tenth of an
/// approach a, though its impulse is many times the one that would stop that alone:
///
///     -u_N >= 0.1 a   and   W_NN r_N >= min(1000, 0.1 / tolerance) a
///
/// with a = -q_N, its own approach without impulses, if that is >= 0.01 of the largest one. Or, with a thousand times whatever the tolerance, a = the
/// largest: the contact visited last is solved exactly, so what is left to close may be one that nothing closes without impulses (a grain at rest
/// under a lid that comes down: the floor). Such a squeeze is missed where it is slower than 0.1 of the largest approach, of a fall in the step, say,
/// and at tolerances above 1e-4, which are met earlier; with 0.1 / tolerance, solvable columns of unequal masses on a floor that rises look so at
/// 1e-2.
///
/// A long column or a loose tolerance can look like that for a while. So whoever finds crushed contacts at a point that meets the tolerance goes on
/// for furtherSweeps() sweeps by the same method, without stopping, and asks stay(): without a solution the approach is the same afterwards,
/// otherwise it is less (plain sweeps after accelerated ones do not take enough away). It errs where mass ratios are 1e3 and more: of columns on a
/// floor that rises, a thousand times as heavy on top, one step in eight at 1e-4. Rejected: sums over all contacts (one grain crushed in a heap does
/// not show in them); going on to a twentieth of the tolerance (with impulses that are carried over from step to step that takes millions of sweeps).
/// A chain of ten to twenty grains or more between two walls, where each contact keeps less than a tenth, is not noticed.
class CrushedContacts {
public:
	/// @param largestApproach  largest -q_N of the problem [m/s]
	CrushedContacts(double tolerance, double largestApproach) : ratio(std::min(most, 0.1 / tolerance)), largest(largestApproach) {}

	/// Whether a contact with this normal velocity can be crushed at all: far fewer than all are looked at closely.
	bool mayBe(double uN) const { return uN < 0 && uN <= -0.1 * least(); }

	/// @param qN  normal velocity without any impulse;  @param uN  at the point [m/s], gap velocity added in both
	/// @param rN  normal impulse [N s];  @param Wnn  normal mobility [1/kg]
	void add(double qN, double uN, double rN, double Wnn)
	{
		const auto withstands = [&](double a, double times) { return a > 0 && -uN >= 0.1 * a && Wnn * rN >= times * a; };
		if (-qN >= least() && withstands(-qN, ratio)) approach -= uN;
		if (withstands(largest, most)) fastest = std::max(fastest, -uN);
	}

	bool any() const { return approach > 0 || fastest > 0; }

	/// @param done  sweeps of the solve
	static int furtherSweeps(int done) { return std::max(32, done); }

	/// Whether they are as crushed at a later point as at this one.
	bool stay(const CrushedContacts& later) const
	{
		const auto stays = [](double before, double after) { return before > 0 && after >= 0.8 * before; };
		return stays(approach, later.approach) || stays(fastest, later.fastest);
	}

private:
	static constexpr double most = 1000;
	double ratio, largest;
	double approach = 0; // sum over contacts that are crushed against their own approach [m/s]
	/// Largest of contacts that are crushed against the largest approach. Their sum does not fall while a shock spreads through a column [m/s].
	double fastest = 0;

	double least() const { return 0.01 * largest; }
};

} // namespace contactdynamics
