// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <algorithm>

namespace contactdynamics {

/// Tells impulses that grow without bound from a solution: one guard for both operators.
///
/// Where driven walls press a body from opposite sides there is no solution. The iteration then goes on adding impulses while the approach stays, and
/// any residual relative to the impulses falls below any tolerance in the end. A contact is *crushed* when it still closes with a tenth of its
/// approach without impulses, -q_N > 0, though its impulse is many times the one that would stop it alone:
///
///     -u_N >= 0.1 a   and   W_NN r_N >= min(1000, 0.1 / tolerance) a,   a = -q_N, if that is >= 0.01 of the largest, or a = the largest
///
/// The contact visited last is solved exactly, so what is left to close may be one that nothing closes without impulses: of a grain at rest between a
/// floor and a lid that comes down, the floor.
/// A long column or a loose tolerance can look like that for a while. So whoever finds crushed contacts at a point that meets the tolerance goes on
/// for furtherSweeps() sweeps by the same method, without stopping, and asks stay(): without a solution the approach is the same afterwards,
/// otherwise it is less (plain sweeps after accelerated ones do not take enough away). Rejected: sums over all contacts (one grain crushed in a heap
/// does not show in them); going on to a twentieth of the tolerance (with impulses that are carried over from step to step that takes millions of
/// sweeps). A chain of more than twenty grains between two walls, where each contact keeps less than a tenth, is not noticed.
class CrushedContacts {
public:
	/// @param largestApproach  largest -q_N of the problem [m/s]
	CrushedContacts(double tolerance, double largestApproach) : ratio(std::min(1000.0, 0.1 / tolerance)), largest(largestApproach) {}

	/// Whether a contact with this normal velocity can be crushed at all: far fewer than all are looked at closely.
	bool mayBe(double uN) const { return uN < 0 && uN <= -0.1 * least(); }

	/// @param qN  normal velocity without any impulse;  @param uN  at the point [m/s], gap velocity added in both
	/// @param rN  normal impulse [N s];  @param Wnn  normal mobility [1/kg]
	void add(double qN, double uN, double rN, double Wnn)
	{
		const auto withstands = [&](double a) { return a > 0 && -uN >= 0.1 * a && Wnn * rN >= ratio * a; };
		if ((-qN >= least() && withstands(-qN)) || withstands(largest)) approach -= uN;
	}
	void add(const CrushedContacts& other) { approach += other.approach; }

	bool any() const { return approach > 0; }

	/// @param done  sweeps of the solve
	static int furtherSweeps(int done) { return std::max(32, done); }

	/// Whether they are as crushed at a later point as at this one.
	bool stay(const CrushedContacts& later) const { return any() && later.approach >= 0.8 * approach; }

private:
	double ratio, largest;
	double approach = 0; // sum over the crushed contacts [m/s]

	double least() const { return 0.01 * largest; }
};

} // namespace contactdynamics
