// SPDX-License-Identifier: GPL-2.0-or-later
// What the certificates of ball and of general contacts have in common, WIDE_LANES at a time.
#pragma once

#include "ContactKernels.hpp"
#include "WideLanes.inl"

namespace contactdynamics {

namespace {

struct FetchDistance {
	std::ptrdiff_t bodies, packs; // how many packs ahead
};

/// Fetches what lies ahead: bodies, and of the packs what is used here, not increment and direction.
template <bool forWriting, class Pack> void fetchAhead(const BodyState* bodies, const Pack* pack, const Pack* end, FetchDistance distance)
{
	constexpr std::size_t line = 64;
	if (end - pack > distance.bodies) prefetchBodies<forWriting>(bodies, pack[distance.bodies]);
	if (end - pack <= distance.packs) return;
	const char* next = reinterpret_cast<const char*>(pack + distance.packs);
	for (std::size_t at = 0; at < offsetof(Pack, increment); at += line) __builtin_prefetch(next + at);
	for (std::size_t at = offsetof(Pack, body1); at < sizeof(Pack); at += line) __builtin_prefetch(next + at);
}

inline Wide largest(Wide a, Wide b) { return b > a ? b : a; }
inline double largestLane(Wide a)
{
	double top = 0;
	for (int lane = 0; lane < WIDE_LANES; ++lane) top = a[lane] > top ? a[lane] : top;
	return top;
}
inline Wide sizeOf(const Vector& a) { return magnitude(a.x) + magnitude(a.y) + magnitude(a.z); }
inline Wide sizeOf(const double* gradient)
{
	Wide size = all(0);
	for (int i = 0; i < 9; ++i) size += magnitude(all(gradient[i]));
	return size;
}
inline Vector chosen(Lanes mask, const Vector& a, const Vector& b) { return {mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z}; }

template <class Tangent> struct ScaledMap {
	Wide n;
	Tangent t;
};

/// NaturalMap.hpp with everything multiplied by W_nn: with Z = W_nn r - (u + mu |u_t| n), a velocity, W_nn F = W_nn r - P_K(Z), since K is a cone.
template <class Tangent> ScaledMap<Tangent> scaledMap(Wide Wn, Wide mu, Wide rn, const Tangent& rt, Wide un, const Tangent& ut)
{
	const Wide rise = un + mu * squareRoot(dot(ut, ut)), Wrn = Wn * rn, zn = Wrn - rise;
	const Tangent Wrt = Wn * rt, zt = Wrt - ut;
	const Wide length = squareRoot(dot(zt, zt)), slope = mu * length, onRim = (zn + slope) / ((all(1) + mu * mu) * length);
	const Lanes inside = (zn >= all(0)) & (length <= mu * zn), polar = slope <= -zn;
	const Wide normal = inside ? rise : (polar ? Wrn : Wrn - onRim * length);
	return {normal, chosen(inside, ut, chosen(polar, Wrt, Wrt - (mu * onRim) * zt))};
}

/// @param size2  of a map, squared;  @param speeds  what the velocities in it are made of
inline Lanes isRoundOff(Wide size2, Wide speeds, RoundOff roundOff)
{
	const Wide most = all(roundOff.most), noise = all(roundOff.perSpeed) * speeds;
	return size2 <= (noise < most ? noise * noise : most * most);
}

/// Adds the torques of one part of a pack to the sums.
inline void certifyTorque(const RollingPack& rolling, int lane, const Vector& w1, const Vector& w2, const Vector& n, Wide normalImpulse,
						  RoundOff roundOff, Wide& map2, Wide& impulse2)
{
	const Wide zero = all(0), Ww = load(rolling.mobility + lane);
	const Vector torque = load(rolling.torque, lane), map = torque - improvedTorque(rolling, lane, torque, w2 - w1, n, normalImpulse);
	const Wide speeds = sizeOf(w1) + sizeOf(w2) + sizeOf(load(rolling.drive, lane)), size2 = dot(map, map);
	const Wide noise = all(roundOff.perSpeed) * speeds * load(rolling.inverseMobility + lane);
	// What is not finite must not be masked: zero times it is not a number.
	map2 += (size2 > noise * noise ? Ww * size2 : zero) + zero * size2;
	impulse2 += Ww * dot(torque, torque);
}

} // namespace

} // namespace contactdynamics
