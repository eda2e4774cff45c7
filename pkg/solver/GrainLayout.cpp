// SPDX-License-Identifier: GPL-2.0-or-later
// Which contacts are awake, and what is laid down of each.
#include "GrainOperator.hpp"
#include "LocalDelassus.hpp"
#include "OneContact.hpp"

#include <Eigen/Geometry>

namespace contactdynamics {

void GrainOperator::putSleeper(std::int32_t id)
{
	const Contact& c = problem->contacts[id];
	impulses[id].setZero();
	if (RollingContact* rolling = rollingAt(id)) rolling->stop();
	const Vector3 branch = c.arm1 - c.arm2;
	sleepers.push_back({c.normal, c.gapVelocity + c.imageVelocity.dot(c.normal), c.normal.dot(branch), tree.seat[c.body1], tree.seat[c.body2], id,
						c.ball ? -1 : std::int32_t(turnings.size())});
	if (!c.ball) turnings.push_back({c.arm1.cross(c.normal), c.arm2.cross(c.normal), branch});
}

Vector3 GrainOperator::inGlobalAxes(const BallPack&, const double (&its)[3][packLanes], int lane)
{
	return {its[0][lane], its[1][lane], its[2][lane]};
}

Vector3 GrainOperator::inGlobalAxes(const GeneralPack& p, const double (&its)[3][packLanes], int lane)
{
	const Vector3 n(p.normal[0][lane], p.normal[1][lane], p.normal[2][lane]), t(p.tangent[0][lane], p.tangent[1][lane], p.tangent[2][lane]);
	return its[0][lane] * n + its[1][lane] * t + its[2][lane] * n.cross(t);
}

/// What general contacts ask for of their bodies.
void GrainOperator::takeMobilities()
{
	const auto& bodies = problem->bodies;
	mobilities.resize(state.size());
	inRuns(bodies.size(), [&](std::size_t i) {
		const Vector3& mass = bodies[i].inverseMass;
		const Matrix3& inertia = bodies[i].inverseInertia;
		mobilities[tree.seat[i]] = {mass[1], mass[2], {inertia(0, 0), inertia(1, 1), inertia(2, 2)}, inertia(1, 2), inertia(2, 0), inertia(0, 1)};
	});
}

void GrainOperator::forgetLayout()
{
	packs.clear();
	generals.clear();
	rollingPacks.clear();
	rollingGenerals.clear();
	passes.clear();
	jobs.clear();
	chunks.clear();
	awake = 0;
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

void GrainOperator::putGeneral(std::size_t at, int lane, std::int32_t id)
{
	GeneralPack& pack = generals[at];
	if (const RollingContact* rolling = rollingAt(id)) rolling->put(rollingGenerals[at], lane);
	const Contact& c = problem->contacts[id];
	Matrix3 frame = contactFrame(c.normal);
	Matrix3 W = compliantDelassus(c, frame);
	if (hasField() && W(0, 0) > 0) W.diagonal().array() += mobility(W(0, 0), c) - W(0, 0);
	const OneContact local(W);
	frame = local.principalFrame(frame);
	const Vector3 impulse = frame * impulses[id], image = frame * c.imageVelocity;
	for (int k = 0; k < 3; ++k) {
		pack.normal[k][lane] = frame(0, k);
		pack.tangent[k][lane] = frame(1, k);
		pack.arm1[k][lane] = c.arm1[k];
		pack.arm2[k][lane] = c.arm2[k];
		pack.offset[k][lane] = image[k] + (k == 0 ? c.gapVelocity : 0);
		pack.impulse[k][lane] = impulse[k];
	}
	pack.normalCompliance[lane] = c.normalCompliance;
	pack.tangentialCompliance[lane] = c.tangentialCompliance;
	const PrincipalContact& along = local.principal();
	pack.Wnn[lane] = along.Wnn;
	pack.wLarge[lane] = along.wLarge;
	pack.wSmall[lane] = along.wSmall;
	pack.largeEigen[lane] = along.largeEigen;
	pack.smallEigen[lane] = along.smallEigen;
	pack.roundOff[lane] = along.roundOff;
	pack.friction[lane] = c.friction;
	pack.body1[lane] = indexOf(c.body1);
	pack.body2[lane] = indexOf(c.body2);
	pack.id[lane] = id;
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
	const auto sort = [&](const auto& pack, int lane, double u, double Wnn) {
		const std::int32_t id = pack.id[lane];
		const RollingContact* rolling = rollingAt(id);
		const bool carries = (rolling && rolling->carries()) || isNonzero(pack.impulse, lane) || isNonzero(pack.increment, lane) ||
							 isNonzero(pack.direction, lane);
		if (carries || u <= 0.1 * std::sqrt(energy * Wnn))
			selected.push_back(id);
		else
			++idle;
	};
	eachContact(packs, [&](const BallPack& p, int lane) {
		sort(p, lane, normalVelocity(p, lane) + p.gapVelocity[lane], stateAt(p.body1[lane]).inverseMass + stateAt(p.body2[lane]).inverseMass);
	});
	eachContact(generals, [&](const GeneralPack& g, int lane) {
		const Contact& c = contacts[g.id[lane]];
		sort(g, lane, normalVelocity(c) + c.gapVelocity, g.Wnn[lane]);
	});
	if (5 * idle < awake) return; // not worth the move

	place.assign(contacts.size(), -1);
	courses.clear();
	reserveWithRoom(courses, awake);
	const auto keepCourse = [&](const auto& pack, int lane, double slidingRate) {
		place[pack.id[lane]] = std::int32_t(courses.size());
		courses.emplace_back();
		for (int j = 0; j < 3; ++j) {
			courses.back().impulse[j] = pack.impulse[j][lane];
			courses.back().increment[j] = pack.increment[j][lane];
			courses.back().direction[j] = pack.direction[j][lane];
		}
		courses.back().slidingRate = slidingRate;
	};
	eachContact(packs, [&](const BallPack& p, int lane) { keepCourse(p, lane, 0); });
	eachContact(generals, [&](const GeneralPack& g, int lane) { keepCourse(g, lane, g.slidingRate[lane]); });
	std::sort(selected.begin(), selected.end());
	std::size_t next = 0;
	for (std::size_t id = 0; id < contacts.size(); ++id) {
		if (place[id] < 0) continue;
		if (next < selected.size() && std::size_t(selected[next]) == id)
			++next;
		else
			putSleeper(std::int32_t(id));
	}
	forgetLayout();
	layOut(selected);
	const auto goOn = [&](auto& pack, int lane) {
		const Course& course = courses[place[pack.id[lane]]];
		for (int j = 0; j < 3; ++j) {
			pack.impulse[j][lane] = course.impulse[j];
			pack.increment[j][lane] = course.increment[j];
			pack.direction[j][lane] = course.direction[j];
		}
		return course.slidingRate;
	};
	eachContact(packs, goOn);
	eachContact(generals, [&](GeneralPack& g, int lane) { g.slidingRate[lane] = goOn(g, lane); });
}

} // namespace contactdynamics
