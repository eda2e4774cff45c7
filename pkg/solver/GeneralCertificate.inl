// SPDX-License-Identifier: GPL-2.0-or-later
// The certificate of general contacts; included as BallSweep.inl is.
#include "CertificateLanes.inl"
#include "GeneralLanes.inl"

namespace contactdynamics {

namespace {

struct Tangential {
	Wide large, small;
};
inline Tangential operator-(const Tangential& a, const Tangential& b) { return {a.large - b.large, a.small - b.small}; }
inline Tangential operator*(Wide s, const Tangential& a) { return {s * a.large, s * a.small}; }
inline Wide dot(const Tangential& a, const Tangential& b) { return a.large * b.large + a.small * b.small; }
inline Tangential chosen(Lanes mask, const Tangential& a, const Tangential& b) { return {mask ? a.large : b.large, mask ? a.small : b.small}; }

constexpr FetchDistance generalFetch{1, 2};

template <bool hasField, bool rolls> __attribute__((flatten)) void rebuildGeneralOf(BodyState* bodies, const BodyMobility* mobilities,
																					const GeneralPack* packs, const RollingPack* rolling,
																					std::size_t count, FieldPass* field)
{
	Wide moment[9][parts]{};
	for (const GeneralPack* pack = packs; pack != packs + count; ++pack) {
		fetchAhead<true>(bodies, pack, packs + count, generalFetch);
		if (packs + count - pack > generalFetch.bodies) prefetchMobilities(mobilities, pack[generalFetch.bodies]);
		for (int part = 0, lane = 0; part < parts; ++part, lane += WIDE_LANES) {
			if (isEmpty(*pack, lane)) break;
			GeneralSide one = gather(bodies, mobilities, pack->body1 + lane), two = gather(bodies, mobilities, pack->body2 + lane);
			const Vector arm1 = load(pack->arm1, lane), arm2 = load(pack->arm2, lane);
			const Vector r = frameOf(*pack, lane).inGlobal(loadLocal(pack->impulse, lane));
			if (hasField) addMoment(moment, part, r, arm1 - arm2);
			apply(r, arm1, arm2, one, two);
			if (rolls) {
				const Vector torque = load(rolling[pack - packs].torque, lane);
				one.w = one.w - one.turned(torque);
				two.w = two.w + two.turned(torque);
			}
			scatter(bodies, pack->body1 + lane, one);
			scatter(bodies, pack->body2 + lane, two);
		}
	}
	if (hasField)
		for (int i = 0; i < 9; ++i) field->moment[i] += sum(moment[i]);
}

void rebuildGeneralPacks(BodyState* bodies, const BodyMobility* mobilities, const GeneralPack* packs, const RollingPack* rolling, std::size_t count,
						 FieldPass* field)
{
	const auto rebuild = rolling ? (field ? rebuildGeneralOf<true, true> : rebuildGeneralOf<false, true>)
								 : (field ? rebuildGeneralOf<true, false> : rebuildGeneralOf<false, false>);
	rebuild(bodies, mobilities, packs, rolling, count, field);
}

template <bool hasField, bool rolls>
__attribute__((flatten)) CertificateSums certifyGeneralOf(const BodyState* bodies, const BodyMobility* mobilities, const GeneralPack* packs,
														  const RollingPack* rolling, std::size_t count, RoundOff roundOff, const double* gradient)
{
	const Wide zero = all(0), most2 = all(roundOff.most * roundOff.most);
	Wide map2[parts]{}, impulse2[parts]{}, approach = zero;
	const Wide gradientSize = hasField ? sizeOf(gradient) : zero;
	for (const GeneralPack* pack = packs; pack != packs + count; ++pack) {
		fetchAhead<false>(bodies, pack, packs + count, generalFetch);
		if (hasField && packs + count - pack > generalFetch.bodies) prefetchMobilities(mobilities, pack[generalFetch.bodies]);
		for (int part = 0, lane = 0; part < parts; ++part, lane += WIDE_LANES) {
			if (isEmpty(*pack, lane)) break;
			// Where there is a mean field, the W of the visits is another one, see GrainOperator::startField().
			const auto one = sideOf<hasField>(bodies, mobilities, pack->body1 + lane), two = sideOf<hasField>(bodies, mobilities, pack->body2 + lane);
			const Frame frame = frameOf(*pack, lane);
			const Vector arm1 = load(pack->arm1, lane), arm2 = load(pack->arm2, lane);
			const Wide cn = load(pack->normalCompliance + lane), ct = load(pack->tangentialCompliance + lane);
			const Local r = loadLocal(pack->impulse, lane), offset = loadLocal(pack->offset, lane);
			const Local u = frame * relativeVelocity(one, two, arm1, arm2, hasField ? gradient : nullptr) + offset +
							Local{cn * r.normal, ct * r.large, ct * r.small};
			approach = largest(approach, -u.normal);

			const auto energy = [&](const Local& a) {
				if constexpr (hasField)
					return energyOf(frame.inGlobal(a), arm1, arm2, one, two) + cn * a.normal * a.normal +
						   ct * (a.large * a.large + a.small * a.small);
				else
					return delassusOf(*pack, lane).energy(a);
			};
			const Wide Wn = hasField ? energy({all(1), zero, zero}) : load(pack->Wnn + lane);
			const ScaledMap<Tangential> f =
					scaledMap(Wn, load(pack->friction + lane), r.normal, Tangential{r.large, r.small}, u.normal, Tangential{u.large, u.small});
			const Wide f2 = f.n * f.n + dot(f.t, f.t);

			const Lanes moves = Wn > zero;
			Lanes counts = moves & ~((u.normal >= zero) & (r.normal <= zero));
			if (any(counts & (f2 <= most2))) {
				Wide speeds = sizeOf(one.v) + sizeOf(two.v) + sizeOf(one.w) * sizeOf(arm1) + sizeOf(two.w) * sizeOf(arm2) + magnitude(offset.normal) +
							  magnitude(offset.large) + magnitude(offset.small);
				if (hasField) speeds += gradientSize * sizeOf(arm1 - arm2);
				counts &= ~isRoundOff(f2, speeds, roundOff);
			}
			const Wide inverse = all(1) / Wn;
			// What is not finite must not be masked: zero times it is not a number.
			map2[part] += (counts ? energy({f.n, f.t.large, f.t.small}) * inverse * inverse : zero) +
						  zero * (u.normal + u.large + u.small + r.normal + r.large + r.small);
			impulse2[part] += moves ? energy(r) : zero;
			if (rolls) certifyTorque(rolling[pack - packs], lane, one.w, two.w, frame.n, r.normal, roundOff, map2[part], impulse2[part]);
		}
	}
	return {sum(map2), sum(impulse2), largestLane(approach)};
}

CertificateSums certifyGeneralPacks(const BodyState* bodies, const BodyMobility* mobilities, const GeneralPack* packs, const RollingPack* rolling,
									std::size_t count, RoundOff roundOff, const double* gradient)
{
	const auto certify = rolling ? (gradient ? certifyGeneralOf<true, true> : certifyGeneralOf<false, true>)
								 : (gradient ? certifyGeneralOf<true, false> : certifyGeneralOf<false, false>);
	return certify(bodies, mobilities, packs, rolling, count, roundOff, gradient);
}

} // namespace

} // namespace contactdynamics
