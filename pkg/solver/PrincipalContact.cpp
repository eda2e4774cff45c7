// SPDX-License-Identifier: GPL-2.0-or-later
#include "PrincipalContact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace contactdynamics {

namespace {

/// What is known of a contact at one sliding rate k.
struct Sliding {
	double large, small;	 // r_t along the eigenvectors
	double length, limit;	 // |r_t| and mu r_n
	double dLength2, dLimit; // d|r_t|/dk = -dLength2 / |r_t|, d(mu r_n)/dk

	double excess() const { return length - limit; }

	/// Newton's step on 1 / (mu r_n) - 1 / |r_t|, multiplied out to a single division. Not finite where there is none.
	double step() const { return excess() * limit * length * length / (dLength2 * limit * limit + dLimit * length * length * length); }
};

/// @param ratio  mu / W_nn
inline Sliding slideAt(double k, const PrincipalContact& W, const PrincipalPush& p, double ratio)
{
	const double inverse = 1 / ((W.largeEigen + k) * (W.smallEigen + k)), iL = inverse * (W.smallEigen + k), iS = inverse * (W.largeEigen + k);
	const double rL = p.large * iL, rS = p.small * iS;
	return {rL,
			rS,
			std::sqrt(rL * rL + rS * rS),
			-ratio * (p.normal + W.wLarge * rL + W.wSmall * rS),
			rL * rL * iL + rS * rS * iS,
			ratio * (W.wLarge * rL * iL + W.wSmall * rS * iS)};
}

/// Root k > 0 of f(k) = |r_t(k)| - mu r_n(k), f(0) > 0 > f(infinity). Newton on 1/(mu r_n) - 1/|r_t|, which is nearly linear in k (as in
/// trust-region methods), first from the guess, if any, without a bracket, then kept inside one; bisection of the logarithm when it leaves the
/// bracket or shrinks it too slowly.
inline double slidingRate(const PrincipalContact& W, const PrincipalPush& p, double ratio, double guess)
{
	const auto at = [&](double k) { return slideAt(k, W, p, ratio); };
	const double limit = -ratio * p.normal; // mu r_n for k -> infinity, > 0
	// A direction that cannot move and yet should: below the round-off of A the rate means nothing, see solve().
	double low = W.smallEigen > 0 ? 0 : W.roundOff, high = std::max(2 * low, std::sqrt(p.large * p.large + p.small * p.small) / limit);
	if (low > 0 && at(low).excess() <= 0) return -1;
	for (int i = 0; i < 4 && guess > low; ++i) {
		const Sliding here = at(guess);
		const double next = guess + here.step();
		if (!(here.limit > 0 && here.length > 0 && next > low)) break;
		// The error after a step is of the order of its square, and the next visit goes on from here. Near the pole, mu r_n -> 0, steps are short
		// for another reason.
		if (std::abs(next - guess) <= 1e-4 * guess && std::abs(here.excess()) <= 1e-3 * here.length) return next;
		guess = next;
	}
	while (at(high).excess() > 0) {
		low = high;
		high *= 4;
	}
	// From here f(low) > 0 >= f(high). Start from the small side: the smallest root is wanted where strong coupling makes several.
	double k = low > 0 ? std::sqrt(low * high) : 0.25 * high;
	for (int i = 0; i < 200; ++i) {
		const Sliding here = at(k);
		const double f = here.excess();
		(f > 0 ? low : high) = k;
		if (f == 0 || high - low <= 2 * std::numeric_limits<double>::epsilon() * high) break;
		double next = -1;
		if (here.limit > 0 && here.length > 0) {
			next = k + here.step();
			if (next > low && next < high && std::abs(next - k) <= std::numeric_limits<double>::epsilon() * k) return next;
		}
		if (!(next > low && next < high) || (i > 8 && i % 3 == 0)) next = low > 0 && low < 0.1 * high ? std::sqrt(low * high) : 0.5 * (low + high);
		if (low == 0 && !(next > 0)) next = 0.5 * high;
		k = next;
	}
	return k;
}

} // namespace

void solve(const PrincipalContact& W, const PrincipalPush& p, double mu, double& rate, double* r)
{
	const auto give = [r](double normal, double large, double small) {
		r[0] = normal;
		r[1] = large;
		r[2] = small;
	};
	if (!(p.normal < 0) || !(W.Wnn > 0)) return give(0, 0, 0);
	const double alone = p.normal * W.inverseWnn;
	if (mu == 0) return give(-alone, 0, 0);
	const double large = p.large * W.inverseLarge, small = p.small * W.inverseSmall;
	const double rn = -(alone + (W.wLarge * large + W.wSmall * small) * W.inverseWnn), length2 = large * large + small * small, bound = mu * rn;
	// A direction that cannot move sticks only if it does not slip already.
	const bool canStick = (W.largeEigen > 0 || p.large == 0) && (W.smallEigen > 0 || p.small == 0);
	if (canStick && rn >= 0 && length2 <= bound * bound) return give(rn, large, small);
	const double k = slidingRate(W, p, mu * W.inverseWnn, rate);
	if (k < 0) {
		// Jammed: an impulse along the immobile direction lies inside the cone, so that the contact would stick, but no impulse changes the velocity
		// along it. By round-off, where the bodies are blocked: sticking is right. By a wall that is driven against it: there is no solution, and
		// the residual will say so. The rest of the motion is stopped in either case.
		const double scale = rn > 0 ? (length2 > bound * bound ? bound / std::sqrt(length2) : 1) : 0;
		return give(std::max(0.0, rn), scale * large, scale * small);
	}
	rate = k;
	const double slidLarge = p.large / (W.largeEigen + k), slidSmall = p.small / (W.smallEigen + k);
	give(std::sqrt(slidLarge * slidLarge + slidSmall * slidSmall) / mu, slidLarge, slidSmall);
}

} // namespace contactdynamics
