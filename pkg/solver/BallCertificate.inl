// SPDX-License-Identifier: GPL-2.0-or-later
// The certificate of ball contacts; included as BallSweep.inl is.
#include "CertificateLanes.inl"

namespace contactdynamics {

namespace {

constexpr FetchDistance ballFetch{3, 6};

template <bool hasField, bool rolls>
__attribute__((flatten)) void rebuildOf(BodyState* bodies, const BallPack* packs, const RollingPack* rolling, std::size_t count, FieldPass* field)
{
	Wide moment[9][parts]{};
	for (const BallPack* pack = packs; pack != packs + count; ++pack) {
		fetchAhead<true>(bodies, pack, packs + count, ballFetch);
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

template <bool hasField, bool rolls> __attribute__((flatten)) CertificateSums
certifyOf(const BodyState* bodies, const BallPack* packs, const RollingPack* rolling, std::size_t count, RoundOff roundOff, const double* gradient)
{
	const Wide zero = all(0), unit = all(1), most2 = all(roundOff.most * roundOff.most);
	Wide map2[parts]{}, impulse2[parts]{}, approach = zero;
	const Wide gradientSize = hasField ? sizeOf(gradient) : zero;
	for (const BallPack* pack = packs; pack != packs + count; ++pack) {
		fetchAhead<false>(bodies, pack, packs + count, ballFetch);
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
			const ScaledMap<Vector> f = scaledMap(Wn, mu, rn, rt, un, ut);
			const Wide fn2 = f.n * f.n, ft2 = dot(f.t, f.t), f2 = fn2 + ft2;

			const Lanes moves = Wn > zero;
			Lanes counts = moves & ~((un >= zero) & (rn <= zero));
			if (any(counts & (f2 <= most2))) {
				Wide speeds = sizeOf(one.v) + sizeOf(two.v) + magnitude(gapVelocity) +
							  (sizeOf(one.w) * magnitude(arm1) + sizeOf(two.w) * magnitude(arm2)) * sizeOf(n);
				if (hasField) speeds += gradientSize * magnitude(arm1 - arm2) * sizeOf(n);
				counts &= ~isRoundOff(f2, speeds, roundOff);
			}
			const Wide inverse = unit / Wn;
			// What is not finite must not be masked: zero times it is not a number.
			map2[part] += (counts ? (fn2 + Wt * inverse * ft2) * inverse : zero) + zero * (un + rn);
			impulse2[part] += moves ? Wn * rn * rn + Wt * dot(rt, rt) : zero;
			if (rolls) certifyTorque(rolling[pack - packs], lane, one.w, two.w, n, rn, roundOff, map2[part], impulse2[part]);
		}
	}
	return {sum(map2), sum(impulse2), largestLane(approach)};
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
