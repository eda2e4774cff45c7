// SPDX-License-Identifier: GPL-2.0-or-later
#include "GrainOperator.hpp"

#include <Eigen/Geometry>

namespace contactdynamics {

namespace {

constexpr std::size_t packsPerChunk = 32, generalsPerChunk = 32, contactsPerRun = 512, bodiesPerRun = 1024;
constexpr std::size_t worthThreads = 3000; // awake contacts; below, handing out the colours costs more than it brings

using Map = Eigen::Map<Vector3>;
using ConstMap = Eigen::Map<const Vector3>;

ConstMap velocity(const BodyState& b) { return ConstMap(b.velocity); }
ConstMap angularVelocity(const BodyState& b) { return ConstMap(b.angularVelocity); }

/// Brings an impulse inside the cone: negative normal parts vanish, the friction is shortened to its limit.
Vector3 insideCone(const Vector3& impulse, const Vector3& n, double mu)
{
	const double rn = impulse.dot(n);
	if (!(rn > 0)) return rn <= 0 ? Vector3(Vector3::Zero()) : impulse; // not finite stays visible
	const Vector3 rt = impulse - rn * n;
	const double length = rt.norm();
	return length > mu * rn ? Vector3(rn * n + (mu * rn / length) * rt) : impulse;
}

} // namespace

void GrainOperator::start(GrainProblem& given, bool accelerate, int maxThreads)
{
	problem = &given;
	accelerated = accelerate;
	sweeps = 0;
	lastNorms = {};
	const auto& bodies = problem->bodies;
	const auto& contacts = problem->contacts;
	state.resize(bodies.size() + 1);
	movable.resize(bodies.size());
	for (std::size_t i = 0; i < bodies.size(); ++i) {
		movable[i] = !bodies[i].inverseMass.isZero(0) || !bodies[i].inverseInertia.isZero(0);
		state[i].inverseMass = bodies[i].inverseMass[0];
		state[i].inverseInertia = bodies[i].inverseInertia(0, 0);
	}
	state.back() = {}; // what lanes without a contact refer to
	impulses.resize(contacts.size());
	for (std::size_t i = 0; i < contacts.size(); ++i) {
		const Contact& c = contacts[i];
		const bool none = c.impulse.isZero(0) || !(movable[c.body1] || movable[c.body2]);
		impulses[i] = none ? Vector3(Vector3::Zero()) : insideCone(c.impulse, c.normal, c.friction);
	}
	// Where nothing closes, no impulse at all is an exact solution; from impulses of before the sweeps would only creep up to it.
	freeVelocities();
	if (std::none_of(contacts.begin(), contacts.end(), [this](const Contact& c) { return closes(c); }))
		for (Vector3& impulse : impulses) impulse.setZero();
	rebuildVelocities();
	if (accelerated) {
		sweepStart = state;
		direction.assign(state.size(), BodyState{});
	}

	// Awake at first: what carries an impulse, closes, or could be closed by a change of velocity as large as the fastest approach.
	double fastest = 0;
	sums.resize(contacts.size());
	for (std::size_t i = 0; i < contacts.size(); ++i) {
		sums[i].approach = normalVelocity(contacts[i]) + contacts[i].gapVelocity;
		fastest = std::max(fastest, -sums[i].approach);
	}
	const bool small = contacts.size() <= 64;
	packs.clear();
	generals.clear();
	groups.clear();
	chunks.clear();
	sleepers.clear();
	selected.clear();
	awake = 0;
	for (std::size_t i = 0; i < contacts.size(); ++i) {
		if (small || sums[i].approach <= fastest || !impulses[i].isZero(0))
			selected.push_back(std::int32_t(i));
		else
			putSleeper(std::int32_t(i));
	}
	layOut(selected);
	crew.emplace(awake >= worthThreads ? maxThreads : 1);
}

double GrainOperator::normalVelocity(const Contact& c) const
{
	const BodyState &b1 = state[c.body1], &b2 = state[c.body2];
	Vector3 u = velocity(b2) + c.imageVelocity - velocity(b1);
	if (!c.ball) u += angularVelocity(b2).cross(c.arm2) - angularVelocity(b1).cross(c.arm1);
	return u.dot(c.normal);
}

double GrainOperator::normalVelocity(const Sleeper& s) const
{
	if (s.turns) return normalVelocity(problem->contacts[s.id]);
	return (velocity(state[s.body2]) - velocity(state[s.body1])).dot(s.normal);
}

void GrainOperator::putSleeper(std::int32_t id)
{
	const Contact& c = problem->contacts[id];
	impulses[id].setZero();
	sleepers.push_back({c.normal, c.ball ? c.gapVelocity + c.imageVelocity.dot(c.normal) : c.gapVelocity, c.body1, c.body2, id, !c.ball});
}

void GrainOperator::putBall(BallPack& pack, int lane, std::int32_t id) const
{
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
	pack.inverseWn[lane] = Wn > 0 ? 1 / Wn : 0;
	pack.inverseWt[lane] = Wt > 0 ? 1 / Wt : 0;
}

void GrainOperator::putGeneral(GeneralContact& g, std::int32_t id) const
{
	const Contact& c = problem->contacts[id];
	g.id = id;
	g.body1 = indexOf(c.body1);
	g.body2 = indexOf(c.body2);
	g.frame = contactFrame(c.normal);
	g.arm1 = c.arm1;
	g.arm2 = c.arm2;
	g.offset = g.frame * c.imageVelocity;
	g.offset[0] += c.gapVelocity;
	g.W = localDelassus(problem->bodies[c.body1], problem->bodies[c.body2], c, g.frame);
	g.friction = c.friction;
	g.local = OneContact(g.W);
	g.impulse = g.frame * impulses[id];
	g.increment.setZero();
	g.direction.setZero();
}

/// Appends contacts as new colours: counting sort by colour, balls in packs of four, general contacts one by one.
void GrainOperator::layOut(const std::vector<std::int32_t>& ids)
{
	if (ids.empty()) return;
	const auto& contacts = problem->contacts;
	colouring.reset(problem->bodies.size());
	constexpr int kinds = 2 * (Colouring::overflow + 1);
	std::size_t count[kinds + 1] = {};
	colourOf.resize(ids.size());
	for (std::size_t i = 0; i < ids.size(); ++i) {
		const Contact& c = contacts[ids[i]];
		colourOf[i] = 2 * colouring.assign(indexOf(c.body1), indexOf(c.body2)) + (isBall(c) ? 0 : 1);
		++count[colourOf[i] + 1];
	}
	for (int k = 0; k < kinds; ++k) count[k + 1] += count[k];
	order.resize(ids.size());
	{
		std::size_t next[kinds];
		std::copy(count, count + kinds, next);
		for (std::size_t i = 0; i < ids.size(); ++i) order[next[colourOf[i]]++] = ids[i];
	}
	BallPack empty{};
	for (int lane = 0; lane < 4; ++lane) {
		empty.id[lane] = -1;
		empty.body1[lane] = empty.body2[lane] = ~std::int32_t(problem->bodies.size());
	}
	for (int colour = 0; colour <= Colouring::overflow; ++colour) {
		const std::size_t balls = count[2 * colour], first = count[2 * colour + 1], last = count[2 * colour + 2];
		if (balls == last) continue;
		const int lanes = colour == Colouring::overflow ? 1 : 4; // contacts of the overflow colour do share bodies
		const std::size_t firstPack = packs.size(), firstGeneral = generals.size(), firstChunk = chunks.size();
		for (std::size_t i = balls; i < first; ++i) {
			const int lane = int((i - balls) % lanes);
			if (lane == 0) packs.push_back(empty);
			putBall(packs.back(), lane, order[i]);
		}
		generals.resize(firstGeneral + last - first);
		for (std::size_t i = first; i < last; ++i) putGeneral(generals[firstGeneral + i - first], order[i]);
		const std::size_t packCount = packs.size() - firstPack, generalCount = generals.size() - firstGeneral;
		if (colour == Colouring::overflow)
			chunks.push_back({firstPack, packCount, firstGeneral, generalCount});
		else {
			for (std::size_t k = 0; k < packCount; k += packsPerChunk)
				chunks.push_back({firstPack + k, std::min(packsPerChunk, packCount - k), 0, 0});
			for (std::size_t k = 0; k < generalCount; k += generalsPerChunk)
				chunks.push_back({0, 0, firstGeneral + k, std::min(generalsPerChunk, generalCount - k)});
		}
		groups.push_back({firstChunk, chunks.size()});
	}
	awake += ids.size();
}

void GrainOperator::extrapolate(Extrapolation by, std::size_t first, std::size_t last)
{
	for (std::size_t i = first; i < last; ++i) {
		BodyState &now = state[i], &start = sweepStart[i], &d = direction[i];
		for (int k = 0; k < 3; ++k) {
			const double lastV = now.velocity[k] - start.velocity[k], lastW = now.angularVelocity[k] - start.angularVelocity[k];
			const double dv = by.relax * lastV + by.momentum * d.velocity[k], dw = by.relax * lastW + by.momentum * d.angularVelocity[k];
			d.velocity[k] = lastV + dv;
			d.angularVelocity[k] = lastW + dw;
			start.velocity[k] = now.velocity[k] += dv;
			start.angularVelocity[k] = now.angularVelocity[k] += dw;
		}
	}
}

void GrainOperator::visit(const Chunk& chunk, SweepNorms& norms, Extrapolation by)
{
	norms = chunk.packs ? ballSweep(state.data(), packs.data() + chunk.firstPack, chunk.packs, by) : SweepNorms{};
	for (std::size_t k = chunk.firstGeneral; k < chunk.firstGeneral + chunk.generals; ++k) {
		const SweepNorms one = contactdynamics::visit(generals[k], state.data(), problem->bodies.data(), by);
		norms.increment2 += one.increment2;
		norms.impulse2 += one.impulse2;
	}
}

SweepNorms GrainOperator::sweep(Extrapolation by)
{
	chunkNorms.resize(chunks.size());
	const std::size_t bodies = problem->bodies.size();
	if (accelerated)
		crew->run((bodies + bodiesPerRun - 1) / bodiesPerRun,
				  [&](std::size_t k) { extrapolate(by, k * bodiesPerRun, std::min(bodies, (k + 1) * bodiesPerRun)); });
	for (const Group& group : groups)
		crew->run(group.lastChunk - group.firstChunk,
				  [&](std::size_t k) { visit(chunks[group.firstChunk + k], chunkNorms[group.firstChunk + k], by); });
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
	crew->run((count + contactsPerRun - 1) / contactsPerRun, [&](std::size_t k) {
		for (std::size_t i = k * contactsPerRun; i < std::min(count, (k + 1) * contactsPerRun); ++i)
			mustWake[i] = !(normalVelocity(sleepers[i]) + sleepers[i].offset >= 0);
	});
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

/// Lays the awake contacts out anew, without those that carry nothing and separate by more than a tenth of the typical change of velocity.
void GrainOperator::letIdleSleep()
{
	const auto& contacts = problem->contacts;
	if (contacts.size() <= 64) return;
	const double energy = lastNorms.impulse2 / double(awake); // typical r^T W r, so that W_nn times it is a velocity squared
	selected.clear();
	std::size_t idle = 0;
	const auto sort = [&](std::int32_t id, bool carries, double Wnn) {
		const double u = normalVelocity(contacts[id]) + contacts[id].gapVelocity;
		if (carries || u <= 0.1 * std::sqrt(energy * Wnn))
			selected.push_back(id);
		else
			++idle;
	};
	for (const BallPack& p : packs)
		for (int k = 0; k < 4; ++k) {
			if (p.id[k] < 0) continue;
			bool carries = false;
			for (int j = 0; j < 3; ++j) carries = carries || p.impulse[j][k] != 0 || p.increment[j][k] != 0 || p.direction[j][k] != 0;
			sort(p.id[k], carries, state[contacts[p.id[k]].body1].inverseMass + state[contacts[p.id[k]].body2].inverseMass);
		}
	for (const GeneralContact& g : generals) sort(g.id, !g.impulse.isZero(0) || !g.increment.isZero(0) || !g.direction.isZero(0), g.W(0, 0));
	if (5 * idle < awake) return; // not worth the move

	place.assign(contacts.size(), Place{-1, 0});
	oldPacks.swap(packs);
	oldGenerals.swap(generals);
	for (std::size_t i = 0; i < oldPacks.size(); ++i)
		for (int k = 0; k < 4; ++k)
			if (oldPacks[i].id[k] >= 0) place[oldPacks[i].id[k]] = {std::int32_t(i), k};
	for (std::size_t i = 0; i < oldGenerals.size(); ++i) place[oldGenerals[i].id] = {std::int32_t(i), 0};
	std::sort(selected.begin(), selected.end());
	std::size_t next = 0;
	for (std::size_t id = 0; id < contacts.size(); ++id) {
		if (place[id].where < 0) continue;
		if (next < selected.size() && std::size_t(selected[next]) == id)
			++next;
		else
			putSleeper(std::int32_t(id));
	}
	packs.clear();
	generals.clear();
	groups.clear();
	chunks.clear();
	awake = 0;
	layOut(selected);
	for (BallPack& p : packs)
		for (int k = 0; k < 4; ++k) {
			if (p.id[k] < 0) continue;
			const Place from = place[p.id[k]];
			const BallPack& old = oldPacks[from.where];
			for (int j = 0; j < 3; ++j) {
				p.impulse[j][k] = old.impulse[j][from.lane];
				p.increment[j][k] = old.increment[j][from.lane];
				p.direction[j][k] = old.direction[j][from.lane];
			}
		}
	for (GeneralContact& g : generals) g = oldGenerals[place[g.id].where];
}

void GrainOperator::collectImpulses()
{
	const auto& contacts = problem->contacts;
	for (const BallPack& p : packs)
		for (int k = 0; k < 4; ++k) {
			if (p.id[k] < 0) continue;
			const Contact& c = contacts[p.id[k]];
			impulses[p.id[k]] = insideCone({p.impulse[0][k], p.impulse[1][k], p.impulse[2][k]}, c.normal, c.friction);
		}
	for (const GeneralContact& g : generals) impulses[g.id] = insideCone(g.frame.transpose() * g.impulse, contacts[g.id].normal, g.friction);
}

void GrainOperator::addImpulse(const Contact& c, const Vector3& impulse)
{
	const auto& bodies = problem->bodies;
	if (movable[c.body1]) {
		Map(state[c.body1].velocity) -= bodies[c.body1].inverseMass.cwiseProduct(impulse);
		Map(state[c.body1].angularVelocity) -= bodies[c.body1].inverseInertia * c.arm1.cross(impulse);
	}
	if (movable[c.body2]) {
		Map(state[c.body2].velocity) += bodies[c.body2].inverseMass.cwiseProduct(impulse);
		Map(state[c.body2].angularVelocity) += bodies[c.body2].inverseInertia * c.arm2.cross(impulse);
	}
}

bool GrainOperator::closes(const Contact& c) const { return normalVelocity(c) + c.gapVelocity < -roundOffOf(speedsAt(c)); }

/// Sum of the speeds that the relative velocity is made of, as sums of components: a bound, without square roots.
double GrainOperator::speedsAt(const Contact& c) const
{
	const BodyState &b1 = state[c.body1], &b2 = state[c.body2];
	const auto size = [](const auto& vector) { return vector.cwiseAbs().sum(); };
	return size(velocity(b1)) + size(velocity(b2)) + size(angularVelocity(b1)) * size(c.arm1) + size(angularVelocity(b2)) * size(c.arm2) +
		   size(c.imageVelocity) + std::abs(c.gapVelocity);
}

void GrainOperator::freeVelocities()
{
	const auto& bodies = problem->bodies;
	for (std::size_t i = 0; i < bodies.size(); ++i) {
		Map(state[i].velocity) = bodies[i].velocity;
		Map(state[i].angularVelocity) = bodies[i].angularVelocity;
	}
}

/// Velocities = free velocities + M^-1 H r: no drift of the sweeps is left in them.
void GrainOperator::rebuildVelocities()
{
	freeVelocities();
	for (std::size_t i = 0; i < impulses.size(); ++i)
		if (!impulses[i].isZero(0)) addImpulse(problem->contacts[i], impulses[i]);
}

GrainOperator::Sums GrainOperator::certify(std::size_t first, std::size_t last)
{
	Sums result;
	for (std::size_t i = first; i < last; ++i) {
		Contact& c = problem->contacts[i];
		const BodyState &b1 = state[c.body1], &b2 = state[c.body2];
		const Vector3 U = velocity(b2) + c.imageVelocity - velocity(b1) + angularVelocity(b2).cross(c.arm2) - angularVelocity(b1).cross(c.arm1);
		c.relativeVelocity = U;
		const double un = U.dot(c.normal) + c.gapVelocity, rn = impulses[i].dot(c.normal);
		result.approach = std::max(result.approach, -un);
		if (un >= 0 && rn <= 0) continue; // open and separating: F = 0
		const double speeds = speedsAt(c);
		if (c.ball) {
			const double Wn = b1.inverseMass + b2.inverseMass;
			if (!(Wn > 0)) continue;
			const double Wt = Wn + c.arm1.squaredNorm() * b1.inverseInertia + c.arm2.squaredNorm() * b2.inverseInertia;
			const Vector3 rt = impulses[i] - rn * c.normal, ut = U - U.dot(c.normal) * c.normal;
			const auto F = naturalMap<Vector3>({rn, rt}, {un, ut}, c.friction, Wn, speeds);
			result.residual.add(Wn * F.n * F.n + Wt * F.t.squaredNorm(), Wn * rn * rn + Wt * rt.squaredNorm());
		} else {
			const Matrix3 frame = contactFrame(c.normal), W = localDelassus(problem->bodies[c.body1], problem->bodies[c.body2], c, frame);
			if (!(W(0, 0) > 0)) continue;
			const Vector3 r = frame * impulses[i], u = frame * U;
			const auto F = naturalMap<Eigen::Vector2d>({rn, r.tail<2>()}, {un, u.tail<2>()}, c.friction, W(0, 0), speeds);
			const Vector3 f(F.n, F.t[0], F.t[1]);
			result.residual.add(f.dot(W * f), r.dot(W * r));
		}
	}
	return result;
}

double GrainOperator::certificate()
{
	collectImpulses();
	rebuildVelocities();
	const std::size_t count = problem->contacts.size();
	sums.assign((count + contactsPerRun - 1) / contactsPerRun, Sums{});
	crew->run(sums.size(), [&](std::size_t k) { sums[k] = certify(k * contactsPerRun, std::min(count, (k + 1) * contactsPerRun)); });
	Sums total;
	for (const Sums& one : sums) {
		total.residual.add(one.residual);
		total.approach = std::max(total.approach, one.approach);
	}
	maxApproachSpeed = total.approach;
	return total.residual.value();
}

void GrainOperator::finish(SolveReport& report)
{
	crew.reset();
	auto& bodies = problem->bodies;
	for (std::size_t i = 0; i < bodies.size(); ++i) {
		bodies[i].velocity = velocity(state[i]);
		bodies[i].angularVelocity = angularVelocity(state[i]);
	}
	report.maxApproachSpeed = maxApproachSpeed;
	report.activeContacts = 0;
	for (std::size_t i = 0; i < impulses.size(); ++i) {
		Contact& c = problem->contacts[i];
		c.impulse = impulses[i];
		const double rn = c.impulse.dot(c.normal);
		if (!(rn > 0)) {
			c.status = ContactStatus::none;
			continue;
		}
		++report.activeContacts;
		// The projection on the cone leaves round-off only: a friction below its limit by more than that sticks.
		c.status = (c.impulse - rn * c.normal).norm() < (1 - 1e-9) * c.friction * rn ? ContactStatus::sticking : ContactStatus::sliding;
	}
}

} // namespace contactdynamics
