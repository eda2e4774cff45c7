// SPDX-License-Identifier: GPL-2.0-or-later
// Sweep and extrapolation; included by one file for each version, which says how many lanes a wide number has.
#include "ContactKernels.hpp"
#include "WideLanes.inl"

namespace contactdynamics {

namespace {

template <bool hasField, bool rolls> __attribute__((flatten)) SweepNorms sweepOf(BodyState* bodies, BallPack* packs, RollingPack* rolling,
																				 std::size_t count, Extrapolation extrapolation, FieldPass* field)
{
	const Wide zero = all(0), relax = all(extrapolation.relax), momentum = all(extrapolation.momentum);
	Wide increment2[parts]{}, impulse2[parts]{}, moment[9][parts]{};
	constexpr std::ptrdiff_t farAhead = 6;
	constexpr std::ptrdiff_t ahead = 3; // packs: their bodies lie anywhere in memory, and only we know where
	const BallPack* const end = packs + count;
	for (BallPack* pack = packs; pack != end; ++pack) {
		if (end - pack > ahead) prefetchBodies<true>(bodies, pack[ahead]);
		if (end - pack > farAhead)
			for (std::size_t i = 0; i < sizeof(BallPack); i += 64) __builtin_prefetch(reinterpret_cast<const char*>(pack + farAhead) + i, 1);
		if (rolls && end - pack > farAhead)
			for (std::size_t i = 0; i < sizeof(RollingPack); i += 64)
				__builtin_prefetch(reinterpret_cast<const char*>(rolling + (pack - packs) + farAhead) + i, 1);
		for (int part = 0, lane = 0; part < parts; ++part, lane += WIDE_LANES) {
			if (isEmpty(*pack, lane)) break;
			Side one = gather(bodies, pack->body1 + lane), two = gather(bodies, pack->body2 + lane);
			const Vector n = load(pack->normal, lane);
			const Wide arm1 = load(pack->arm1 + lane), arm2 = load(pack->arm2 + lane);
			// v + w x (arm n) on both sides
			Vector u = (two.v - one.v) + cross(arm2 * two.w - arm1 * one.w, n);
			if (hasField) u = u + (arm1 - arm2) * (field->gradient * n);
			const Wide un = dot(u, n);
			const Vector ut = u - un * n;

			const Vector last = load(pack->increment, lane), step = relax * last + momentum * load(pack->direction, lane);
			const Vector x = load(pack->impulse, lane) + step;
			store(pack->direction, lane, last + step);
			const Wide xn = dot(x, n);
			const Vector xt = x - xn * n;

			Wide rn = xn - (un + load(pack->gapVelocity + lane)) * load(pack->inverseWn + lane);
			rn = rn > zero ? rn : zero;
			const Vector trial = xt - load(pack->inverseWt + lane) * ut;
			const Wide length2 = dot(trial, trial), limit = load(pack->friction + lane) * rn;
			const Wide slip = limit / squareRoot(length2);
			const Wide scale = length2 > limit * limit ? slip : all(1);
			const Vector rt = scale * trial, r = rn * n + rt, dr = r - x;
			store(pack->impulse, lane, r);
			store(pack->increment, lane, dr);

			const Wide Wn = one.inverseMass + two.inverseMass;
			const Wide Wt = Wn + arm1 * arm1 * one.inverseInertia + arm2 * arm2 * two.inverseInertia;
			if (hasField) addMoment(moment, part, (arm1 - arm2) * dr, n);
			const Wide dn = rn - xn;
			increment2[part] += Wn * dn * dn + Wt * (dot(dr, dr) - dn * dn);
			impulse2[part] += Wn * rn * rn + Wt * dot(rt, rt);

			const Vector turn = cross(n, dr);
			one.v = one.v - one.inverseMass * dr;
			one.w = one.w - (one.inverseInertia * arm1) * turn;
			two.v = two.v + two.inverseMass * dr;
			two.w = two.w + (two.inverseInertia * arm2) * turn;
			if (rolls) {
				const Vector dm = visitTorque(rolling[pack - packs], lane, relax, momentum, two.w - one.w, n, rn, increment2[part], impulse2[part]);
				one.w = one.w - one.inverseInertia * dm;
				two.w = two.w + two.inverseInertia * dm;
			}
			scatter(bodies, pack->body1 + lane, one);
			scatter(bodies, pack->body2 + lane, two);
		}
	}
	if (hasField)
		for (int i = 0; i < 9; ++i) field->moment[i] += sum(moment[i]);
	return {sum(increment2), sum(impulse2)};
}

SweepNorms sweepPacks(BodyState* bodies, BallPack* packs, RollingPack* rolling, std::size_t count, Extrapolation extrapolation, FieldPass* field)
{
	const auto sweep = rolling ? (field ? sweepOf<true, true> : sweepOf<false, true>) : (field ? sweepOf<true, false> : sweepOf<false, false>);
	return sweep(bodies, packs, rolling, count, extrapolation, field);
}

void advanceBodies(BodyState* now, BodyState* start, BodyState* direction, std::size_t count, Extrapolation extrapolation)
{
	const Wide relax = all(extrapolation.relax), momentum = all(extrapolation.momentum);
	const auto advance = [&](double* now, double* start, double* direction) {
		const Wide at = load(now), last = at - load(start), step = relax * last + momentum * load(direction), next = at + step;
		store(direction, last + step);
		store(start, next);
		store(now, next);
	};
	// Beyond the last body, too: there the next block may begin. As a number, because a pointer must not go there.
	const auto prefetch = [](const BodyState* body) {
		const std::uintptr_t ahead = reinterpret_cast<std::uintptr_t>(body) + 8 * sizeof(BodyState);
		__builtin_prefetch(reinterpret_cast<const void*>(ahead), 1); // NOLINT(performance-no-int-to-ptr)
	};
	constexpr int numbers = sizeof(BodyState) / sizeof(double);
	for (std::size_t i = 0; i < count; ++i) {
		prefetch(now + i);
		prefetch(start + i);
		prefetch(direction + i);
		for (int k = 0; k < numbers; k += WIDE_LANES) advance(numbersOf(now + i) + k, numbersOf(start + i) + k, numbersOf(direction + i) + k);
	}
}

} // namespace

} // namespace contactdynamics
