// SPDX-License-Identifier: GPL-2.0-or-later
// Contacts in the lanes of wide numbers, WIDE_LANES at a time: what all kernels have in common.
#pragma once

#include "BallPack.hpp"

namespace contactdynamics {

namespace {

typedef double Wide __attribute__((vector_size(8 * WIDE_LANES)));
typedef long long Lanes __attribute__((vector_size(8 * WIDE_LANES)));
constexpr int parts = packLanes / WIDE_LANES; // of a pack

inline Wide load(const double* p) { return *reinterpret_cast<const Wide*>(p); }
inline void store(double* p, Wide a) { *reinterpret_cast<Wide*>(p) = a; }
inline Wide all(double a) { return a - Wide{}; } // minus zero, because minus zero plus zero is zero
inline Wide squareRoot(Wide a)
{
	// Lane by lane in the source; the compiler makes one instruction of it where it can, with the same correctly rounded result.
	Wide r;
	for (int i = 0; i < WIDE_LANES; ++i) r[i] = __builtin_sqrt(a[i]);
	return r;
}

inline Wide magnitude(Wide a) { return (Wide)((Lanes)a & 0x7fffffffffffffff); }
inline bool any(Lanes mask)
{
	long long found = 0;
	for (int i = 0; i < WIDE_LANES; ++i) found |= mask[i];
	return found != 0;
}

struct Vector {
	Wide x, y, z;
};
inline Vector operator+(const Vector& a, const Vector& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vector operator-(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vector operator*(Wide s, const Vector& a) { return {s * a.x, s * a.y, s * a.z}; }
inline Wide dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vector cross(const Vector& a, const Vector& b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline Vector load(const double (*p)[packLanes], int lane) { return {load(p[0] + lane), load(p[1] + lane), load(p[2] + lane)}; }
inline void store(double (*p)[packLanes], int lane, const Vector& a)
{
	store(p[0] + lane, a.x);
	store(p[1] + lane, a.y);
	store(p[2] + lane, a.z);
}

inline Vector operator*(const double* L, const Vector& a)
{
	const auto row = [&](int i) { return all(L[i]) * a.x + all(L[i + 1]) * a.y + all(L[i + 2]) * a.z; };
	return {row(0), row(3), row(6)};
}
/// @param moment  of nine components, by parts
inline void addMoment(Wide (*moment)[parts], int part, const Vector& r, const Vector& n)
{
	const auto add = [&](int i, Wide component) {
		moment[i][part] += component * n.x;
		moment[i + 1][part] += component * n.y;
		moment[i + 2][part] += component * n.z;
	};
	add(0, r.x);
	add(3, r.y);
	add(6, r.z);
}

/// Velocities and mobilities of one side of the contacts.
struct Side {
	Vector v, w;
	Wide inverseMass, inverseInertia;
};

inline const BodyState* at(const BodyState* bodies, std::int32_t i) { return bodies + (i < 0 ? ~i : i); }

/// The numbers of a body, in the order of BodyState.
inline const double* numbersOf(const BodyState* body) { return reinterpret_cast<const double*>(body); }
inline double* numbersOf(BodyState* body) { return reinterpret_cast<double*>(body); }

inline const double* lineOf(const double* lines, std::int32_t i) { return lines + 8 * std::ptrdiff_t(i < 0 ? ~i : i); }
struct Columns {
	Wide of[8];
};

#if WIDE_LANES == 8

/// Rows to columns.
inline void transpose(Wide* row)
{
	Wide pair[8]; // of rows: their even numbers, then their odd ones
	for (int i = 0; i < 8; i += 2) {
		pair[i] = __builtin_shufflevector(row[i], row[i + 1], 0, 8, 2, 10, 4, 12, 6, 14);
		pair[i + 1] = __builtin_shufflevector(row[i], row[i + 1], 1, 9, 3, 11, 5, 13, 7, 15);
	}
	for (int i = 0; i < 2; ++i) {
		const auto even = [](Wide a, Wide b) { return __builtin_shufflevector(a, b, 0, 1, 4, 5, 8, 9, 12, 13); };
		const auto odd = [](Wide a, Wide b) { return __builtin_shufflevector(a, b, 2, 3, 6, 7, 10, 11, 14, 15); };
		const Wide upper04 = even(pair[i], pair[i + 2]), upper26 = odd(pair[i], pair[i + 2]);
		const Wide lower04 = even(pair[i + 4], pair[i + 6]), lower26 = odd(pair[i + 4], pair[i + 6]);
		row[i] = even(upper04, lower04);
		row[i + 4] = odd(upper04, lower04);
		row[i + 2] = even(upper26, lower26);
		row[i + 6] = odd(upper26, lower26);
	}
}

/// The lines of eight numbers with these indices, by columns.
inline Columns gatherLines(const double* lines, const std::int32_t* index)
{
	Columns lane;
#pragma GCC unroll 8
	for (int i = 0; i < 8; ++i) lane.of[i] = load(lineOf(lines, index[i]));
	transpose(lane.of);
	return lane;
}

inline void scatter(BodyState* bodies, const std::int32_t* index, const Side& side)
{
	Wide row[8]{side.v.x, side.v.y, side.v.z, side.inverseMass, side.w.x, side.w.y, side.w.z, side.inverseInertia};
	transpose(row);
#pragma GCC unroll 8
	for (int i = 0; i < 8; ++i)
		if (index[i] >= 0) store(numbersOf(bodies + index[i]), row[i]);
}

#elif WIDE_LANES == 4

inline void transpose(Wide& a, Wide& b, Wide& c, Wide& d)
{
	const Wide ab0 = __builtin_shufflevector(a, b, 0, 4, 2, 6), ab1 = __builtin_shufflevector(a, b, 1, 5, 3, 7);
	const Wide cd0 = __builtin_shufflevector(c, d, 0, 4, 2, 6), cd1 = __builtin_shufflevector(c, d, 1, 5, 3, 7);
	a = __builtin_shufflevector(ab0, cd0, 0, 1, 4, 5);
	b = __builtin_shufflevector(ab1, cd1, 0, 1, 4, 5);
	c = __builtin_shufflevector(ab0, cd0, 2, 3, 6, 7);
	d = __builtin_shufflevector(ab1, cd1, 2, 3, 6, 7);
}

inline Columns gatherLines(const double* lines, const std::int32_t* index)
{
	const double *l0 = lineOf(lines, index[0]), *l1 = lineOf(lines, index[1]), *l2 = lineOf(lines, index[2]), *l3 = lineOf(lines, index[3]);
	Columns lane{{load(l0), load(l1), load(l2), load(l3), load(l0 + 4), load(l1 + 4), load(l2 + 4), load(l3 + 4)}};
	transpose(lane.of[0], lane.of[1], lane.of[2], lane.of[3]);
	transpose(lane.of[4], lane.of[5], lane.of[6], lane.of[7]);
	return lane;
}

inline void scatter(BodyState* bodies, const std::int32_t* index, const Side& side)
{
	Wide v[4]{side.v.x, side.v.y, side.v.z, side.inverseMass}, w[4]{side.w.x, side.w.y, side.w.z, side.inverseInertia};
	transpose(v[0], v[1], v[2], v[3]);
	transpose(w[0], w[1], w[2], w[3]);
#pragma GCC unroll 4
	for (int i = 0; i < 4; ++i) {
		if (index[i] < 0) continue;
		store(bodies[index[i]].velocity, v[i]);
		store(bodies[index[i]].angularVelocity, w[i]);
	}
}

#else

inline Columns gatherLines(const double* lines, const std::int32_t* index)
{
	const double *l0 = lineOf(lines, index[0]), *l1 = lineOf(lines, index[1]);
	Columns lane;
#pragma GCC unroll 4
	for (int k = 0; k < 8; k += 2) {
		const Wide a = load(l0 + k), b = load(l1 + k);
		lane.of[k] = __builtin_shufflevector(a, b, 0, 2);
		lane.of[k + 1] = __builtin_shufflevector(a, b, 1, 3);
	}
	return lane;
}

inline void scatter(BodyState* bodies, const std::int32_t* index, const Side& side)
{
	const Wide lane[8]{side.v.x, side.v.y, side.v.z, side.inverseMass, side.w.x, side.w.y, side.w.z, side.inverseInertia};
#pragma GCC unroll 4
	for (int k = 0; k < 8; k += 2) {
		if (index[0] >= 0) store(numbersOf(bodies + index[0]) + k, __builtin_shufflevector(lane[k], lane[k + 1], 0, 2));
		if (index[1] >= 0) store(numbersOf(bodies + index[1]) + k, __builtin_shufflevector(lane[k], lane[k + 1], 1, 3));
	}
}

#endif

inline Side gather(const BodyState* bodies, const std::int32_t* index)
{
	const Columns lane = gatherLines(numbersOf(bodies), index);
	return {{lane.of[0], lane.of[1], lane.of[2]}, {lane.of[4], lane.of[5], lane.of[6]}, lane.of[3], lane.of[7]};
}

template <bool forWriting, class Pack> void prefetchBodies(const BodyState* bodies, const Pack& pack)
{
#pragma GCC unroll 8
	for (int i = 0; i < packLanes; ++i) {
		__builtin_prefetch(at(bodies, pack.body1[i]), forWriting);
		__builtin_prefetch(at(bodies, pack.body2[i]), forWriting);
	}
}

/// Torques of RollingContact::improved(). What is not finite stays visible in the part across the normal.
/// @param spin  angular velocity of body 2 minus that of body 1
inline Vector improvedTorque(const RollingPack& rolling, int lane, const Vector& torque, const Vector& spin, const Vector& n, Wide normalImpulse)
{
	const Vector trial = torque - load(rolling.inverseMobility + lane) * (spin + load(rolling.drive, lane));
	const Wide most = load(rolling.twistingArm + lane) * normalImpulse, limit = load(rolling.rollingArm + lane) * normalImpulse;
	Wide along = dot(trial, n);
	const Vector across = trial - along * n;
	along = along < -most ? -most : along;
	along = along > most ? most : along;
	const Wide length2 = dot(across, across), slip = limit / squareRoot(length2);
	return along * n + (length2 > limit * limit ? slip : all(1)) * across;
}

/// One visit of the torques of RollingContact.hpp; returns how they change, and adds it to the norms of the sweep.
inline Vector visitTorque(RollingPack& rolling, int lane, Wide relax, Wide momentum, const Vector& spin, const Vector& n, Wide normalImpulse,
						  Wide& increment2, Wide& impulse2)
{
	const Vector last = load(rolling.increment, lane), ahead = relax * last + momentum * load(rolling.direction, lane);
	const Vector before = load(rolling.torque, lane) + ahead, torque = improvedTorque(rolling, lane, before, spin, n, normalImpulse);
	const Vector change = torque - before;
	store(rolling.direction, lane, last + ahead);
	store(rolling.torque, lane, torque);
	store(rolling.increment, lane, change);
	const Wide Ww = load(rolling.mobility + lane);
	increment2 += Ww * dot(change, change);
	impulse2 += Ww * dot(torque, torque);
	return change;
}

/// Over the lanes of a pack, in one order for all versions.
inline double sum(const Wide* part)
{
	const auto lane = [part](int i) { return part[i / WIDE_LANES][i % WIDE_LANES]; };
	return ((lane(0) + lane(1)) + (lane(2) + lane(3))) + ((lane(4) + lane(5)) + (lane(6) + lane(7)));
}

/// Lanes are filled in order.
template <class Pack> bool isEmpty(const Pack& pack, int lane) { return lane > 0 && pack.id[lane] < 0; }

} // namespace

} // namespace contactdynamics
