// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>

namespace contactdynamics {

/// One frictional contact in two dimensions, normal first: the four cases of (34) of Jean (1999).
///
/// The solution is unique when (33) holds, |mu W_TN| < W_NN. Where it does not (Painleve), isUnique() says so, and solve() returns the first case
/// that fits, in the order open, sticking, forward, backward.
class OneContact2D {
public:
	OneContact2D() = default;

	/// @param W  local Delassus operator [1/kg], symmetric; the upper triangle is read
	explicit OneContact2D(const Eigen::Matrix2d& W) : Wnn(W(0, 0)), Wnt(W(0, 1)), Wtt(W(1, 1)) {}

	bool isUnique(double mu) const { return std::abs(mu * Wnt) < Wnn || !(Wnn > 0); }

	/// @param b   relative velocity without this contact, gap velocity added to the normal component [m/s]
	/// @param mu  Coulomb coefficient >= 0
	/// @return    impulse [N s]; zero when b_n >= 0, and when W_nn = 0
	Eigen::Vector2d solve(const Eigen::Vector2d& b, double mu) const
	{
		const double bn = b[0], bt = b[1];
		if (!(bn < 0) || !(Wnn > 0)) return {0, 0};
		if (mu == 0) return {-bn / Wnn, 0};
		const double determinant = Wnn * Wtt - Wnt * Wnt;
		if (determinant > 8 * std::numeric_limits<double>::epsilon() * Wnn * Wtt) { // below that it is round-off
			const double rn = (Wnt * bt - Wtt * bn) / determinant, rt = (Wnt * bn - Wnn * bt) / determinant;
			if (rn >= 0 && std::abs(rt) <= mu * rn) return {rn, rt};
		}
		// Sliding against the friction: r_T = side mu r_N with u_N = 0, and side u_T <= 0. The side of J = b_T - W_TN b_N / W_NN is tried first.
		const double first = Wnn * bt - Wnt * bn <= 0 ? 1 : -1;
		for (const double side : {first, -first}) {
			const double mobility = Wnn + side * mu * Wnt;
			if (!(mobility > 0)) continue;
			const double rn = -bn / mobility, rt = side * mu * rn;
			if (side * (bt + Wnt * rn + Wtt * rt) <= 0) return {rn, rt};
		}
		// Round-off at the edge of two cases, or no solution at all: stop the approach, as far as friction lets it.
		const double mobility = Wnn + first * mu * Wnt;
		return mobility > 0 ? Eigen::Vector2d(-bn / mobility, -first * mu * bn / mobility) : Eigen::Vector2d(-bn / Wnn, 0);
	}

private:
	double Wnn = 0, Wnt = 0, Wtt = 0;
};

} // namespace contactdynamics
