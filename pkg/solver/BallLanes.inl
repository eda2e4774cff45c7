// SPDX-License-Identifier: GPL-2.0-or-later
// Four ball contacts in the lanes of wide numbers: what the kernels of BallSweep.inl and BallCertificate.inl have in common.
#pragma once

#include "BallPack.hpp"

namespace contactdynamics {

namespace {

typedef double Wide __attribute__((vector_size(32)));
typedef long long Lanes __attribute__((vector_size(32)));

inline Wide load(const double* p) { return *reinterpret_cast<const Wide*>(p); }
inline void store(double* p, Wide a) { *reinterpret_cast<Wide*>(p) = a; }
inline Wide all(double a) { return Wide{a, a, a, a}; }
inline Wide squareRoot(Wide a)
{
	// Lane by lane in the source; the compiler makes one instruction of it where it can, with the same correctly rounded result.
	Wide r;
	for (int i = 0; i < 4; ++i) r[i] = __builtin_sqrt(a[i]);
	return r;
}

inline void transpose(Wide& a, Wide& b, Wide& c, Wide& d)
{
	const Wide ab0 = __builtin_shufflevector(a, b, 0, 4, 2, 6), ab1 = __builtin_shufflevector(a, b, 1, 5, 3, 7);
	const Wide cd0 = __builtin_shufflevector(c, d, 0, 4, 2, 6), cd1 = __builtin_shufflevector(c, d, 1, 5, 3, 7);
	a = __builtin_shufflevector(ab0, cd0, 0, 1, 4, 5);
	b = __builtin_shufflevector(ab1, cd1, 0, 1, 4, 5);
	c = __builtin_shufflevector(ab0, cd0, 2, 3, 6, 7);
	d = __builtin_shufflevector(ab1, cd1, 2, 3, 6, 7);
}

struct Vector {
	Wide x, y, z;
};
inline Vector operator+(const Vector& a, const Vector& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vector operator-(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vector operator*(Wide s, const Vector& a) { return {s * a.x, s * a.y, s * a.z}; }
inline Wide dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vector cross(const Vector& a, const Vector& b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline Vector load(const double (*p)[4]) { return {load(p[0]), load(p[1]), load(p[2])}; }
inline void store(double (*p)[4], const Vector& a)
{
	store(p[0], a.x);
	store(p[1], a.y);
	store(p[2], a.z);
}

inline Vector operator*(const double* L, const Vector& a)
{
	const auto row = [&](int i) { return all(L[i]) * a.x + all(L[i + 1]) * a.y + all(L[i + 2]) * a.z; };
	return {row(0), row(3), row(6)};
}
inline void addMoment(Wide* moment, const Vector& r, const Vector& n)
{
	const auto add = [&](int i, Wide component) {
		moment[i] += component * n.x;
		moment[i + 1] += component * n.y;
		moment[i + 2] += component * n.z;
	};
	add(0, r.x);
	add(3, r.y);
	add(6, r.z);
}

/// Velocities and mobilities of one side of the four contacts.
struct Side {
	Vector v, w;
	Wide inverseMass, inverseInertia;
};

inline const BodyState* at(const BodyState* bodies, std::int32_t i) { return bodies + (i < 0 ? ~i : i); }

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

inline void prefetchBodies(const BodyState* bodies, const BallPack& pack)
{
#pragma GCC unroll 4
	for (int i = 0; i < 4; ++i) {
		__builtin_prefetch(at(bodies, pack.body1[i]), 1);
		__builtin_prefetch(at(bodies, pack.body2[i]), 1);
	}
}

/// Torques of RollingContact::improved(). What is not finite stays visible in the part across the normal.
/// @param spin  angular velocity of body 2 minus that of body 1
inline Vector improvedTorque(const RollingPack& rolling, const Vector& torque, const Vector& spin, const Vector& n, Wide normalImpulse)
{
	const Vector trial = torque - load(rolling.inverseMobility) * (spin + load(rolling.drive));
	const Wide most = load(rolling.twistingArm) * normalImpulse, limit = load(rolling.rollingArm) * normalImpulse;
	Wide along = dot(trial, n);
	const Vector across = trial - along * n;
	along = along < -most ? -most : along;
	along = along > most ? most : along;
	const Wide length2 = dot(across, across), slip = limit / squareRoot(length2);
	return along * n + (length2 > limit * limit ? slip : all(1)) * across;
}

inline double sum(Wide a) { return (a[0] + a[1]) + (a[2] + a[3]); }

} // namespace

} // namespace contactdynamics
