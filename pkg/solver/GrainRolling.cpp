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

/// From the packs, where the sweeps leave them.
void GrainOperator::collectTorques()
{
	const auto take = [this](const auto& from, const PackList<RollingPack>& torques) {
		inRuns(torques.size(), [&](std::size_t i) {
			for (int lane = 0; lane < packLanes; ++lane)
				if (RollingContact* rolling = from[i].id[lane] < 0 ? nullptr : rollingAt(from[i].id[lane])) rolling->take(torques[i], lane);
		});
	};
	take(packs, rollingPacks);
	take(generals, rollingGenerals);
}

void GrainOperator::addTorque(const Contact& c, const Vector3& torque)
{
	if (movable[c.body1]) angularVelocity(stateOf(c.body1)) -= problem->bodies[c.body1].inverseInertia * torque;
	if (movable[c.body2]) angularVelocity(stateOf(c.body2)) += problem->bodies[c.body2].inverseInertia * torque;
}

} // namespace contactdynamics
