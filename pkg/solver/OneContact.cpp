// SPDX-License-Identifier: GPL-2.0-or-later
#include "OneContact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace contactdynamics {

OneContact::OneContact(const Matrix3& W) : Wnn(W(0, 0))
{
	if (!(Wnn > 0)) return;
	wx = W(0, 1);
	wy = W(0, 2);
	const double a = W(1, 1) - wx * wx / Wnn, d = W(2, 2) - wy * wy / Wnn, off = W(1, 2) - wx * wy / Wnn;
	// One Jacobi rotation diagonalises a symmetric 2x2 matrix; the larger of sine and cosine first, without cancellation.
	const double mean = 0.5 * (a + d), radius = std::sqrt(0.25 * (a - d) * (a - d) + off * off);
	if (radius > 0) {
		const double larger = std::sqrt(0.5 + 0.25 * std::abs(a - d) / radius), smaller = 0.5 * std::abs(off) / (radius * larger);
		cosine = a >= d ? larger : smaller;
		sine = std::copysign(a >= d ? smaller : larger, off);
	}
	largeEigen = std::max(0.0, mean + radius);
	smallEigen = std::max(0.0, mean - radius);
	// The Schur complement carries the round-off of its terms: below it an eigenvalue means "cannot move".
	roundOff = 8 * std::numeric_limits<double>::epsilon() * (W(1, 1) + W(2, 2));
	if (largeEigen <= roundOff) largeEigen = 0;
	if (smallEigen <= roundOff) smallEigen = 0;
}

/// Root k > 0 of f(k) = |r_t(k)| - mu r_n(k), f(0) > 0 > f(infinity). Newton on 1/(mu r_n) - 1/|r_t|, which is nearly linear in k (as in
/// trust-region methods), first from the guess, if any, without a bracket, then kept inside one; bisection of the logarithm when it leaves the
/// bracket or shrinks it too slowly.
double OneContact::slidingRate(double cLarge, double cSmall, double wLarge, double wSmall, double bn, double mu, double guess) const
{
	const auto evaluate = [&](double k, double& tangential, double& normal, double& dTangential, double& dNormal) {
		const double iL = 1 / (largeEigen + k), iS = 1 / (smallEigen + k);
		const double rL = cLarge * iL, rS = cSmall * iS;
		tangential = std::sqrt(rL * rL + rS * rS);
		normal = -mu * (bn + wLarge * rL + wSmall * rS) / Wnn;
		dTangential = tangential > 0 ? -(rL * rL * iL + rS * rS * iS) / tangential : 0;
		dNormal = mu * (wLarge * rL * iL + wSmall * rS * iS) / Wnn;
		return tangential - normal;
	};
	/// Step of Newton's method, subtracted.
	const auto newton = [](double tangential, double normal, double dT, double dN) {
		return (1 / normal - 1 / tangential) / (dT / (tangential * tangential) - dN / (normal * normal));
	};
	double tangential, normal, dT, dN;
	const double limit = -mu * bn / Wnn; // mu r_n for k -> infinity, > 0
	// A direction that cannot move and yet should: below the round-off of A the rate means nothing, see solve().
	double low = smallEigen > 0 ? 0 : roundOff, high = std::max(2 * low, std::sqrt(cLarge * cLarge + cSmall * cSmall) / limit);
	if (low > 0 && evaluate(low, tangential, normal, dT, dN) <= 0) return -1;
	for (int i = 0; i < 4 && guess > low; ++i) {
		evaluate(guess, tangential, normal, dT, dN);
		const double next = guess - newton(tangential, normal, dT, dN);
		if (!(normal > 0 && tangential > 0 && next > low)) break;
		// The error after a step is of the order of its square.
		if (std::abs(next - guess) <= 1e-8 * guess) return next;
		guess = next;
	}
	while (evaluate(high, tangential, normal, dT, dN) > 0) {
		low = high;
		high *= 4;
	}
	// From here f(low) > 0 >= f(high). Start from the small side: the smallest root is wanted where strong coupling makes several.
	double k = low > 0 ? std::sqrt(low * high) : 0.25 * high;
	for (int i = 0; i < 200; ++i) {
		const double f = evaluate(k, tangential, normal, dT, dN);
		(f > 0 ? low : high) = k;
		if (f == 0 || high - low <= 2 * std::numeric_limits<double>::epsilon() * high) break;
		double next = -1;
		if (normal > 0 && tangential > 0) {
			next = k - newton(tangential, normal, dT, dN);
			if (next > low && next < high && std::abs(next - k) <= std::numeric_limits<double>::epsilon() * k) return next;
		}
		if (!(next > low && next < high) || (i > 8 && i % 3 == 0)) next = low > 0 && low < 0.1 * high ? std::sqrt(low * high) : 0.5 * (low + high);
		if (low == 0 && !(next > 0)) next = 0.5 * high;
		k = next;
	}
	return k;
}

Vector3 OneContact::solve(const Vector3& b, double mu) const
{
	double unknown = 0;
	return solve(b, mu, unknown);
}

Vector3 OneContact::solve(const Vector3& b, double mu, double& rate) const
{
	const double bn = b[0];
	if (!(bn < 0) || !(Wnn > 0)) return Vector3::Zero();
	if (mu == 0) return {-bn / Wnn, 0, 0};
	const double cx = -(b[1] - wx * bn / Wnn), cy = -(b[2] - wy * bn / Wnn);
	const double cLarge = cosine * cx + sine * cy, cSmall = -sine * cx + cosine * cy;
	const double wLarge = cosine * wx + sine * wy, wSmall = -sine * wx + cosine * wy;
	// A direction that cannot move sticks only if it does not slip already.
	const bool canStick = (largeEigen > 0 || cLarge == 0) && (smallEigen > 0 || cSmall == 0);
	double rLarge = 0, rSmall = 0;
	if (canStick) {
		rLarge = largeEigen > 0 ? cLarge / largeEigen : 0;
		rSmall = smallEigen > 0 ? cSmall / smallEigen : 0;
		const double rn = -(bn + wLarge * rLarge + wSmall * rSmall) / Wnn;
		if (rn >= 0 && rLarge * rLarge + rSmall * rSmall <= mu * mu * rn * rn)
			return {rn, cosine * rLarge - sine * rSmall, sine * rLarge + cosine * rSmall};
	}
	const double k = slidingRate(cLarge, cSmall, wLarge, wSmall, bn, mu, rate);
	if (k < 0) {
		// Jammed: an impulse along the immobile direction lies inside the cone, so that the contact would stick, but no impulse changes the velocity
		// along it. By round-off, where the bodies are blocked: sticking is right. By a wall that is driven against it: there is no solution, and
		// the residual will say so. The rest of the motion is stopped in either case.
		rLarge = largeEigen > 0 ? cLarge / largeEigen : 0;
		rSmall = smallEigen > 0 ? cSmall / smallEigen : 0;
		const double rn = std::max(0.0, -(bn + wLarge * rLarge + wSmall * rSmall) / Wnn), rt = std::sqrt(rLarge * rLarge + rSmall * rSmall);
		const double scale = rt > mu * rn ? mu * rn / rt : 1;
		return {rn, scale * (cosine * rLarge - sine * rSmall), scale * (sine * rLarge + cosine * rSmall)};
	}
	rate = k;
	rLarge = cLarge / (largeEigen + k);
	rSmall = cSmall / (smallEigen + k);
	const double rn = std::sqrt(rLarge * rLarge + rSmall * rSmall) / mu;
	return {rn, cosine * rLarge - sine * rSmall, sine * rLarge + cosine * rSmall};
}

} // namespace contactdynamics
