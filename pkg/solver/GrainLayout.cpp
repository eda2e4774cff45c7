// SPDX-License-Identifier: GPL-2.0-or-later
// Which contacts are awake, and what is laid down of each.
#include "GrainOperator.hpp"

namespace contactdynamics {

void GrainOperator::putSleeper(std::int32_t id)
{
	const Contact& c = problem->contacts[id];
	impulses[id].setZero();
	if (RollingContact* rolling = rollingAt(id)) rolling->stop();
	sleepers.push_back({c.normal, c.ball ? c.gapVelocity + c.imageVelocity.dot(c.normal) : c.gapVelocity, c.normal.dot(c.arm1 - c.arm2),
						tree.seat[c.body1], tree.seat[c.body2], id, !c.ball});
}

BallPack GrainOperator::emptyPack() const
{
	BallPack empty{};
	for (int lane = 0; lane < packLanes; ++lane) {
		empty.id[lane] = -1;
		empty.body1[lane] = empty.body2[lane] = ~std::int32_t(problem->bodies.size());
	}
	return empty;
}

void GrainOperator::putBall(std::size_t at, int lane, std::int32_t id)
{
	BallPack& pack = packs[at];
	if (const RollingContact* rolling = rollingAt(id)) rolling->put(rollingPacks[at], lane);
	const Contact& c = problem->contacts[id];
	const Body &b1 = problem->bodies[c.body1], &b2 = problem->bodies[c.body2];
	const double a1 = c.arm1.dot(c.normal), a2 = c.arm2.dot(c.normal);
	const double Wn = b1.inverseMass[0] + b2.inverseMass[0], Wt = Wn + a1 * a1 * b1.inverseInertia(0, 0) + a2 * a2 * b2.inverseInertia(0, 0);
	pack.body1[lane] = indexOf(c.body1);
	pack.body2[lane] = indexOf(c.body2);
	pack.id[lane] = id;
	for (int k = 0; k < 3; ++k) {
		pack.normal[k][lane] = c.normal[k];
		pack.impulse[k][lane] = impulses[id][k];
	}
	pack.gapVelocity[lane] = c.gapVelocity;
	pack.friction[lane] = c.friction;
	pack.arm1[lane] = a1;
	pack.arm2[lane] = a2;
	pack.inverseWn[lane] = Wn > 0 ? 1 / mobility(Wn, c) : 0;
	pack.inverseWt[lane] = Wt > 0 ? 1 / mobility(Wt, c) : 0;
}

void GrainOperator::putGeneral(GeneralContact& g, std::int32_t id)
{
	const Contact& c = problem->contacts[id];
	g.id = id;
	g.body1 = indexOf(c.body1);
	g.body2 = indexOf(c.body2);
	g.mobility1 = &problem->bodies[c.body1];
	g.mobility2 = &problem->bodies[c.body2];
	g.frame = contactFrame(c.normal);
	g.arm1 = c.arm1;
	g.arm2 = c.arm2;
	g.offset = g.frame * c.imageVelocity;
	g.offset[0] += c.gapVelocity;
	g.compliance = {c.normalCompliance, c.tangentialCompliance, c.tangentialCompliance};
	g.W = localDelassus(problem->bodies[c.body1], problem->bodies[c.body2], c, g.frame);
	g.W.diagonal() += g.compliance;
	if (hasField() && g.W(0, 0) > 0) g.W.diagonal().array() += mobility(g.W(0, 0), c) - g.W(0, 0);
	g.friction = c.friction;
	g.local = OneContact(g.W);
	g.slidingRate = 0;
	g.impulse = g.frame * impulses[id];
	g.rolling = rollingAt(id);
	g.increment.setZero();
	g.direction.setZero();
}

/// Lays the awake contacts out anew, without those that carry nothing and separate by more than a tenth of the typical change of velocity.
void GrainOperator::letIdleSleep()
{
	const auto& contacts = problem->contacts;
	if (contacts.size() <= 64) return;
	const double energy = lastNorms.impulse2 / double(awake); // typical r^T W r, so that W_nn times it is a velocity squared
	selected.clear();
	collectTorques();
	std::size_t idle = 0;
	const auto sort = [&](std::int32_t id, bool carries, double Wnn) {
		const double u = normalVelocity(contacts[id]) + contacts[id].gapVelocity;
		if (carries || u <= 0.1 * std::sqrt(energy * Wnn))
			selected.push_back(id);
		else
			++idle;
	};
	for (const BallPack& p : packs)
		for (int k = 0; k < packLanes; ++k) {
			if (p.id[k] < 0) continue;
			bool carries = false;
			for (int j = 0; j < 3; ++j) carries = carries || p.impulse[j][k] != 0 || p.increment[j][k] != 0 || p.direction[j][k] != 0;
			const RollingContact* rolling = rollingAt(p.id[k]);
			carries = carries || (rolling && rolling->carries());
			sort(p.id[k], carries, stateOf(contacts[p.id[k]].body1).inverseMass + stateOf(contacts[p.id[k]].body2).inverseMass);
		}
	for (const GeneralContact& g : generals) {
		const bool carriesTorque = g.rolling && g.rolling->carries();
		sort(g.id, carriesTorque || !g.impulse.isZero(0) || !g.increment.isZero(0) || !g.direction.isZero(0), g.W(0, 0));
	}
	if (5 * idle < awake) return; // not worth the move

	place.assign(contacts.size(), -1);
	oldGenerals.swap(generals);
	courses.clear();
	courses.reserve(awake);
	for (const BallPack& p : packs)
		for (int k = 0; k < packLanes; ++k) {
			if (p.id[k] < 0) continue;
			place[p.id[k]] = std::int32_t(courses.size());
			courses.emplace_back();
			for (int j = 0; j < 3; ++j) {
				impulses[p.id[k]][j] = p.impulse[j][k]; // from where putBall() takes it
				courses.back().increment[j] = p.increment[j][k];
				courses.back().direction[j] = p.direction[j][k];
			}
		}
	for (std::size_t i = 0; i < oldGenerals.size(); ++i) place[oldGenerals[i].id] = std::int32_t(i);
	std::sort(selected.begin(), selected.end());
	std::size_t next = 0;
	for (std::size_t id = 0; id < contacts.size(); ++id) {
		if (place[id] < 0) continue;
		if (next < selected.size() && std::size_t(selected[next]) == id)
			++next;
		else
			putSleeper(std::int32_t(id));
	}
	packs.clear();
	rollingPacks.clear();
	generals.clear();
	passes.clear();
	jobs.clear();
	chunks.clear();
	awake = 0;
	layOut(selected);
	for (BallPack& p : packs)
		for (int k = 0; k < packLanes; ++k) {
			if (p.id[k] < 0) continue;
			const Course& course = courses[place[p.id[k]]];
			for (int j = 0; j < 3; ++j) {
				p.increment[j][k] = course.increment[j];
				p.direction[j][k] = course.direction[j];
			}
		}
	for (GeneralContact& g : generals) g = oldGenerals[place[g.id]];
}

} // namespace contactdynamics
