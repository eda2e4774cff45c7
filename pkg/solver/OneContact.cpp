// SPDX-License-Identifier: GPL-2.0-or-later
#include "OneContact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace contactdynamics {

OneContact::OneContact(const Matrix3& W) : Wnn(W(0, 0))
{
	if (!(Wnn > 0)) return;
	inverseWnn = 1 / Wnn;
	const double wx = W(0, 1), wy = W(0, 2);
	const double a = W(1, 1) - wx * wx / Wnn, d = W(2, 2) - wy * wy / Wnn, off = W(1, 2) - wx * wy / Wnn;
	// One Jacobi rotation diagonalises a symmetric 2x2 matrix; the larger of sine and cosine first, without cancellation.
	const double mean = 0.5 * (a + d), radius = std::sqrt(0.25 * (a - d) * (a - d) + off * off);
	if (radius > 0) {
		const double larger = std::sqrt(0.5 + 0.25 * std::abs(a - d) / radius), smaller = 0.5 * std::abs(off) / (radius * larger);
		cosine = a >= d ? larger : smaller;
		sine = std::copysign(a >= d ? smaller : larger, off);
	}
	wLarge = cosine * wx + sine * wy;
	wSmall = -sine * wx + cosine * wy;
	largeEigen = std::max(0.0, mean + radius);
	smallEigen = std::max(0.0, mean - radius);
	// The Schur complement carries the round-off of its terms: below it an eigenvalue means "cannot move".
	roundOff = 8 * std::numeric_limits<double>::epsilon() * (W(1, 1) + W(2, 2));
	if (largeEigen <= roundOff) largeEigen = 0;
	if (smallEigen <= roundOff) smallEigen = 0;
	inverseLarge = largeEigen > 0 ? 1 / largeEigen : 0;
	inverseSmall = smallEigen > 0 ? 1 / smallEigen : 0;
}

/// What is known of a contact at one sliding rate k.
struct OneContact::Sliding {
	double large, small;	 // r_t along the eigenvectors
	double length, limit;	 // |r_t| and mu r_n
	double dLength2, dLimit; // d|r_t|/dk = -dLength2 / |r_t|, d(mu r_n)/dk

	double excess() const { return length - limit; }

	/// Newton's step on 1 / (mu r_n) - 1 / |r_t|, multiplied out to a single division. Not finite where there is none.
	double step() const { return excess() * limit * length * length / (dLength2 * limit * limit + dLimit * length * length * length); }
};

inline OneContact::Sliding OneContact::slideAt(double k, const Pushed& p) const
{
	const double inverse = 1 / ((largeEigen + k) * (smallEigen + k)), iL = inverse * (smallEigen + k), iS = inverse * (largeEigen + k);
	const double rL = p.large * iL, rS = p.small * iS;
	return {rL,
			rS,
			std::sqrt(rL * rL + rS * rS),
			-p.ratio * (p.normal + wLarge * rL + wSmall * rS),
			rL * rL * iL + rS * rS * iS,
			p.ratio * (wLarge * rL * iL + wSmall * rS * iS)};
}

/// Root k > 0 of f(k) = |r_t(k)| - mu r_n(k), f(0) > 0 > f(infinity). Newton on 1/(mu r_n) - 1/|r_t|, which is nearly linear in k (as in
/// trust-region methods), first from the guess, if any, without a bracket, then kept inside one; bisection of the logarithm when it leaves the
/// bracket or shrinks it too slowly.
inline double OneContact::slidingRate(const Pushed& p, double guess) const
{
	const double limit = -p.ratio * p.normal; // mu r_n for k -> infinity, > 0
	// A direction that cannot move and yet should: below the round-off of A the rate means nothing, see solve().
	double low = smallEigen > 0 ? 0 : roundOff, high = std::max(2 * low, std::sqrt(p.large * p.large + p.small * p.small) / limit);
	if (low > 0 && slideAt(low, p).excess() <= 0) return -1;
	for (int i = 0; i < 4 && guess > low; ++i) {
		const Sliding at = slideAt(guess, p);
		const double next = guess + at.step();
		if (!(at.limit > 0 && at.length > 0 && next > low)) break;
		// The error after a step is of the order of its square, and the next visit goes on from here. Near the pole, mu r_n -> 0, steps are short
		// for another reason.
		if (std::abs(next - guess) <= 1e-4 * guess && std::abs(at.excess()) <= 1e-3 * at.length) return next;
		guess = next;
	}
	while (slideAt(high, p).excess() > 0) {
		low = high;
		high *= 4;
	}
	// From here f(low) > 0 >= f(high). Start from the small side: the smallest root is wanted where strong coupling makes several.
	double k = low > 0 ? std::sqrt(low * high) : 0.25 * high;
	for (int i = 0; i < 200; ++i) {
		const Sliding at = slideAt(k, p);
		const double f = at.excess();
		(f > 0 ? low : high) = k;
		if (f == 0 || high - low <= 2 * std::numeric_limits<double>::epsilon() * high) break;
		double next = -1;
		if (at.limit > 0 && at.length > 0) {
			next = k + at.step();
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
	if (!(b[0] < 0) || !(Wnn > 0)) return Vector3::Zero();
	const double alone = b[0] * inverseWnn;
	if (mu == 0) return {-alone, 0, 0};
	const Pushed p{b[0], wLarge * alone - (cosine * b[1] + sine * b[2]), wSmall * alone - (cosine * b[2] - sine * b[1]), mu * inverseWnn};
	const auto inFrame = [&](double rn, double large, double small) {
		return Vector3(rn, cosine * large - sine * small, sine * large + cosine * small);
	};
	const double large = p.large * inverseLarge, small = p.small * inverseSmall, rn = -(alone + (wLarge * large + wSmall * small) * inverseWnn);
	const double length2 = large * large + small * small, bound = mu * rn;
	// A direction that cannot move sticks only if it does not slip already.
	const bool canStick = (largeEigen > 0 || p.large == 0) && (smallEigen > 0 || p.small == 0);
	if (canStick && rn >= 0 && length2 <= bound * bound) return inFrame(rn, large, small);
	const double k = slidingRate(p, rate);
	if (k < 0) {
		// Jammed: an impulse along the immobile direction lies inside the cone, so that the contact would stick, but no impulse changes the velocity
		// along it. By round-off, where the bodies are blocked: sticking is right. By a wall that is driven against it: there is no solution, and
		// the residual will say so. The rest of the motion is stopped in either case.
		const double scale = rn > 0 ? (length2 > bound * bound ? bound / std::sqrt(length2) : 1) : 0;
		return inFrame(std::max(0.0, rn), scale * large, scale * small);
	}
	rate = k;
	const double slidLarge = p.large / (largeEigen + k), slidSmall = p.small / (smallEigen + k);
	return inFrame(std::sqrt(slidLarge * slidLarge + slidSmall * slidSmall) / mu, slidLarge, slidSmall);
}

} // namespace contactdynamics
