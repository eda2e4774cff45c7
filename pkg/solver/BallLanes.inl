// SPDX-License-Identifier: GPL-2.0-or-later
// Ball contacts in the lanes of wide numbers, WIDE_LANES at a time: what the kernels of BallSweep.inl and BallCertificate.inl have in common.
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

inline Side gather(const BodyState* bodies, const std::int32_t* index)
{
	Wide row[8];
#pragma GCC unroll 8
	for (int i = 0; i < 8; ++i) row[i] = load(numbersOf(at(bodies, index[i])));
	transpose(row);
	return {{row[0], row[1], row[2]}, {row[4], row[5], row[6]}, row[3], row[7]};
}

inline void scatter(BodyState* bodies, const std::int32_t* index, const Side& side)
{
	Wide row[8]{side.v.x, side.v.y, side.v.z, side.inverseMass, side.w.x, side.w.y, side.w.z, side.inverseInertia};
	transpose(row);
#pragma GCC unroll 8
	for (int i = 0; i < 8; ++i)
		if (index[i] >= 0) store(numbersOf(bodies + index[i]), row[i]);
}

#else

inline void transpose(Wide& a, Wide& b, Wide& c, Wide& d)
{
	const Wide ab0 = __builtin_shufflevector(a, b, 0, 4, 2, 6), ab1 = __builtin_shufflevector(a, b, 1, 5, 3, 7);
	const Wide cd0 = __builtin_shufflevector(c, d, 0, 4, 2, 6), cd1 = __builtin_shufflevector(c, d, 1, 5, 3, 7);
	a = __builtin_shufflevector(ab0, cd0, 0, 1, 4, 5);
	b = __builtin_shufflevector(ab1, cd1, 0, 1, 4, 5);
	c = __builtin_shufflevector(ab0, cd0, 2, 3, 6, 7);
	d = __builtin_shufflevector(ab1, cd1, 2, 3, 6, 7);
}

inline Side gather(const BodyState* bodies, const std::int32_t* index)
{
	const BodyState *b0 = at(bodies, index[0]), *b1 = at(bodies, index[1]), *b2 = at(bodies, index[2]), *b3 = at(bodies, index[3]);
	Wide a = load(b0->velocity), b = load(b1->velocity), c = load(b2->velocity), d = load(b3->velocity);
	Wide e = load(b0->angularVelocity), f = load(b1->angularVelocity), g = load(b2->angularVelocity), h = load(b3->angularVelocity);
	transpose(a, b, c, d);
	transpose(e, f, g, h);
	return {{a, b, c}, {e, f, g}, d, h};
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

#endif

template <bool forWriting> void prefetchBodies(const BodyState* bodies, const BallPack& pack)
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

/// Over the lanes of a pack, in one order for all versions.
inline double sum(const Wide* part)
{
	const auto lane = [part](int i) { return part[i / WIDE_LANES][i % WIDE_LANES]; };
	return ((lane(0) + lane(1)) + (lane(2) + lane(3))) + ((lane(4) + lane(5)) + (lane(6) + lane(7)));
}

/// Lanes are filled in order.
inline bool isEmpty(const BallPack& pack, int lane) { return lane > 0 && pack.id[lane] < 0; }

} // namespace

} // namespace contactdynamics
