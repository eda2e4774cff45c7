// SPDX-License-Identifier: GPL-2.0-or-later
// Rolling and twisting friction of a problem: the torques that go with some of its contacts.
#include "GrainOperator.hpp"

#include "BodyView.hpp"

namespace contactdynamics {

void GrainOperator::startRolling()
{
	const auto& given = problem->rolling;
	rollingContacts.resize(given.size());
	rollingOf.assign(given.empty() ? 0 : problem->contacts.size(), -1);
	for (std::size_t k = 0; k < given.size(); ++k) {
		rollingContacts[k] = RollingContact(given[k], *problem);
		rollingOf[given[k].contact] = std::int32_t(k);
	}
}

/// Torques within the limits that the impulses set, and the angular velocities that they give.
void GrainOperator::beginAtTorques()
{
	for (std::size_t k = 0; k < rollingContacts.size(); ++k) {
		const std::int32_t id = problem->rolling[k].contact;
		const Contact& c = problem->contacts[id];
		RollingContact& rolling = rollingContacts[k];
		const Vector3 torque = rolling.inside(rolling.torque, c.normal, impulses[id].dot(c.normal));
		rolling.stop();
		rolling.torque = torque;
		addTorque(c, torque);
	}
}

/// From the packs, where the sweeps leave those of balls, to where those of the other contacts are.
void GrainOperator::collectTorques()
{
	inRuns(rollingPacks.size(), [&](std::size_t i) {
		for (int lane = 0; lane < packLanes; ++lane)
			if (RollingContact* rolling = packs[i].id[lane] < 0 ? nullptr : rollingAt(packs[i].id[lane])) rolling->take(rollingPacks[i], lane);
	});
}

void GrainOperator::addTorque(const Contact& c, const Vector3& torque)
{
	if (movable[c.body1]) angularVelocity(stateOf(c.body1)) -= problem->bodies[c.body1].inverseInertia * torque;
	if (movable[c.body2]) angularVelocity(stateOf(c.body2)) += problem->bodies[c.body2].inverseInertia * torque;
}

/// Adds the torque of one contact to the sums, see NaturalMap.hpp. Round-off needs no bound here, because torques do not grow beyond their limits.
void GrainOperator::certify(const RollingContact& rolling, const Contact& c, double normalImpulse, Sums& total) const
{
	const Vector3 &w1 = angularVelocity(stateOf(c.body1)), &w2 = angularVelocity(stateOf(c.body2));
	const Vector3 F = rolling.torque - rolling.improved(rolling.torque, w2 - w1, c.normal, normalImpulse);
	const double speeds = w1.cwiseAbs().sum() + w2.cwiseAbs().sum() + rolling.drive.cwiseAbs().sum();
	const bool isRoundOff = F.norm() <= rolling.inverseMobility * roundOffOf(speeds);
	total.residual.add(isRoundOff ? 0 : rolling.mobility * F.squaredNorm(), rolling.mobility * rolling.torque.squaredNorm());
}

} // namespace contactdynamics
