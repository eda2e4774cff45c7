// SPDX-License-Identifier: GPL-2.0-or-later
#include "OneContact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace contactdynamics {

OneContact::OneContact(const Matrix3& W)
{
	const double Wnn = along.Wnn = W(0, 0);
	if (!(Wnn > 0)) return;
	along.inverseWnn = 1 / Wnn;
	const double wx = W(0, 1), wy = W(0, 2);
	const double a = W(1, 1) - wx * wx / Wnn, d = W(2, 2) - wy * wy / Wnn, off = W(1, 2) - wx * wy / Wnn;
	// One Jacobi rotation diagonalises a symmetric 2x2 matrix; the larger of sine and cosine first, without cancellation.
	const double mean = 0.5 * (a + d), radius = std::sqrt(0.25 * (a - d) * (a - d) + off * off);
	if (radius > 0) {
		const double larger = std::sqrt(0.5 + 0.25 * std::abs(a - d) / radius), smaller = 0.5 * std::abs(off) / (radius * larger);
		cosine = a >= d ? larger : smaller;
		sine = std::copysign(a >= d ? smaller : larger, off);
	}
	along.wLarge = cosine * wx + sine * wy;
	along.wSmall = -sine * wx + cosine * wy;
	along.largeEigen = std::max(0.0, mean + radius);
	along.smallEigen = std::max(0.0, mean - radius);
	// The Schur complement carries the round-off of its terms: below it an eigenvalue means "cannot move".
	along.roundOff = 8 * std::numeric_limits<double>::epsilon() * (W(1, 1) + W(2, 2));
	if (along.largeEigen <= along.roundOff) along.largeEigen = 0;
	if (along.smallEigen <= along.roundOff) along.smallEigen = 0;
	along.inverseLarge = along.largeEigen > 0 ? 1 / along.largeEigen : 0;
	along.inverseSmall = along.smallEigen > 0 ? 1 / along.smallEigen : 0;
}

Matrix3 OneContact::principalFrame(const Matrix3& frame) const
{
	Matrix3 turned = frame;
	turned.row(1) = cosine * frame.row(1) + sine * frame.row(2);
	turned.row(2) = cosine * frame.row(2) - sine * frame.row(1);
	return turned;
}

Vector3 OneContact::solve(const Vector3& b, double mu) const
{
	double unknown = 0;
	return solve(b, mu, unknown);
}

Vector3 OneContact::solve(const Vector3& b, double mu, double& rate) const
{
	const double alone = b[0] * along.inverseWnn;
	const PrincipalPush push{b[0], along.wLarge * alone - (cosine * b[1] + sine * b[2]), along.wSmall * alone - (cosine * b[2] - sine * b[1])};
	double r[3];
	contactdynamics::solve(along, push, mu, rate, r);
	return {r[0], cosine * r[1] - sine * r[2], sine * r[1] + cosine * r[2]};
}

} // namespace contactdynamics
