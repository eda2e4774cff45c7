// SPDX-License-Identifier: GPL-2.0-or-later
// A few contacts taken out of a collection, and put back with other impulses.
#include "GrainOperator.hpp"

#include "BodyView.hpp"
#include "CoulombCone.hpp"

#include <Eigen/Geometry>

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
	if (hasField() || !rollingContacts.empty()) return false;
	spot.awake = awake;
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
		if (size2 > 0) spot.changes.push_back({size2, originOf(pack, lane)});
	};
	eachContact(packs, collect);
	eachContact(generals, collect);
	const auto end = spot.changes.begin() + std::ptrdiff_t(std::min(spot.changes.size(), most));
	const auto isLarger = [](const HotSpot::Change& a, const HotSpot::Change& b) {
		if (a.size2 != b.size2) return a.size2 > b.size2;
		return a.of.ball != b.of.ball ? a.of.ball : a.of.place < b.of.place;
	};
	std::nth_element(spot.changes.begin(), end, spot.changes.end(), isLarger);
	std::sort(spot.changes.begin(), end, isLarger);
	spot.changes.erase(end, spot.changes.end());
	return total;
}

/// Numbers the bodies with large changes, the candidates, and those that they touch, and notes the contacts.
void GrainOperator::contactsNear(HotSpot& spot) const
{
	spot.bodies = 0;
	spot.numberOf.assign(state.size(), -1);
	const auto number = [&](std::int32_t index) {
		if (index < 0) return -1;
		if (spot.numberOf[index] < 0) spot.numberOf[index] = std::int32_t(spot.bodies++);
		return spot.numberOf[index];
	};
	for (const HotSpot::Change& change : spot.changes)
		atOrigin(change.of, [&](const auto& pack, int lane) {
			number(pack.body1[lane]);
			number(pack.body2[lane]);
		});
	spot.candidates = spot.bodies;
	if (spot.candidates > spot.around.size()) spot.around.resize(spot.candidates);
	for (std::size_t i = 0; i < spot.candidates; ++i) spot.around[i].clear();
	spot.near.clear();
	const auto isCandidate = [&](std::int32_t index) {
		return index >= 0 && spot.numberOf[index] >= 0 && std::size_t(spot.numberOf[index]) < spot.candidates;
	};
	const auto note = [&](const auto& pack, int lane) {
		const std::int32_t one = pack.body1[lane], two = pack.body2[lane];
		if (!isCandidate(one) && !isCandidate(two)) return;
		const bool isLoaded = pack.impulse[0][lane] != 0 || pack.impulse[1][lane] != 0 || pack.impulse[2][lane] != 0;
		for (const std::int32_t index : {one, two})
			if (isCandidate(index)) spot.around[spot.numberOf[index]].push_back(std::int32_t(spot.near.size()));
		spot.near.push_back({originOf(pack, lane), number(one), number(two), isLoaded, false});
	};
	eachContact(packs, note);
	eachContact(generals, note);
	spot.isIn.assign(spot.candidates, 0);
	spot.groups.reset(spot.bodies);
}

/// Takes in the bodies with the largest changes, one by one, each with all its contacts, as far as there is room. Contacts that share a body that can
/// move are of one part.
/// @return how much of the changes lies at contacts of bodies taken in [J]
double GrainOperator::growHotSpot(HotSpot& spot, std::size_t most, double enough) const
{
	double covered = 0;
	std::size_t all = 0;
	const auto takeIn = [&](std::int32_t index) {
		if (index < 0) return false;
		const std::int32_t body = spot.numberOf[index];
		if (spot.isIn[body]) return true;
		std::size_t fresh = 0, size = 0;
		spot.linked.clear();
		for (const std::int32_t i : spot.around[body]) {
			const HotSpot::Near& contact = spot.near[i];
			if (contact.loaded && !contact.chosen) ++fresh;
			for (const std::int32_t side : {contact.body1, contact.body2}) {
				if (side < 0) continue;
				HotSpot::Group& group = spot.groups.of(side);
				if (std::find(spot.linked.begin(), spot.linked.end(), &group) != spot.linked.end()) continue;
				spot.linked.push_back(&group);
				size += group.loaded;
			}
		}
		if (size + fresh > spot.room || all + fresh > most) return false;
		spot.isIn[body] = 1;
		all += fresh;
		spot.groups.of(body).loaded += fresh;
		for (const std::int32_t i : spot.around[body]) {
			HotSpot::Near& contact = spot.near[i];
			contact.chosen = true;
			if (contact.body1 >= 0 && contact.body2 >= 0) spot.groups.join(contact.body1, contact.body2);
		}
		return true;
	};
	for (const HotSpot::Change& change : spot.changes) {
		if (covered >= enough) break;
		const auto takeBoth = [&](const auto& pack, int lane) {
			const bool first = takeIn(pack.body1[lane]), second = takeIn(pack.body2[lane]);
			return first || second;
		};
		if (atOrigin(change.of, takeBoth)) covered += change.size2;
	}
	return covered;
}

void GrainOperator::divideHotSpot(HotSpot& spot)
{
	spot.parts = 0;
	for (const HotSpot::Near& contact : spot.near) {
		if (!contact.chosen) continue;
		std::int32_t& part = spot.groups.of(contact.body1 >= 0 ? contact.body1 : contact.body2).part;
		if (part < 0) {
			part = std::int32_t(spot.parts++);
			if (spot.parts > spot.contacts.size()) spot.contacts.emplace_back();
			spot.contacts[part].clear();
		}
		spot.contacts[part].push_back(contact.of);
	}
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
	for (const HotSpot::Origin& of : spot.contacts[part])
		atOrigin(of, [&](const auto& pack, int lane) {
			impulse2 += inWNorm2(pack, pack.impulse, lane);
			Contact c = problem->contacts[pack.id[lane]];
			c.body1 = bodyAt(c.body1);
			c.body2 = bodyAt(c.body2);
			c.impulse = insideCone(inGlobalAxes(pack, pack.impulse, lane), c.normal, c.friction);
			Body &body1 = taken.bodies[c.body1], &body2 = taken.bodies[c.body2];
			if (pack.body1[lane] >= 0) push(body1.velocity, body1.angularVelocity, body1, c.arm1, c.impulse);
			if (pack.body2[lane] >= 0) push(body2.velocity, body2.angularVelocity, body2, c.arm2, -c.impulse);
			taken.contacts.push_back(c);
		});
	for (const std::int32_t seat : spot.seats) spot.bodyOf[seat] = -1;
	return impulse2;
}

void GrainOperator::putPart(const HotSpot& spot, std::size_t part, const GrainProblem& solved)
{
	auto contact = solved.contacts.begin();
	for (const HotSpot::Origin& of : spot.contacts[part])
		atOrigin(of, [&](auto& pack, int lane) {
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

HotSpot::Origin GrainOperator::originOf(const BallPack& pack, int lane) const
{
	return {std::int32_t(&pack - packs.data()) * packLanes + lane, true};
}
HotSpot::Origin GrainOperator::originOf(const GeneralPack& pack, int lane) const
{
	return {std::int32_t(&pack - generals.data()) * packLanes + lane, false};
}

} // namespace contactdynamics
