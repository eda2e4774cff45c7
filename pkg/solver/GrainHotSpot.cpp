// SPDX-License-Identifier: GPL-2.0-or-later
// A few contacts taken out of a collection, and put back with other impulses.
#include "GrainOperator.hpp"

#include "BodyView.hpp"
#include "Buckets.hpp"
#include "CoulombCone.hpp"

#include <algorithm>

namespace contactdynamics {

namespace {

/// r^T W r of what stands in one lane.
double inWNorm2(const BallPack& p, const double (&r)[3][packLanes], int k)
{
	if (!(p.inverseWn[k] > 0)) return 0;
	const double n = r[0][k] * p.normal[0][k] + r[1][k] * p.normal[1][k] + r[2][k] * p.normal[2][k];
	const double all2 = r[0][k] * r[0][k] + r[1][k] * r[1][k] + r[2][k] * r[2][k];
	return n * n / p.inverseWn[k] + std::max(0.0, all2 - n * n) / p.inverseWt[k];
}

double inWNorm2(const GeneralPack& p, const double (&r)[3][packLanes], int k)
{
	if (!(p.Wnn[k] > 0)) return 0;
	const double u = p.Wnn[k] * r[0][k] + p.wLarge[k] * r[1][k] + p.wSmall[k] * r[2][k];
	return u * u / p.Wnn[k] + p.largeEigen[k] * r[1][k] * r[1][k] + p.smallEigen[k] * r[2][k] * r[2][k];
}

Vector3 inAxes(const BallPack&, int, const Vector3& r) { return r; }
Vector3 inAxes(const GeneralPack& p, int k, const Vector3& r)
{
	const Vector3 n(p.normal[0][k], p.normal[1][k], p.normal[2][k]), t(p.tangent[0][k], p.tangent[1][k], p.tangent[2][k]);
	return {r.dot(n), r.dot(t), r.dot(n.cross(t))};
}

} // namespace

bool GrainOperator::chooseHotSpot(HotSpot& spot) const
{
	spot.parts = 0;
	spot.awake = awake;
	if (hasField() || !rollingContacts.empty()) return false;
	const std::size_t most = spot.room * std::max<std::size_t>(1, awake / HotSpot::contactsPerSpot);
	const double total = largestChanges(spot, most);
	contactsNear(spot);
	const double covered = growHotSpot(spot, most, HotSpot::enough * total);
	if (!(covered > HotSpot::leastShare * total)) return false;
	divideHotSpot(spot);
	return true;
}

/// @return sum over all awake contacts [J]
double GrainOperator::largestChanges(HotSpot& spot, std::size_t most) const
{
	double total = 0;
	spot.changes.clear();
	const auto collect = [&](const auto& pack, int lane) {
		const double size2 = inWNorm2(pack, pack.increment, lane);
		total += size2;
		if (size2 > 0) spot.changes.push_back({size2, placeOf(pack, lane)});
	};
	eachContact(packs, collect);
	eachContact(generals, collect);
	const auto end = spot.changes.begin() + std::ptrdiff_t(std::min(spot.changes.size(), most));
	const auto isLarger = [](const HotSpot::Change& a, const HotSpot::Change& b) {
		if (a.size2 != b.size2) return a.size2 > b.size2;
		return a.of.ball != b.of.ball ? a.of.ball : a.of.number < b.of.number;
	};
	std::nth_element(spot.changes.begin(), end, spot.changes.end(), isLarger);
	std::sort(spot.changes.begin(), end, isLarger);
	spot.changes.erase(end, spot.changes.end());
	return total;
}

/// Numbers the bodies with large changes, the candidates, and those that they touch, and notes the contacts.
void GrainOperator::contactsNear(HotSpot& spot) const
{
	std::int32_t bodies = 0;
	spot.numberOf.assign(state.size(), -1);
	const auto number = [&](std::int32_t index) {
		if (index < 0) return -1;
		if (spot.numberOf[index] < 0) spot.numberOf[index] = bodies++;
		return spot.numberOf[index];
	};
	for (const HotSpot::Change& change : spot.changes)
		at(*this, change.of, [&](const auto& pack, int lane) {
			number(pack.body1[lane]);
			number(pack.body2[lane]);
		});
	const std::int32_t candidates = bodies;
	spot.candidates.assign(candidates, HotSpot::Candidate::untried);
	spot.near.clear();
	const auto isCandidate = [&](std::int32_t index) { return index >= 0 && spot.numberOf[index] >= 0 && spot.numberOf[index] < candidates; };
	const auto note = [&](const auto& pack, int lane) {
		const std::int32_t one = pack.body1[lane], two = pack.body2[lane];
		if (!isCandidate(one) && !isCandidate(two)) return;
		spot.near.push_back({placeOf(pack, lane), number(one), number(two), isNonzero(pack.impulse, lane), false});
	};
	eachContact(packs, note);
	eachContact(generals, note);
	spot.groups.reset(bodies);

	const auto eachOfCandidates = [&](const auto& put) {
		for (std::size_t i = 0; i < spot.near.size(); ++i)
			for (const std::int32_t body : {spot.near[i].body1, spot.near[i].body2})
				if (body >= 0 && body < candidates) put(std::size_t(body), std::int32_t(i));
	};
	intoBuckets(std::size_t(candidates), eachOfCandidates, spot.firstNear, spot.nearOf);
}

/// Takes in the bodies with the largest changes, one by one, each with all its contacts, as far as there is room. Contacts that share a body that can
/// move are of one part.
/// @return how much of the changes that were looked at lies at contacts of bodies taken in [J]
double GrainOperator::growHotSpot(HotSpot& spot, std::size_t most, double enough) const
{
	double covered = 0;
	std::size_t all = 0;
	const auto takeIn = [&](std::int32_t index) {
		if (index < 0) return false;
		const std::int32_t body = spot.numberOf[index];
		HotSpot::Candidate& candidate = spot.candidates[body];
		if (candidate != HotSpot::Candidate::untried) return candidate == HotSpot::Candidate::in;
		candidate = HotSpot::Candidate::refused; // for good: neither sum below falls when others are taken in
		const auto first = spot.nearOf.begin() + std::ptrdiff_t(spot.firstNear[body]),
				   last = spot.nearOf.begin() + std::ptrdiff_t(spot.firstNear[body + 1]);
		std::size_t fresh = 0, linked = 0;
		for (auto i = first; i != last; ++i) {
			const HotSpot::Near& contact = spot.near[*i];
			if (contact.loaded && !contact.chosen) ++fresh;
			for (const std::int32_t side : {contact.body1, contact.body2}) {
				if (side < 0) continue;
				HotSpot::Group& group = spot.groups.of(side);
				if (group.seenBy != body) linked += group.loaded;
				group.seenBy = body;
			}
			if (linked + fresh > spot.room || all + fresh > most) return false;
		}
		candidate = HotSpot::Candidate::in;
		all += fresh;
		spot.groups.of(body).loaded += fresh;
		for (auto i = first; i != last; ++i) {
			HotSpot::Near& contact = spot.near[*i];
			contact.chosen = true;
			if (contact.body1 >= 0 && contact.body2 >= 0) spot.groups.join(contact.body1, contact.body2);
		}
		return true;
	};
	for (const HotSpot::Change& change : spot.changes) {
		if (covered >= enough) break;
		const auto takeBoth = [&](const auto& pack, int lane) {
			const bool one = takeIn(pack.body1[lane]), two = takeIn(pack.body2[lane]);
			return one || two;
		};
		if (at(*this, change.of, takeBoth)) covered += change.size2;
	}
	return covered;
}

void GrainOperator::divideHotSpot(HotSpot& spot)
{
	const auto partOf = [&](const HotSpot::Near& contact) -> std::int32_t& {
		return spot.groups.of(contact.body1 >= 0 ? contact.body1 : contact.body2).part;
	};
	for (const HotSpot::Near& contact : spot.near)
		if (contact.chosen && partOf(contact) < 0) partOf(contact) = std::int32_t(spot.parts++);
	const auto eachOfParts = [&](const auto& put) {
		for (const HotSpot::Near& contact : spot.near)
			if (contact.chosen) put(std::size_t(partOf(contact)), contact.of);
	};
	intoBuckets(spot.parts, eachOfParts, spot.firstOfPart, spot.contacts);
}

double GrainOperator::takePart(HotSpot& spot, std::size_t part, GrainProblem& taken) const
{
	taken.bodies.clear();
	taken.contacts.clear();
	spot.seats.clear();
	spot.bodyOf.resize(state.size(), -1);
	const auto bodyAt = [&](std::int32_t id) {
		std::int32_t& its = spot.bodyOf[tree.seat[id]];
		if (its < 0) {
			its = std::int32_t(taken.bodies.size());
			spot.seats.push_back(tree.seat[id]);
			taken.bodies.push_back(problem->bodies[id]);
			taken.bodies.back().velocity = velocity(stateOf(id));
			taken.bodies.back().angularVelocity = angularVelocity(stateOf(id));
		}
		return its;
	};
	double impulse2 = 0;
	for (std::size_t i = spot.firstOfPart[part]; i < spot.firstOfPart[part + 1]; ++i)
		at(*this, spot.contacts[i], [&](const auto& pack, int lane) {
			impulse2 += inWNorm2(pack, pack.impulse, lane);
			Contact c = problem->contacts[pack.id[lane]];
			c.body1 = bodyAt(c.body1);
			c.body2 = bodyAt(c.body2);
			c.impulse = insideCone(inGlobalAxes(pack, pack.impulse, lane), c.normal, c.friction);
			Body &body1 = taken.bodies[c.body1], &body2 = taken.bodies[c.body2];
			if (pack.body1[lane] >= 0) applyImpulse(body1.velocity, body1.angularVelocity, body1, c.arm1, c.impulse);
			if (pack.body2[lane] >= 0) applyImpulse(body2.velocity, body2.angularVelocity, body2, c.arm2, -c.impulse);
			taken.contacts.push_back(c);
		});
	for (const std::int32_t seat : spot.seats) spot.bodyOf[seat] = -1;
	return impulse2;
}

void GrainOperator::putPart(const HotSpot& spot, std::size_t part, const GrainProblem& solved)
{
	auto contact = solved.contacts.begin();
	for (std::size_t i = spot.firstOfPart[part]; i < spot.firstOfPart[part + 1]; ++i)
		at(*this, spot.contacts[i], [&](auto& pack, int lane) {
			const Vector3& impulse = (contact++)->impulse;
			const Vector3 before = inGlobalAxes(pack, pack.impulse, lane), change = impulse - before;
			const Vector3 in = inAxes(pack, lane, impulse), changeIn = inAxes(pack, lane, change);
			for (int k = 0; k < 3; ++k) {
				pack.impulse[k][lane] = in[k];
				pack.increment[k][lane] += changeIn[k];
			}
			addImpulse(problem->contacts[pack.id[lane]], change);
		});
}

HotSpot::PackLane GrainOperator::placeOf(const BallPack& pack, int lane) const
{
	return {std::int32_t(&pack - packs.data()) * packLanes + lane, true};
}
HotSpot::PackLane GrainOperator::placeOf(const GeneralPack& pack, int lane) const
{
	return {std::int32_t(&pack - generals.data()) * packLanes + lane, false};
}

} // namespace contactdynamics
