// SPDX-License-Identifier: GPL-2.0-or-later
// Body of one version of the ball sweep; included by BallSweepBaseline.cpp and BallSweepAvx2.cpp after BALL_SWEEP names the function.
#include "BallLanes.inl"

namespace contactdynamics {

template <bool hasField, bool rolls> static inline SweepNorms sweepOf(BodyState* bodies, BallPack* packs, RollingPack* rolling, std::size_t count,
																	  Extrapolation extrapolation, FieldPass* field)
{
	const Wide zero = all(0), relax = all(extrapolation.relax), momentum = all(extrapolation.momentum);
	Wide increment2 = zero, impulse2 = zero, moment[9]{};
	constexpr std::ptrdiff_t farAhead = 12;
	constexpr std::ptrdiff_t ahead = 6; // packs: their bodies lie anywhere in memory, and only we know where
	const BallPack* const end = packs + count;
	for (BallPack* pack = packs; pack != end; ++pack) {
		if (end - pack > ahead) prefetchBodies(bodies, pack[ahead]);
		if (end - pack > farAhead)
			for (std::size_t i = 0; i < sizeof(BallPack); i += 64) __builtin_prefetch(reinterpret_cast<const char*>(pack + farAhead) + i, 1);
		if (rolls && end - pack > farAhead)
			for (std::size_t i = 0; i < sizeof(RollingPack); i += 64)
				__builtin_prefetch(reinterpret_cast<const char*>(rolling + (pack - packs) + farAhead) + i, 1);
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
		if (rolls) {
			RollingPack& roll = rolling[pack - packs];
			const Vector lastTurn = load(roll.increment), turnAhead = relax * lastTurn + momentum * load(roll.direction);
			const Vector before = load(roll.torque) + turnAhead, torque = improvedTorque(roll, before, two.w - one.w, n, rn), dm = torque - before;
			store(roll.direction, lastTurn + turnAhead);
			store(roll.torque, torque);
			store(roll.increment, dm);
			one.w = one.w - one.inverseInertia * dm;
			two.w = two.w + two.inverseInertia * dm;
			const Wide Ww = load(roll.mobility);
			increment2 += Ww * dot(dm, dm);
			impulse2 += Ww * dot(torque, torque);
		}
		scatter(bodies, pack->body1, one);
		scatter(bodies, pack->body2, two);
	}
	if (hasField)
		for (int i = 0; i < 9; ++i) field->moment[i] += sum(moment[i]);
	return {sum(increment2), sum(impulse2)};
}

SweepNorms BALL_SWEEP(BodyState* bodies, BallPack* packs, RollingPack* rolling, std::size_t count, Extrapolation extrapolation, FieldPass* field)
{
	if (rolling)
		return field ? sweepOf<true, true>(bodies, packs, rolling, count, extrapolation, field)
					 : sweepOf<false, true>(bodies, packs, rolling, count, extrapolation, field);
	return field ? sweepOf<true, false>(bodies, packs, rolling, count, extrapolation, field)
				 : sweepOf<false, false>(bodies, packs, rolling, count, extrapolation, field);
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
	// Beyond the last body, too: there the next block may begin. As a number, because a pointer must not go there.
	const auto prefetch = [](const BodyState* body) {
		constexpr std::size_t ahead = 8; // bodies
		__builtin_prefetch(reinterpret_cast<const void*>(reinterpret_cast<std::uintptr_t>(body) + ahead * sizeof(BodyState)), 1);
	};
	for (std::size_t i = 0; i < count; ++i) {
		prefetch(now + i);
		prefetch(start + i);
		prefetch(direction + i);
		advance(now[i].velocity, start[i].velocity, direction[i].velocity);
		advance(now[i].angularVelocity, start[i].angularVelocity, direction[i].angularVelocity);
	}
}

} // namespace contactdynamics
