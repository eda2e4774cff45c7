// SPDX-License-Identifier: GPL-2.0-or-later
#include "GrainOperator.hpp"

#include "BodyView.hpp"
#include "CoulombCone.hpp"

#include <Eigen/Geometry>

namespace contactdynamics {

void GrainOperator::start(GrainProblem& given, bool accelerate, Crew& hands)
{
	problem = &given;
	accelerated = accelerate;
	sweeps = 0;
	lastNorms = {};
	speedLimit = largestFreeApproach = 0;
	const auto& bodies = problem->bodies;
	const auto& contacts = problem->contacts;
	state.resize(bodies.size() + 1);
	movable.resize(bodies.size());
	crew = &hands;
	together = isWorthThreads(contacts.size());
	inRuns(bodies.size(), [&](std::size_t i) { movable[i] = bodies[i].moves(); });
	takeSeats();
	inRuns(bodies.size(), [&](std::size_t i) {
		BodyState& its = stateOf(std::int32_t(i));
		its.inverseMass = bodies[i].inverseMass[0];
		its.inverseInertia = bodies[i].inverseInertia(0, 0);
	});
	state.back() = {}; // what lanes without a contact refer to
	impulses.resize(contacts.size());
	inRuns(contacts.size(), [&](std::size_t i) {
		const Contact& c = contacts[i];
		const bool none = c.impulse.isZero(0) || !(movable[c.body1] || movable[c.body2]);
		impulses[i] = none ? Vector3(Vector3::Zero()) : insideCone(c.impulse, c.normal, c.friction);
	});
	startField();
	startRolling();
	freeVelocities();
	sums.assign((contacts.size() + perRun - 1) / perRun, Sums{});
	inRuns(contacts.size(), [&](std::size_t i) {
		Sums& run = sums[i / perRun];
		const double approach = normalVelocity(contacts[i]) + contacts[i].gapVelocity, speeds = speedsAt(contacts[i]);
		run.closes = run.closes || approach < -roundOffOf(speeds);
		run.approach = std::max(run.approach, -approach);
		run.speeds = std::max(run.speeds, speeds);
		run.anyGeneral = run.anyGeneral || !isBall(contacts[i]);
	});
	bool closes = false, anyGeneral = false;
	for (const Sums& run : sums) {
		closes = closes || run.closes;
		anyGeneral = anyGeneral || run.anyGeneral;
		largestFreeApproach = std::max(largestFreeApproach, run.approach);
		speedLimit = std::max(speedLimit, 1000 * run.speeds);
	}
	// Where nothing closes, no impulse at all is an exact solution; from impulses of before the sweeps would only creep up to it.
	if (!closes)
		for (Vector3& impulse : impulses) impulse.setZero();
	mobilities.clear();
	if (anyGeneral) takeMobilities();
	beginAtImpulses();
}

/// From free velocities and feasible impulses to those that the impulses give, and the layout of the contacts.
void GrainOperator::beginAtImpulses()
{
	const auto& contacts = problem->contacts;
	for (std::size_t i = 0; i < impulses.size(); ++i)
		if (!impulses[i].isZero(0)) addImpulse(contacts[i], impulses[i]);
	beginAtTorques();
	if (hasField()) sumMoment();
	if (accelerated) {
		sweepStart = state;
		direction.assign(state.size(), BodyState{});
		momentStart = moment;
		momentDirection.setZero();
	}

	// Awake at first: what carries an impulse, closes, or could be closed by a change of velocity as large as the fastest approach.
	double fastest = 0;
	closing.resize(contacts.size());
	inRuns(contacts.size(), [&](std::size_t i) { closing[i] = -normalVelocity(contacts[i]) - contacts[i].gapVelocity; });
	for (const double speed : closing) fastest = std::max(fastest, speed);
	mustWake.resize(contacts.size());
	inRuns(contacts.size(), [&](std::size_t i) { mustWake[i] = -closing[i] <= fastest || !impulses[i].isZero(0); });
	const bool small = contacts.size() <= 64;
	forgetLayout();
	sleepers.clear();
	reserveWithRoom(sleepers, contacts.size());
	turnings.clear();
	selected.clear();
	for (std::size_t i = 0; i < contacts.size(); ++i) {
		if (small || mustWake[i])
			selected.push_back(std::int32_t(i));
		else
			putSleeper(std::int32_t(i));
	}
	layOut(selected);
	together = isWorthThreads(awake);
}

double GrainOperator::normalVelocity(const Contact& c) const
{
	const BodyState &b1 = stateOf(c.body1), &b2 = stateOf(c.body2);
	Vector3 u = velocity(b2) + c.imageVelocity - velocity(b1);
	if (!c.ball) u += angularVelocity(b2).cross(c.arm2) - angularVelocity(b1).cross(c.arm1);
	if (hasField()) u += gradient * (c.arm1 - c.arm2);
	return u.dot(c.normal);
}

/// Without a look at the problem, whose contacts the sweeps have driven from the cache.
double GrainOperator::normalVelocity(const BallPack& p, int k) const
{
	const Vector3 n(p.normal[0][k], p.normal[1][k], p.normal[2][k]);
	const double u = (velocity(stateAt(p.body2[k])) - velocity(stateAt(p.body1[k]))).dot(n);
	return hasField() ? u + (p.arm1[k] - p.arm2[k]) * n.dot(gradient * n) : u;
}

double GrainOperator::normalVelocity(const Sleeper& s) const
{
	const BodyState &b1 = state[s.body1], &b2 = state[s.body2];
	double u = (velocity(b2) - velocity(b1)).dot(s.normal);
	if (s.turning < 0) return hasField() ? u + s.reach * s.normal.dot(gradient * s.normal) : u;
	const Turning& its = turnings[s.turning];
	u += angularVelocity(b2).dot(its.turn2) - angularVelocity(b1).dot(its.turn1);
	return hasField() ? u + s.normal.dot(gradient * its.branch) : u;
}

void GrainOperator::keep()
{
	collectImpulses(kept);
	collectTorques();
	keptTorques.resize(rollingContacts.size());
	for (std::size_t k = 0; k < rollingContacts.size(); ++k) keptTorques[k] = rollingContacts[k].torque;
}

void GrainOperator::exchangeKept()
{
	collectImpulses(impulses);
	impulses.swap(kept);
	collectTorques();
	for (std::size_t k = 0; k < rollingContacts.size(); ++k) rollingContacts[k].torque.swap(keptTorques[k]);
	freeVelocities();
	beginAtImpulses();
}

void GrainOperator::extrapolate(Extrapolation by, std::size_t first, std::size_t last)
{
	kernels.advance(state.data() + first, sweepStart.data() + first, direction.data() + first, last - first, by);
}

void GrainOperator::visit(const Chunk& chunk, SweepNorms& norms, Extrapolation by, FieldPass* field)
{
	if (accelerated) extrapolate(by, chunk.firstSeat, chunk.lastSeat);
	norms = chunk.packs ? kernels.sweep(state.data(), packs.data() + chunk.firstPack, rollingFrom(chunk.firstPack), chunk.packs, by, field)
						: SweepNorms{};
	if (chunk.generals == 0) return;
	const SweepNorms rest = kernels.sweepGeneral(state.data(), mobilities.data(), generals.data() + chunk.firstGeneral,
												 rollingGeneralsFrom(chunk.firstGeneral), chunk.generals, by, field);
	norms.increment2 += rest.increment2;
	norms.impulse2 += rest.impulse2;
}

SweepNorms GrainOperator::sweep(Extrapolation by)
{
	chunkNorms.resize(chunks.size());
	if (hasField()) startFieldPass(by);
	overChunks([&](std::size_t i) { visit(chunks[i], chunkNorms[i], by, hasField() ? &chunkFields[i] : nullptr); });
	if (hasField()) addFieldPasses();
	++sweeps;
	lastNorms = {};
	for (const SweepNorms& one : chunkNorms) {
		lastNorms.increment2 += one.increment2;
		lastNorms.impulse2 += one.impulse2;
	}
	return lastNorms;
}

bool GrainOperator::mend()
{
	mustWake.resize(sleepers.size());
	const std::size_t count = sleepers.size();
	inRuns(count, [&](std::size_t i) { mustWake[i] = !(normalVelocity(sleepers[i]) + sleepers[i].offset >= 0); });
	selected.clear();
	std::size_t kept = 0;
	for (std::size_t i = 0; i < sleepers.size(); ++i) {
		if (mustWake[i])
			selected.push_back(sleepers[i].id);
		else
			sleepers[kept++] = sleepers[i];
	}
	sleepers.resize(kept);
	const bool woken = !selected.empty();
	layOut(selected);
	if (sweeps >= 8 && (sweeps & (sweeps - 1)) == 0) letIdleSleep();
	return woken;
}

} // namespace contactdynamics
