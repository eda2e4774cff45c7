// SPDX-License-Identifier: GPL-2.0-or-later
// Body of one version of the ball sweep; included by BallSweepBaseline.cpp and BallSweepAvx2.cpp after BALL_SWEEP names the function.
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
	const Lanes even{0, 4, 2, 6}, odd{1, 5, 3, 7}, low{0, 1, 4, 5}, high{2, 3, 6, 7};
	const Wide ab0 = __builtin_shuffle(a, b, even), ab1 = __builtin_shuffle(a, b, odd);
	const Wide cd0 = __builtin_shuffle(c, d, even), cd1 = __builtin_shuffle(c, d, odd);
	a = __builtin_shuffle(ab0, cd0, low);
	b = __builtin_shuffle(ab1, cd1, low);
	c = __builtin_shuffle(ab0, cd0, high);
	d = __builtin_shuffle(ab1, cd1, high);
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

inline BodyState* at(BodyState* bodies, std::int32_t i) { return bodies + (i < 0 ? ~i : i); }

inline Side gather(BodyState* bodies, const std::int32_t* index)
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

inline void prefetchBodies(BodyState* bodies, const BallPack& pack)
{
#pragma GCC unroll 4
	for (int i = 0; i < 4; ++i) {
		__builtin_prefetch(at(bodies, pack.body1[i]), 1);
		__builtin_prefetch(at(bodies, pack.body2[i]), 1);
	}
}

inline double sum(Wide a) { return (a[0] + a[1]) + (a[2] + a[3]); }

} // namespace

template <bool hasField>
static inline SweepNorms sweepOf(BodyState* bodies, BallPack* packs, std::size_t count, Extrapolation extrapolation, FieldPass* field)
{
	const Wide zero = all(0), relax = all(extrapolation.relax), momentum = all(extrapolation.momentum);
	Wide increment2 = zero, impulse2 = zero, moment[9]{};
	constexpr std::size_t farAhead = 12;
	constexpr std::size_t ahead = 6; // packs: their bodies lie anywhere in memory, and only we know where
	for (BallPack* pack = packs; pack != packs + count; ++pack) {
		if (pack + ahead < packs + count) prefetchBodies(bodies, pack[ahead]);
		if (pack + farAhead < packs + count)
			for (std::size_t i = 0; i < sizeof(BallPack); i += 64) __builtin_prefetch(reinterpret_cast<const char*>(pack + farAhead) + i, 1);
		Side one = gather(bodies, pack->body1), two = gather(bodies, pack->body2);
		const Vector n = load(pack->normal);
		const Wide arm1 = load(pack->arm1), arm2 = load(pack->arm2);
		// v + w x (arm n) on both sides
		Vector u = (two.v - one.v) + cross(arm2 * two.w - arm1 * one.w, n);
		if (hasField) u = u + (arm1 - arm2) * (field->gradient * n);
		const Wide un = dot(u, n);
		const Vector ut = u - un * n;

		const Vector last = load(pack->increment), step = relax * last + momentum * load(pack->direction);
		const Vector x = load(pack->impulse) + step;
		store(pack->direction, last + step);
		const Wide xn = dot(x, n);
		const Vector xt = x - xn * n;

		Wide rn = xn - (un + load(pack->gapVelocity)) * load(pack->inverseWn);
		rn = rn > zero ? rn : zero;
		const Vector trial = xt - load(pack->inverseWt) * ut;
		const Wide length2 = dot(trial, trial), limit = load(pack->friction) * rn;
		const Wide slip = limit / squareRoot(length2);
		const Wide scale = length2 > limit * limit ? slip : all(1);
		const Vector rt = scale * trial, r = rn * n + rt, dr = r - x;
		store(pack->impulse, r);
		store(pack->increment, dr);

		const Wide Wn = one.inverseMass + two.inverseMass;
		const Wide Wt = Wn + arm1 * arm1 * one.inverseInertia + arm2 * arm2 * two.inverseInertia;
		if (hasField) addMoment(moment, (arm1 - arm2) * dr, n);
		const Wide dn = rn - xn;
		increment2 += Wn * dn * dn + Wt * (dot(dr, dr) - dn * dn);
		impulse2 += Wn * rn * rn + Wt * dot(rt, rt);

		const Vector turn = cross(n, dr);
		one.v = one.v - one.inverseMass * dr;
		one.w = one.w - (one.inverseInertia * arm1) * turn;
		two.v = two.v + two.inverseMass * dr;
		two.w = two.w + (two.inverseInertia * arm2) * turn;
		scatter(bodies, pack->body1, one);
		scatter(bodies, pack->body2, two);
	}
	if (hasField)
		for (int i = 0; i < 9; ++i) field->moment[i] += sum(moment[i]);
	return {sum(increment2), sum(impulse2)};
}

SweepNorms BALL_SWEEP(BodyState* bodies, BallPack* packs, std::size_t count, Extrapolation extrapolation, FieldPass* field)
{
	return field ? sweepOf<true>(bodies, packs, count, extrapolation, field) : sweepOf<false>(bodies, packs, count, extrapolation, field);
}

void BODY_ADVANCE(BodyState* now, BodyState* start, BodyState* direction, std::size_t count, Extrapolation extrapolation)
{
	const Wide relax = all(extrapolation.relax), momentum = all(extrapolation.momentum);
	const auto advance = [&](double* now, double* start, double* direction) {
		const Wide at = load(now), last = at - load(start), step = relax * last + momentum * load(direction), next = at + step;
		store(direction, last + step);
		store(start, next);
		store(now, next);
	};
	constexpr std::size_t ahead = 8; // bodies
	for (std::size_t i = 0; i < count; ++i) {
		__builtin_prefetch(now + i + ahead, 1);
		__builtin_prefetch(start + i + ahead, 1);
		__builtin_prefetch(direction + i + ahead, 1);
		advance(now[i].velocity, start[i].velocity, direction[i].velocity);
		advance(now[i].angularVelocity, start[i].angularVelocity, direction[i].angularVelocity);
	}
}

} // namespace contactdynamics
