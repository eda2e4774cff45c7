// SPDX-License-Identifier: GPL-2.0-or-later
// From the impulses of the sweeps to a feasible point, its velocities and its residual.
#include "GrainOperator.hpp"

#include "BodyView.hpp"
#include "CoulombCone.hpp"

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
	inRuns(packs.size(), [&](std::size_t i) {
		const BallPack& p = packs[i];
		for (int k = 0; k < packLanes; ++k) {
			if (p.id[k] < 0) continue;
			const Contact& c = contacts[p.id[k]];
			r[p.id[k]] = insideCone({p.impulse[0][k], p.impulse[1][k], p.impulse[2][k]}, c.normal, c.friction);
		}
	});
	inRuns(generals.size(), [&](std::size_t i) {
		const GeneralContact& g = generals[i];
		r[g.id] = insideCone(g.frame.transpose() * g.impulse, contacts[g.id].normal, g.friction);
	});
}

void GrainOperator::addImpulse(const Contact& c, const Vector3& impulse)
{
	const auto& bodies = problem->bodies;
	if (movable[c.body1]) {
		velocity(stateOf(c.body1)) -= bodies[c.body1].inverseMass.cwiseProduct(impulse);
		angularVelocity(stateOf(c.body1)) -= bodies[c.body1].inverseInertia * c.arm1.cross(impulse);
	}
	if (movable[c.body2]) {
		velocity(stateOf(c.body2)) += bodies[c.body2].inverseMass.cwiseProduct(impulse);
		angularVelocity(stateOf(c.body2)) += bodies[c.body2].inverseInertia * c.arm2.cross(impulse);
	}
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
		for (std::size_t g = chunk.firstGeneral; g < chunk.firstGeneral + chunk.generals; ++g) {
			const Contact& c = problem->contacts[generals[g].id];
			const Vector3 impulse = generals[g].frame.transpose() * generals[g].impulse;
			addImpulse(c, impulse);
			if (generals[g].rolling) addTorque(c, generals[g].rolling->torque);
			if (field) Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(field->moment) += impulse * (c.arm1 - c.arm2).transpose();
		}
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

/// Adds one contact of any kind to the sums.
/// @param W  with the compliance on its diagonal;  @param r  impulse; both in the frame
void GrainOperator::certify(const Contact& c, const Matrix3& frame, const Matrix3& W, const Vector3& r, Sums& total) const
{
	Vector3 u = frame * relativeVelocity(c) + Vector3(c.normalCompliance, c.tangentialCompliance, c.tangentialCompliance).cwiseProduct(r);
	u[0] += c.gapVelocity;
	total.approach = std::max(total.approach, -u[0]);
	if (u[0] >= 0 && r[0] <= 0) return; // open and separating: F = 0
	if (!(W(0, 0) > 0)) return;
	const auto F = naturalMap<Eigen::Vector2d>({r[0], r.tail<2>()}, {u[0], u.tail<2>()}, c.friction, W(0, 0), std::min(speedsAt(c), speedLimit));
	const Vector3 f(F.n, F.t[0], F.t[1]);
	total.residual.add(f.dot(W * f), r.dot(W * r));
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
	const std::size_t packRuns = runs(packs.size(), packsPerRun), generalRuns = runs(generals.size(), perRun);
	sums.assign(packRuns + generalRuns + runs(sleepers.size(), perRun), Sums{});
	share(sums.size(), [&](std::size_t k) {
		Sums& total = sums[k];
		if (k < packRuns) {
			const std::size_t first = k * packsPerRun, count = std::min(packsPerRun, packs.size() - first);
			const CertificateSums balls =
					kernels.certify(state.data(), packs.data() + first, rollingFrom(first), count, roundOff, hasField() ? L : nullptr);
			total.residual.add(balls.map2, balls.impulse2);
			total.approach = balls.approach;
		} else if (k < packRuns + generalRuns) {
			const std::size_t first = (k - packRuns) * perRun;
			for (std::size_t i = first; i < std::min(generals.size(), first + perRun); ++i) {
				const GeneralContact& g = generals[i];
				const Contact& c = problem->contacts[g.id];
				if (hasField()) // the W of the visits is another one, see startField()
					certify(c, g.frame, compliantDelassus(c, g.frame), g.impulse, total);
				else
					certify(c, g.frame, g.W, g.impulse, total);
				if (g.rolling) certify(*g.rolling, c, g.impulse[0], total);
			}
		} else {
			const std::size_t first = (k - packRuns - generalRuns) * perRun;
			for (std::size_t i = first; i < std::min(sleepers.size(), first + perRun); ++i) {
				const Sleeper& s = sleepers[i];
				if (normalVelocity(s) + s.offset >= 0) continue;
				const Contact& c = problem->contacts[s.id];
				const Matrix3 frame = contactFrame(c.normal);
				certify(c, frame, compliantDelassus(c, frame), Vector3::Zero(), total);
			}
		}
	});
	Sums total;
	for (const Sums& one : sums) {
		total.residual.add(one.residual);
		total.approach = std::max(total.approach, one.approach);
	}
	maxApproachSpeed = total.approach;
	return total.residual.value();
}

CrushedContacts GrainOperator::crushed(double tolerance) const
{
	CrushedContacts found(tolerance, largestFreeApproach);
	const auto look = [&](std::int32_t id, double uN, double rN) {
		if (!(rN > 0 && found.mayBe(uN))) return;
		const Contact& c = problem->contacts[id];
		const Body &b1 = problem->bodies[c.body1], &b2 = problem->bodies[c.body2]; // free velocities, until finish()
		Vector3 free = b2.velocity + c.imageVelocity - b1.velocity + b2.angularVelocity.cross(c.arm2) - b1.angularVelocity.cross(c.arm1);
		if (hasField()) free += problem->meanField->gradient * (c.arm1 - c.arm2);
		found.add(free.dot(c.normal) + c.gapVelocity, uN, rN, compliantDelassus(c, contactFrame(c.normal))(0, 0));
	};
	const auto at = [this](std::int32_t i) -> const BodyState& { return state[i < 0 ? ~i : i]; };
	for (const BallPack& p : packs)
		for (int k = 0; k < packLanes; ++k) {
			if (p.id[k] < 0) continue;
			const Vector3 n(p.normal[0][k], p.normal[1][k], p.normal[2][k]);
			const double rN = p.impulse[0][k] * n[0] + p.impulse[1][k] * n[1] + p.impulse[2][k] * n[2];
			const double field = hasField() ? (p.arm1[k] - p.arm2[k]) * n.dot(gradient * n) : 0;
			look(p.id[k], (velocity(at(p.body2[k])) - velocity(at(p.body1[k]))).dot(n) + p.gapVelocity[k] + field, rN);
		}
	for (const GeneralContact& g : generals) {
		const Contact& c = problem->contacts[g.id];
		look(g.id, relativeVelocity(c).dot(c.normal) + c.gapVelocity + c.normalCompliance * g.impulse[0], g.impulse[0]);
	}
	return found.any() && mayStandStill() ? CrushedContacts(tolerance, 0) : found;
}

/// Whether no contact closes when every body, and the mean field, stands still along all directions in which it can move.
bool GrainOperator::mayStandStill() const
{
	const auto given = [](const Vector3& v, const Vector3& mobility) -> Vector3 { return (mobility.array() == 0).select(v, Vector3::Zero()); };
	const auto at = [&](const Body& b, const Vector3& arm) -> Vector3 {
		return given(b.velocity, b.inverseMass) + given(b.angularVelocity, b.inverseInertia.diagonal()).cross(arm);
	};
	const Matrix3 still = hasField() ? problem->meanField->standingStill() : Matrix3(Matrix3::Zero());
	for (const Contact& c : problem->contacts) {
		const Vector3 u = at(problem->bodies[c.body2], c.arm2) + c.imageVelocity - at(problem->bodies[c.body1], c.arm1) + still * (c.arm1 - c.arm2);
		if (u.dot(c.normal) + c.gapVelocity < 0) return false;
	}
	return true;
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
