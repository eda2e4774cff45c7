// SPDX-License-Identifier: GPL-2.0-or-later
// The sweep over general contacts; included as BallSweep.inl is.
#include "ContactKernels.hpp"
#include "GeneralLanes.inl"
#include "PrincipalContact.hpp"

namespace contactdynamics {

namespace {

/// The search of PrincipalContact.cpp from the guesses of the visit before, all lanes at a time.
/// @param sliding  lanes to search in; cleared where the search did not end within four steps
/// @param rate     in: guesses; out: rates, where the search ended
inline void searchRates(const LocalW& W, const Local& push, Wide ratio, Lanes& sliding, Wide& rate)
{
	const Wide zero = all(0);
	Lanes searching = sliding & (rate > zero), found = searching & (rate < zero);
	Wide k = rate;
	for (int i = 0; i < 4 && any(searching); ++i) {
		const Wide overLarge = W.smallEigen + k, overSmall = W.largeEigen + k, inverse = all(1) / (overSmall * overLarge);
		const Wide iL = inverse * overLarge, iS = inverse * overSmall, rL = push.large * iL, rS = push.small * iS;
		const Wide length2 = rL * rL + rS * rS, length = squareRoot(length2);
		const Wide limit = -ratio * (push.normal + W.large * rL + W.small * rS), excess = length - limit;
		const Wide dLength2 = rL * rL * iL + rS * rS * iS, dLimit = ratio * (W.large * rL * iL + W.small * rS * iS);
		const Wide step = excess * limit * length2 / (dLength2 * limit * limit + dLimit * length2 * length), next = k + step;
		searching &= (limit > zero) & (length > zero) & (next > zero);
		found |= searching & (magnitude(step) <= all(1e-4) * k) & (magnitude(excess) <= all(1e-3) * length);
		k = searching ? next : k;
		searching &= ~found;
	}
	sliding = found;
	rate = found ? k : rate;
}

/// One contact for which no lanes suffice: the first time it slides, when its rate changes much, or when it slips where it cannot move.
inline void solveAlone(GeneralPack& pack, int lane, double normal, double large, double small, double* r)
{
	const auto inverse = [](double x) { return x > 0 ? 1 / x : 0; };
	const double Wnn = pack.Wnn[lane], largeEigen = pack.largeEigen[lane], smallEigen = pack.smallEigen[lane];
	const PrincipalContact W{Wnn,		   pack.wLarge[lane],	pack.wSmall[lane],	largeEigen, smallEigen, pack.roundOff[lane],
							 inverse(Wnn), inverse(largeEigen), inverse(smallEigen)};
	solve(W, {normal, large, small}, pack.friction[lane], pack.slidingRate[lane], r);
}

/// The impulses of PrincipalContact.cpp.
/// @param push  b_n, and w b_n / W_nn - b_t
inline Local solvedBy(GeneralPack& pack, int lane, const LocalW& W, const Local& push)
{
	const Wide zero = all(0), mu = load(pack.friction + lane), inverseNn = W.inverseNn(), alone = push.normal * inverseNn;
	const Lanes pushes = (push.normal < zero) & (W.nn > zero), movesLarge = W.largeEigen > zero, movesSmall = W.smallEigen > zero;
	const Wide large = movesLarge ? push.large / W.largeEigen : zero, small = movesSmall ? push.small / W.smallEigen : zero;
	const Wide rn = -(alone + (W.large * large + W.small * small) * inverseNn), length2 = large * large + small * small, bound = mu * rn;
	// A direction that cannot move sticks only if it does not slip already.
	const Lanes canStick = (movesLarge | (push.large == zero)) & (movesSmall | (push.small == zero));
	const Lanes isSmooth = mu == zero, sticks = canStick & (rn >= zero) & (length2 <= bound * bound) & ~isSmooth;
	Local r{pushes ? (sticks ? rn : -alone) : zero, pushes & sticks ? large : zero, pushes & sticks ? small : zero};
	const Lanes slides = pushes & ~sticks & ~isSmooth;
	if (!any(slides)) return r;

	Lanes found = slides & canStick;
	Wide rate = load(pack.slidingRate + lane);
	searchRates(W, push, mu * inverseNn, found, rate);
	store(pack.slidingRate + lane, rate);
	const Wide slidLarge = push.large / (W.largeEigen + rate), slidSmall = push.small / (W.smallEigen + rate);
	r.normal = found ? squareRoot(slidLarge * slidLarge + slidSmall * slidSmall) / mu : r.normal;
	r.large = found ? slidLarge : r.large;
	r.small = found ? slidSmall : r.small;
	const Lanes rest = slides & ~found;
	if (!any(rest)) return r;
	for (int i = 0; i < WIDE_LANES; ++i) {
		if (!rest[i]) continue;
		double one[3];
		if (canStick[i]) pack.slidingRate[lane + i] = 0; // the search from there has been in vain
		solveAlone(pack, lane + i, push.normal[i], push.large[i], push.small[i], one);
		r.normal[i] = one[0];
		r.large[i] = one[1];
		r.small[i] = one[2];
	}
	return r;
}

template <bool hasField, bool rolls> __attribute__((flatten)) SweepNorms sweepGeneralOf(BodyState* bodies, const BodyMobility* mobilities,
																						GeneralPack* packs, RollingPack* rolling, std::size_t count,
																						Extrapolation by, FieldPass* field)
{
	const Wide relax = all(by.relax), momentum = all(by.momentum);
	Wide increment2[parts]{}, impulse2[parts]{}, moment[9][parts]{};
	constexpr std::ptrdiff_t farAhead = 2, ahead = 1; // packs
	const GeneralPack* const end = packs + count;
	for (GeneralPack* pack = packs; pack != end; ++pack) {
		if (end - pack > ahead) {
			prefetchBodies<true>(bodies, pack[ahead]);
			prefetchMobilities(mobilities, pack[ahead]);
		}
		if (end - pack > farAhead)
			for (std::size_t i = 0; i < sizeof(GeneralPack); i += 64) __builtin_prefetch(reinterpret_cast<const char*>(pack + farAhead) + i, 1);
		for (int part = 0, lane = 0; part < parts; ++part, lane += WIDE_LANES) {
			if (isEmpty(*pack, lane)) break;
			GeneralSide one = gather(bodies, mobilities, pack->body1 + lane), two = gather(bodies, mobilities, pack->body2 + lane);
			const Frame frame = frameOf(*pack, lane);
			const Vector arm1 = load(pack->arm1, lane), arm2 = load(pack->arm2, lane);
			const LocalW W = delassusOf(*pack, lane);

			const Local last = loadLocal(pack->increment, lane), step = relax * last + momentum * loadLocal(pack->direction, lane);
			const Local x = loadLocal(pack->impulse, lane) + step;
			store(pack->direction, lane, last + step);

			// What the velocities, and the compliance, give with this contact; its own part W x leaves b. Of the tangents only b_t - w b_n / W_nn is
			// wanted, in which w drops out.
			const Wide cn = load(pack->normalCompliance + lane), ct = load(pack->tangentialCompliance + lane);
			const Local u = frame * relativeVelocity(one, two, arm1, arm2, hasField ? field->gradient : nullptr) + loadLocal(pack->offset, lane) +
							Local{cn * x.normal, ct * x.large, ct * x.small};
			const Wide perNormal = u.normal * W.inverseNn();
			const Local push{u.normal - (W.nn * x.normal + W.large * x.large + W.small * x.small),
							 W.largeEigen * x.large - (u.large - W.large * perNormal), W.smallEigen * x.small - (u.small - W.small * perNormal)};
			const Local r = solvedBy(*pack, lane, W, push), dr = r - x;
			store(pack->impulse, lane, r);
			store(pack->increment, lane, dr);
			increment2[part] += W.energy(dr);
			impulse2[part] += W.energy(r);

			const Vector given = frame.inGlobal(dr);
			if (hasField) addMoment(moment, part, given, arm1 - arm2);
			apply(given, arm1, arm2, one, two);
			if (rolls) {
				const Vector dm =
						visitTorque(rolling[pack - packs], lane, relax, momentum, two.w - one.w, frame.n, r.normal, increment2[part], impulse2[part]);
				one.w = one.w - one.turned(dm);
				two.w = two.w + two.turned(dm);
			}
			scatter(bodies, pack->body1 + lane, one);
			scatter(bodies, pack->body2 + lane, two);
		}
	}
	if (hasField)
		for (int i = 0; i < 9; ++i) field->moment[i] += sum(moment[i]);
	return {sum(increment2), sum(impulse2)};
}

SweepNorms sweepGeneralPacks(BodyState* bodies, const BodyMobility* mobilities, GeneralPack* packs, RollingPack* rolling, std::size_t count,
							 Extrapolation by, FieldPass* field)
{
	const auto sweep = rolling ? (field ? sweepGeneralOf<true, true> : sweepGeneralOf<false, true>)
							   : (field ? sweepGeneralOf<true, false> : sweepGeneralOf<false, false>);
	return sweep(bodies, mobilities, packs, rolling, count, by, field);
}

} // namespace

} // namespace contactdynamics
