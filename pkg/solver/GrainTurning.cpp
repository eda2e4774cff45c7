// SPDX-License-Identifier: GPL-2.0-or-later
// Rolling and twisting friction of a problem: the torques that go with some of its contacts.
#include "GrainOperator.hpp"

#include "BodyView.hpp"

namespace contactdynamics {

void GrainOperator::startTurning()
{
	const auto& given = problem->rolling;
	turning.resize(given.size());
	turningOf.assign(given.empty() ? 0 : problem->contacts.size(), -1);
	for (std::size_t k = 0; k < given.size(); ++k) {
		const Contact& c = problem->contacts[given[k].contact];
		turning[k] = RollingContact(given[k], problem->bodies[c.body1], problem->bodies[c.body2]);
		turningOf[given[k].contact] = std::int32_t(k);
	}
}

/// Torques within the limits that the impulses set, and the angular velocities that they give.
void GrainOperator::beginAtTorques()
{
	for (std::size_t k = 0; k < turning.size(); ++k) {
		const std::int32_t id = problem->rolling[k].contact;
		const Contact& c = problem->contacts[id];
		const Vector3 torque = turning[k].inside(turning[k].torque, c.normal, impulses[id].dot(c.normal));
		turning[k].stop();
		turning[k].torque = torque;
		addTorque(c, torque);
	}
}

void GrainOperator::putTurning(RollingPack& pack, int lane, std::int32_t id) const
{
	const RollingContact& turn = turning[turningOf[id]];
	pack.rollingArm[lane] = turn.rollingArm;
	pack.twistingArm[lane] = turn.twistingArm;
	pack.inverseW[lane] = turn.inverseW;
	for (int k = 0; k < 3; ++k) {
		pack.drive[k][lane] = turn.drive[k];
		pack.torque[k][lane] = turn.torque[k];
		pack.increment[k][lane] = turn.increment[k];
		pack.direction[k][lane] = turn.direction[k];
	}
}

/// From the packs, where the sweeps leave those of balls, to where those of the other contacts are.
void GrainOperator::collectTorques()
{
	inRuns(rollingPacks.size(), [&](std::size_t i) {
		const RollingPack& pack = rollingPacks[i];
		for (int lane = 0; lane < 4; ++lane) {
			RollingContact* turn = packs[i].id[lane] < 0 ? nullptr : turningAt(packs[i].id[lane]);
			if (!turn) continue;
			for (int k = 0; k < 3; ++k) {
				turn->torque[k] = pack.torque[k][lane];
				turn->increment[k] = pack.increment[k][lane];
				turn->direction[k] = pack.direction[k][lane];
			}
		}
	});
}

void GrainOperator::addTorque(const Contact& c, const Vector3& torque)
{
	if (movable[c.body1]) angularVelocity(stateOf(c.body1)) -= problem->bodies[c.body1].inverseInertia * torque;
	if (movable[c.body2]) angularVelocity(stateOf(c.body2)) += problem->bodies[c.body2].inverseInertia * torque;
}

/// Adds the torque of one contact to the sums: with the natural map M - P(M - w / W_w), W_w-weighted as those of the impulses are.
void GrainOperator::certify(const RollingContact& turn, const Contact& c, double normalImpulse, Sums& total) const
{
	if (!(turn.inverseW > 0)) return;
	const Vector3 &w1 = angularVelocity(stateOf(c.body1)), &w2 = angularVelocity(stateOf(c.body2));
	const Vector3 F = turn.torque - turn.improved(turn.torque, w2 - w1, c.normal, normalImpulse);
	const double speeds = w1.cwiseAbs().sum() + w2.cwiseAbs().sum() + turn.drive.cwiseAbs().sum();
	const bool isRoundOff = F.norm() <= turn.inverseW * roundOffOf(speeds);
	total.residual.add(isRoundOff ? 0 : F.dot(turn.W * F), turn.torque.dot(turn.W * turn.torque));
}

} // namespace contactdynamics
