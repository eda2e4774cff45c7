// SPDX-License-Identifier: GPL-2.0-or-later
// What sweep and certificate of general contacts have in common, WIDE_LANES at a time.
#pragma once

#include "GeneralPack.hpp"
#include "WideLanes.inl"

namespace contactdynamics {

namespace {

/// Along normal and tangents of a contact.
struct Local {
	Wide normal, large, small;
};
inline Local operator+(const Local& a, const Local& b) { return {a.normal + b.normal, a.large + b.large, a.small + b.small}; }
inline Local operator-(const Local& a, const Local& b) { return {a.normal - b.normal, a.large - b.large, a.small - b.small}; }
inline Local operator*(Wide s, const Local& a) { return {s * a.normal, s * a.large, s * a.small}; }
inline Local loadLocal(const double (*p)[packLanes], int lane) { return {load(p[0] + lane), load(p[1] + lane), load(p[2] + lane)}; }
inline void store(double (*p)[packLanes], int lane, const Local& a)
{
	store(p[0] + lane, a.normal);
	store(p[1] + lane, a.large);
	store(p[2] + lane, a.small);
}

struct Frame {
	Vector n, t1, t2;

	Local operator*(const Vector& a) const { return {dot(n, a), dot(t1, a), dot(t2, a)}; }
	Vector inGlobal(const Local& a) const { return a.normal * n + a.large * t1 + a.small * t2; }
};

inline Frame frameOf(const GeneralPack& pack, int lane)
{
	const Vector n = load(pack.normal, lane), t1 = load(pack.tangent, lane);
	return {n, t1, cross(n, t1)};
}

/// W of the visits.
struct LocalW {
	Wide nn, large, small, largeEigen, smallEigen;

	Wide inverseNn() const { return nn > all(0) ? all(1) / nn : all(0); }
	/// r^T W r, a sum of squares.
	Wide energy(const Local& r) const
	{
		const Wide normal = r.normal + (large * r.large + small * r.small) * inverseNn();
		return nn * normal * normal + largeEigen * r.large * r.large + smallEigen * r.small * r.small;
	}
};

inline LocalW delassusOf(const GeneralPack& pack, int lane)
{
	return {load(pack.Wnn + lane), load(pack.wLarge + lane), load(pack.wSmall + lane), load(pack.largeEigen + lane), load(pack.smallEigen + lane)};
}

inline const double* numbersOf(const BodyMobility* mobility) { return reinterpret_cast<const double*>(mobility); }

/// One side of the contacts with all its mobilities.
struct GeneralSide : Side {
	Wide massY, massZ;
	Vector diagonal;
	Wide yz, zx, xy;

	Vector turned(const Vector& torque) const
	{
		return {diagonal.x * torque.x + xy * torque.y + zx * torque.z, xy * torque.x + diagonal.y * torque.y + yz * torque.z,
				zx * torque.x + yz * torque.y + diagonal.z * torque.z};
	}
	Vector pushed(const Vector& impulse) const { return {inverseMass * impulse.x, massY * impulse.y, massZ * impulse.z}; }
};

inline GeneralSide gather(const BodyState* bodies, const BodyMobility* mobilities, const std::int32_t* index)
{
	const Columns m = gatherLines(numbersOf(mobilities), index);
	return {gather(bodies, index), m.of[0], m.of[1], {m.of[2], m.of[3], m.of[4]}, m.of[5], m.of[6], m.of[7]};
}

template <bool general> inline auto sideOf(const BodyState* bodies, const BodyMobility* mobilities, const std::int32_t* index)
{
	if constexpr (general)
		return gather(bodies, mobilities, index);
	else
		return gather(bodies, index);
}

inline void prefetchMobilities(const BodyMobility* mobilities, const GeneralPack& pack)
{
#pragma GCC unroll 8
	for (int i = 0; i < packLanes; ++i) {
		__builtin_prefetch(lineOf(numbersOf(mobilities), pack.body1[i]));
		__builtin_prefetch(lineOf(numbersOf(mobilities), pack.body2[i]));
	}
}

/// Velocity of body 2 relative to body 1 at the contact points, and of the mean field there, if any.
/// @param gradient  row by row, null: none
template <class OneSide>
Vector relativeVelocity(const OneSide& one, const OneSide& two, const Vector& arm1, const Vector& arm2, const double* gradient)
{
	const Vector u = (two.v - one.v) + (cross(two.w, arm2) - cross(one.w, arm1));
	return gradient ? u + gradient * (arm1 - arm2) : u;
}

/// r^T W r of impulses in global axes, by the mobilities of the bodies.
inline Wide energyOf(const Vector& r, const Vector& arm1, const Vector& arm2, const GeneralSide& one, const GeneralSide& two)
{
	const Vector turn1 = cross(arm1, r), turn2 = cross(arm2, r);
	return dot(r, one.pushed(r) + two.pushed(r)) + dot(turn1, one.turned(turn1)) + dot(turn2, two.turned(turn2));
}

/// To the velocities what impulses in global axes give.
inline void apply(const Vector& impulse, const Vector& arm1, const Vector& arm2, GeneralSide& one, GeneralSide& two)
{
	one.v = one.v - one.pushed(impulse);
	one.w = one.w - one.turned(cross(arm1, impulse));
	two.v = two.v + two.pushed(impulse);
	two.w = two.w + two.turned(cross(arm2, impulse));
}

} // namespace

} // namespace contactdynamics
