// SPDX-License-Identifier: GPL-2.0-or-later
// A few contacts taken out of a collection, and put back with other impulses.
#include "GrainOperator.hpp"

#include "BodyView.hpp"
#include "CoulombCone.hpp"

#include <Eigen/Geometry>
#include <limits>

namespace contactdynamics {

namespace {

constexpr std::int32_t none = std::numeric_limits<std::int32_t>::max();

std::int32_t seatOf(std::int32_t index) { return index < 0 ? ~index : index; }

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

void push(Body& body, const Vector3& arm, const Vector3& impulse)
{
	body.velocity += body.inverseMass.cwiseProduct(impulse);
	body.angularVelocity += body.inverseInertia * arm.cross(impulse);
}

} // namespace

bool GrainOperator::takeHotSpot(HotSpot& spot) const
{
	if (hasField() || !rollingContacts.empty()) return false;
	const std::size_t room = spot.room * std::max<std::size_t>(1, awake / HotSpot::contactsPerSpot);
	const double total = rankChanges(spot, room);
	const std::int32_t ranks = ranksWithin(spot, room, total);
	if (ranks == 0) return false;
	fillHotSpot(spot, ranks);
	return true;
}

/// Ranks of the largest changes, as many as there is room for at most; a body has that of the first of its contacts.
/// @return sum over all awake contacts [J]
double GrainOperator::rankChanges(HotSpot& spot, std::size_t room) const
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
	const auto end = spot.changes.begin() + std::ptrdiff_t(std::min(spot.changes.size(), room));
	const auto isLarger = [](const HotSpot::Change& a, const HotSpot::Change& b) {
		if (a.size2 != b.size2) return a.size2 > b.size2;
		return a.of.ball != b.of.ball ? a.of.ball : a.of.place < b.of.place;
	};
	std::nth_element(spot.changes.begin(), end, spot.changes.end(), isLarger);
	std::sort(spot.changes.begin(), end, isLarger);
	spot.changes.erase(end, spot.changes.end());

	spot.rank.assign(state.size(), none);
	const auto rankBody = [&](std::int32_t index, std::int32_t rank) {
		if (index >= 0 && spot.rank[index] == none) spot.rank[index] = rank;
	};
	for (std::size_t rank = 0; rank < spot.changes.size(); ++rank) {
		const auto [place, ball] = spot.changes[rank].of;
		const std::int32_t at = place / packLanes, lane = place % packLanes;
		rankBody(ball ? packs[at].body1[lane] : generals[at].body1[lane], std::int32_t(rank));
		rankBody(ball ? packs[at].body2[lane] : generals[at].body2[lane], std::int32_t(rank));
	}
	return total;
}

/// The lower rank of its two bodies.
template <class Pack> std::int32_t GrainOperator::rankOf(const HotSpot& spot, const Pack& pack, int lane)
{
	return std::min(spot.rank[seatOf(pack.body1[lane])], spot.rank[seatOf(pack.body2[lane])]);
}

/// How many ranks, with all contacts of their bodies, there is room for; 0 where they have too little of the changes.
std::int32_t GrainOperator::ranksWithin(HotSpot& spot, std::size_t room, double total) const
{
	spot.loaded.assign(spot.changes.size(), 0);
	const auto count = [&](const auto& pack, int lane) {
		const std::int32_t rank = rankOf(spot, pack, lane);
		const bool isLoaded = pack.impulse[0][lane] != 0 || pack.impulse[1][lane] != 0 || pack.impulse[2][lane] != 0;
		if (rank != none && isLoaded) ++spot.loaded[rank];
	};
	eachContact(packs, count);
	eachContact(generals, count);
	double covered = 0;
	std::size_t ranks = 0;
	for (std::size_t contacts = 0; ranks < spot.changes.size() && covered < HotSpot::enough * total; ++ranks) {
		contacts += spot.loaded[ranks];
		if (contacts > room) break;
		covered += spot.changes[ranks].size2;
	}
	return covered > HotSpot::leastShare * total ? std::int32_t(ranks) : 0;
}

void GrainOperator::fillHotSpot(HotSpot& spot, std::int32_t ranks) const
{
	auto& [bodies, contacts, rolling, field] = spot.problem;
	bodies.clear();
	contacts.clear();
	spot.origins.clear();
	spot.impulse2.clear();
	spot.awake = awake;
	spot.seats.clear();
	spot.bodyOf.resize(state.size(), -1);
	const auto bodyAt = [&](std::int32_t id) {
		std::int32_t& its = spot.bodyOf[tree.seat[id]];
		if (its < 0) {
			its = std::int32_t(bodies.size());
			spot.seats.push_back(tree.seat[id]);
			bodies.push_back(problem->bodies[id]);
			bodies.back().velocity = velocity(stateOf(id));
			bodies.back().angularVelocity = angularVelocity(stateOf(id));
		}
		return its;
	};
	const auto take = [&](const auto& pack, int lane) {
		if (rankOf(spot, pack, lane) >= ranks) return;
		spot.impulse2.push_back(inWNorm2(pack, pack.impulse, lane));
		spot.origins.push_back(originOf(pack, lane));
		Contact c = problem->contacts[pack.id[lane]];
		c.body1 = bodyAt(c.body1);
		c.body2 = bodyAt(c.body2);
		c.impulse = insideCone(inGlobalAxes(pack, pack.impulse, lane), c.normal, c.friction);
		if (pack.body1[lane] >= 0) push(bodies[c.body1], c.arm1, c.impulse);
		if (pack.body2[lane] >= 0) push(bodies[c.body2], c.arm2, -c.impulse);
		contacts.push_back(c);
	};
	eachContact(packs, take);
	eachContact(generals, take);
	for (const std::int32_t seat : spot.seats) spot.bodyOf[seat] = -1;
}

HotSpot::Origin GrainOperator::originOf(const BallPack& pack, int lane) const
{
	return {std::int32_t(&pack - packs.data()) * packLanes + lane, true};
}
HotSpot::Origin GrainOperator::originOf(const GeneralPack& pack, int lane) const
{
	return {std::int32_t(&pack - generals.data()) * packLanes + lane, false};
}

void GrainOperator::putHotSpot(const HotSpot& spot)
{
	const auto put = [this](auto& pack, int lane, const Vector3& impulse) {
		const Vector3 before = inGlobalAxes(pack, pack.impulse, lane), change = impulse - before;
		const Vector3 in = inAxes(pack, lane, impulse), changeIn = inAxes(pack, lane, change);
		for (int k = 0; k < 3; ++k) {
			pack.impulse[k][lane] = in[k];
			pack.increment[k][lane] += changeIn[k];
		}
		addImpulse(problem->contacts[pack.id[lane]], change);
	};
	for (std::size_t i = 0; i < spot.origins.size(); ++i) {
		const auto [place, ball] = spot.origins[i];
		const std::int32_t at = place / packLanes, lane = place % packLanes;
		if (ball)
			put(packs[at], lane, spot.problem.contacts[i].impulse);
		else
			put(generals[at], lane, spot.problem.contacts[i].impulse);
	}
}

} // namespace contactdynamics
