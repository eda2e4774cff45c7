// SPDX-License-Identifier: GPL-2.0-or-later
// From the impulses of the sweeps to a feasible point, its velocities and its residual.
#include "GrainOperator.hpp"

#include "BodyView.hpp"
#include "CoulombCone.hpp"
#include "LocalDelassus.hpp"

#include <Eigen/Geometry>
#include <numeric>

namespace contactdynamics {

namespace {

void finishContact(Contact& c, const Vector3& impulse)
{
	c.impulse = impulse;
	const double rn = impulse.dot(c.normal);
	if (!(rn > 0)) {
		c.status = ContactStatus::none;
		return;
	}
	// The projection on the cone leaves round-off only: a friction below its limit by more than that sticks.
	c.status = (impulse - rn * c.normal).norm() < (1 - 1e-9) * c.friction * rn ? ContactStatus::sticking : ContactStatus::sliding;
}

} // namespace

/// Zero for contacts that sleep.
void GrainOperator::collectImpulses(std::vector<Vector3>& r)
{
	const auto& contacts = problem->contacts;
	r.assign(contacts.size(), Vector3::Zero());
	const auto collect = [&](const auto& from) {
		inRuns(from.size(), [&](std::size_t i) {
			for (int lane = 0; lane < packLanes; ++lane) {
				const std::int32_t id = from[i].id[lane];
				if (id >= 0) r[id] = insideCone(inGlobalAxes(from[i], from[i].impulse, lane), contacts[id].normal, contacts[id].friction);
			}
		});
	};
	collect(packs);
	collect(generals);
}

void GrainOperator::lastIncrements(ImpulseSet& added) const
{
	added.impulses.assign(problem->contacts.size(), Vector3::Zero());
	const auto collect = [&](const auto& pack, int lane) { added.impulses[pack.id[lane]] = inGlobalAxes(pack, pack.increment, lane); };
	eachContact(packs, collect);
	eachContact(generals, collect);
	added.torques.clear();
	for (const RollingContact& one : rollingContacts) added.torques.push_back(one.increment);
}

void GrainOperator::addImpulse(const Contact& c, const Vector3& impulse)
{
	const auto act = [this](std::int32_t on, const Vector3& arm, const Vector3& its) {
		if (movable[on]) applyImpulse(velocity(stateOf(on)), angularVelocity(stateOf(on)), problem->bodies[on], arm, its);
	};
	act(c.body1, c.arm1, -impulse);
	act(c.body2, c.arm2, impulse);
}

/// Sum of the speeds that the relative velocity is made of, as sums of components: a bound, without square roots.
double GrainOperator::speedsAt(const Contact& c) const
{
	const BodyState &b1 = stateOf(c.body1), &b2 = stateOf(c.body2);
	const auto size = [](const auto& vector) { return vector.cwiseAbs().sum(); };
	return size(velocity(b1)) + size(velocity(b2)) + size(angularVelocity(b1)) * size(c.arm1) + size(angularVelocity(b2)) * size(c.arm2) +
		   size(c.imageVelocity) + std::abs(c.gapVelocity) + (hasField() ? size(gradient) * size(c.arm1 - c.arm2) : 0);
}

void GrainOperator::freeVelocities()
{
	const auto& bodies = problem->bodies;
	inRuns(bodies.size(), [&](std::size_t i) {
		BodyState& its = stateOf(std::int32_t(i));
		velocity(its) = bodies[i].velocity;
		angularVelocity(its) = bodies[i].angularVelocity;
	});
}

/// Velocities = free velocities + M^-1 H r: no drift of the sweeps is left in them. Node by node, so that no two threads meet at a body.
/// The impulses are those of the last visits, inside their cones but for round-off.
void GrainOperator::rebuildVelocities()
{
	freeVelocities();
	if (hasField()) chunkFields.assign(chunks.size(), FieldPass{});
	overChunks([&](std::size_t i) {
		const Chunk& chunk = chunks[i];
		FieldPass* field = hasField() ? &chunkFields[i] : nullptr;
		if (chunk.packs) kernels.rebuild(state.data(), packs.data() + chunk.firstPack, rollingFrom(chunk.firstPack), chunk.packs, field);
		if (chunk.generals)
			kernels.rebuildGeneral(state.data(), mobilities.data(), generals.data() + chunk.firstGeneral, rollingGeneralsFrom(chunk.firstGeneral),
								   chunk.generals, field);
	});
	if (!hasField()) return;
	moment.setZero();
	addFieldPasses();
}

Vector3 GrainOperator::relativeVelocity(const Contact& c) const
{
	const BodyState &b1 = stateOf(c.body1), &b2 = stateOf(c.body2);
	Vector3 U = velocity(b2) + c.imageVelocity - velocity(b1) + angularVelocity(b2).cross(c.arm2) - angularVelocity(b1).cross(c.arm1);
	if (hasField()) U += gradient * (c.arm1 - c.arm2);
	return U;
}

/// Adds a contact that sleeps, without an impulse, to the sums.
void GrainOperator::certifyWithout(const Contact& c, Sums& total) const
{
	const Matrix3 frame = contactFrame(c.normal), W = compliantDelassus(c, frame);
	Vector3 u = frame * relativeVelocity(c);
	u[0] += c.gapVelocity;
	total.approach = std::max(total.approach, -u[0]);
	if (u[0] >= 0 || !(W(0, 0) > 0)) return; // open and separating: F = 0
	const auto F =
			naturalMap<Eigen::Vector2d>({0, Eigen::Vector2d::Zero()}, {u[0], u.tail<2>()}, c.friction, W(0, 0), std::min(speedsAt(c), speedLimit));
	const Vector3 f(F.n, F.t[0], F.t[1]);
	total.residual.add(f.dot(W * f), 0);
}

Matrix3 GrainOperator::compliantDelassus(const Contact& c, const Matrix3& frame) const
{
	Matrix3 W = localDelassus(problem->bodies[c.body1], problem->bodies[c.body2], c, frame);
	W.diagonal() += Vector3(c.normalCompliance, c.tangentialCompliance, c.tangentialCompliance);
	return W;
}

double GrainOperator::certificate()
{
	rebuildVelocities();
	double L[9];
	for (int i = 0; i < 9; ++i) L[i] = gradient(i / 3, i % 3);
	const RoundOff roundOff{roundOffOf(1), roundOffOf(speedLimit)};
	constexpr std::size_t packsPerRun = 256; // long enough for what is fetched ahead
	const auto runs = [](std::size_t count, std::size_t each) { return (count + each - 1) / each; };
	const std::size_t packRuns = runs(packs.size(), packsPerRun), generalRuns = runs(generals.size(), packsPerRun);
	sums.assign(packRuns + generalRuns + runs(sleepers.size(), perRun), Sums{});
	share(sums.size(), [&](std::size_t k) {
		Sums& total = sums[k];
		const double* const field = hasField() ? L : nullptr;
		CertificateSums awakeOnes;
		if (k < packRuns) {
			const std::size_t first = k * packsPerRun, count = std::min(packsPerRun, packs.size() - first);
			awakeOnes = kernels.certify(state.data(), packs.data() + first, rollingFrom(first), count, roundOff, field);
		} else if (k < packRuns + generalRuns) {
			const std::size_t first = (k - packRuns) * packsPerRun, count = std::min(packsPerRun, generals.size() - first);
			awakeOnes = kernels.certifyGeneral(state.data(), mobilities.data(), generals.data() + first, rollingGeneralsFrom(first), count, roundOff,
											   field);
		} else {
			const std::size_t first = (k - packRuns - generalRuns) * perRun;
			for (std::size_t i = first; i < std::min(sleepers.size(), first + perRun); ++i) {
				const Sleeper& s = sleepers[i];
				if (!(normalVelocity(s) + s.offset >= 0)) certifyWithout(problem->contacts[s.id], total);
			}
		}
		total.residual.add(awakeOnes.map2, awakeOnes.impulse2);
		total.approach = std::max(total.approach, awakeOnes.approach);
	});
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
	auto& bodies = problem->bodies;
	inRuns(bodies.size(), [&](std::size_t i) {
		const BodyState& its = stateOf(std::int32_t(i));
		bodies[i].velocity = velocity(its);
		bodies[i].angularVelocity = angularVelocity(its);
	});
	if (hasField()) problem->meanField->gradient = gradient;
	report.maxApproachSpeed = maxApproachSpeed;
	collectImpulses(impulses);
	collectTorques();
	for (std::size_t k = 0; k < rollingContacts.size(); ++k) { // an impulse that is round-off may just have become zero
		RollingFriction& one = problem->rolling[k];
		const Vector3& n = problem->contacts[one.contact].normal;
		one.torque = rollingContacts[k].inside(rollingContacts[k].torque, n, impulses[one.contact].dot(n));
	}
	active.assign((impulses.size() + perRun - 1) / perRun, 0);
	inRuns(impulses.size(), [this](std::size_t i) {
		Contact& c = problem->contacts[i];
		c.relativeVelocity = relativeVelocity(c);
		finishContact(c, impulses[i]);
		if (c.status != ContactStatus::none) ++active[i / perRun];
	});
	report.activeContacts = std::accumulate(active.begin(), active.end(), 0);
}

} // namespace contactdynamics
