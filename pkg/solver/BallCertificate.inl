// SPDX-License-Identifier: GPL-2.0-or-later
// The certificate of ball contacts; included as BallSweep.inl is.
#include "BallKernels.hpp"
#include "BallLanes.inl"

namespace contactdynamics {

namespace {

/// Fetches what lies ahead: of the packs what is used here (not increment and direction), and the bodies.
template <bool forWriting> void fetchAhead(const BodyState* bodies, const BallPack* pack, const BallPack* end)
{
	constexpr std::ptrdiff_t far = 6, near = 3, line = 64;
	if (end - pack > near) prefetchBodies<forWriting>(bodies, pack[near]);
	if (end - pack <= far) return;
	const char* next = reinterpret_cast<const char*>(pack + far);
	for (std::size_t at = 0; at < offsetof(BallPack, increment); at += line) __builtin_prefetch(next + at);
	for (std::size_t at = offsetof(BallPack, body1); at < sizeof(BallPack); at += line) __builtin_prefetch(next + at);
}

inline Wide magnitude(Wide a) { return (Wide)((Lanes)a & 0x7fffffffffffffff); }
inline bool any(Lanes mask)
{
	long long found = 0;
	for (int i = 0; i < WIDE_LANES; ++i) found |= mask[i];
	return found != 0;
}
inline Wide largest(Wide a, Wide b) { return b > a ? b : a; }
inline Wide sizeOf(const Vector& a) { return magnitude(a.x) + magnitude(a.y) + magnitude(a.z); }

template <bool hasField, bool rolls>
void rebuildOf(BodyState* bodies, const BallPack* packs, const RollingPack* rolling, std::size_t count, FieldPass* field)
{
	Wide moment[9][parts]{};
	for (const BallPack* pack = packs; pack != packs + count; ++pack) {
		fetchAhead<true>(bodies, pack, packs + count);
		for (int part = 0, lane = 0; part < parts; ++part, lane += WIDE_LANES) {
			if (isEmpty(*pack, lane)) break;
			Side one = gather(bodies, pack->body1 + lane), two = gather(bodies, pack->body2 + lane);
			const Vector n = load(pack->normal, lane), r = load(pack->impulse, lane), turn = cross(n, r);
			const Wide arm1 = load(pack->arm1 + lane), arm2 = load(pack->arm2 + lane);
			if (hasField) addMoment(moment, part, (arm1 - arm2) * r, n);
			one.v = one.v - one.inverseMass * r;
			one.w = one.w - (one.inverseInertia * arm1) * turn;
			two.v = two.v + two.inverseMass * r;
			two.w = two.w + (two.inverseInertia * arm2) * turn;
			if (rolls) {
				const Vector torque = load(rolling[pack - packs].torque, lane);
				one.w = one.w - one.inverseInertia * torque;
				two.w = two.w + two.inverseInertia * torque;
			}
			scatter(bodies, pack->body1 + lane, one);
			scatter(bodies, pack->body2 + lane, two);
		}
	}
	if (hasField)
		for (int i = 0; i < 9; ++i) field->moment[i] += sum(moment[i]);
}

void rebuildPacks(BodyState* bodies, const BallPack* packs, const RollingPack* rolling, std::size_t count, FieldPass* field)
{
	const auto rebuild =
			rolling ? (field ? rebuildOf<true, true> : rebuildOf<false, true>) : (field ? rebuildOf<true, false> : rebuildOf<false, false>);
	rebuild(bodies, packs, rolling, count, field);
}

/// NaturalMap.hpp with everything multiplied by W_nn: with Z = W_nn r - (u + mu |u_t| n), a velocity, W_nn F = W_nn r - P_K(Z), since K is a cone.
template <bool hasField, bool rolls> CertificateSums certifyOf(const BodyState* bodies, const BallPack* packs, const RollingPack* rolling,
															   std::size_t count, RoundOff roundOff, const double* gradient)
{
	const Wide zero = all(0), unit = all(1), perSpeed = all(roundOff.perSpeed), most = all(roundOff.most), most2 = most * most;
	Wide map2[parts]{}, impulse2[parts]{}, approach = zero, gradientSize = zero;
	if (hasField)
		for (int i = 0; i < 9; ++i) gradientSize += magnitude(all(gradient[i]));
	for (const BallPack* pack = packs; pack != packs + count; ++pack) {
		fetchAhead<false>(bodies, pack, packs + count);
		for (int part = 0, lane = 0; part < parts; ++part, lane += WIDE_LANES) {
			if (isEmpty(*pack, lane)) break;
			const Side one = gather(bodies, pack->body1 + lane), two = gather(bodies, pack->body2 + lane);
			const Vector n = load(pack->normal, lane);
			const Wide arm1 = load(pack->arm1 + lane), arm2 = load(pack->arm2 + lane), gapVelocity = load(pack->gapVelocity + lane),
					   mu = load(pack->friction + lane);
			Vector u = (two.v - one.v) + cross(arm2 * two.w - arm1 * one.w, n);
			if (hasField) u = u + (arm1 - arm2) * (gradient * n);
			const Wide along = dot(u, n), un = along + gapVelocity;
			const Vector ut = u - along * n;
			approach = largest(approach, -un);

			const Vector r = load(pack->impulse, lane);
			const Wide rn = dot(r, n), Wn = one.inverseMass + two.inverseMass;
			const Vector rt = r - rn * n;
			const Wide Wt = Wn + arm1 * arm1 * one.inverseInertia + arm2 * arm2 * two.inverseInertia;
			const Wide rise = un + mu * squareRoot(dot(ut, ut)), Wrn = Wn * rn, zn = Wrn - rise;
			const Vector Wrt = Wn * rt, zt = Wrt - ut;
			const Wide length = squareRoot(dot(zt, zt)), slope = mu * length, onRim = (zn + slope) / ((unit + mu * mu) * length);
			const Lanes inside = (zn >= zero) & (length <= mu * zn), polar = slope <= -zn;
			const auto pick = [&](Wide whereInside, Wide wherePolar, Wide elsewhere) {
				return inside ? whereInside : (polar ? wherePolar : elsewhere);
			};
			const Wide rim = mu * onRim;
			const Wide fn = pick(rise, Wrn, Wrn - onRim * length);
			const Vector ft{pick(ut.x, Wrt.x, Wrt.x - rim * zt.x), pick(ut.y, Wrt.y, Wrt.y - rim * zt.y), pick(ut.z, Wrt.z, Wrt.z - rim * zt.z)};
			const Wide fn2 = fn * fn, ft2 = dot(ft, ft), f2 = fn2 + ft2;

			const Lanes moves = Wn > zero;
			Lanes counts = moves & ~((un >= zero) & (rn <= zero));
			if (any(counts & (f2 <= most2))) {
				Wide speeds = sizeOf(one.v) + sizeOf(two.v) + magnitude(gapVelocity) +
							  (sizeOf(one.w) * magnitude(arm1) + sizeOf(two.w) * magnitude(arm2)) * sizeOf(n);
				if (hasField) speeds += gradientSize * magnitude(arm1 - arm2) * sizeOf(n);
				const Wide noise = perSpeed * speeds;
				counts &= ~(f2 <= (noise < most ? noise * noise : most2));
			}
			const Wide inverse = unit / Wn;
			// What is not finite must not be masked: zero times it is not a number.
			map2[part] += (counts ? (fn2 + Wt * inverse * ft2) * inverse : zero) + zero * (un + rn);
			impulse2[part] += moves ? Wn * rn * rn + Wt * dot(rt, rt) : zero;
			if (!rolls) continue;

			const RollingPack& roll = rolling[pack - packs];
			const Vector torque = load(roll.torque, lane), map = torque - improvedTorque(roll, lane, torque, two.w - one.w, n, rn);
			const Wide Ww = load(roll.mobility + lane), size2 = dot(map, map);
			const Wide noise = perSpeed * (sizeOf(one.w) + sizeOf(two.w) + sizeOf(load(roll.drive, lane))) * load(roll.inverseMobility + lane);
			map2[part] += (size2 > noise * noise ? Ww * size2 : zero) + zero * size2;
			impulse2[part] += Ww * dot(torque, torque);
		}
	}
	double top = 0;
	for (int lane = 0; lane < WIDE_LANES; ++lane) top = approach[lane] > top ? approach[lane] : top;
	return {sum(map2), sum(impulse2), top};
}

CertificateSums certifyPacks(const BodyState* bodies, const BallPack* packs, const RollingPack* rolling, std::size_t count, RoundOff roundOff,
							 const double* gradient)
{
	const auto certify =
			rolling ? (gradient ? certifyOf<true, true> : certifyOf<false, true>) : (gradient ? certifyOf<true, false> : certifyOf<false, false>);
	return certify(bodies, packs, rolling, count, roundOff, gradient);
}

} // namespace

} // namespace contactdynamics
