// SPDX-License-Identifier: GPL-2.0-or-later
#include "ContactDynamicsTriaxialController.hpp"
#include "AdmittedValues.hpp"
#include "Gravity.hpp"
#include "MovableBodies.hpp"
#include "RefuseAttribute.hpp"
#include <core/Interaction.hpp>
#include <core/Scene.hpp>
#include <pkg/common/Box.hpp>
#include <pkg/common/NormShearPhys.hpp>
#include <pkg/common/Wall.hpp>
#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace yade {

YADE_PLUGIN((ContactDynamicsTriaxialController));

namespace {
/// Half the thickness of a wall along an axis [m], negative if the body is no wall across it.
Real halfThickness(const Shape* shape, int axis)
{
	if (const auto* box = dynamic_cast<const Box*>(shape)) return box->extents[axis];
	const auto* plane = dynamic_cast<const Wall*>(shape);
	return plane && plane->axis == axis ? 0 : -1;
}
} // namespace

void ContactDynamicsTriaxialController::requireAdmissible() const
{
	std::ostringstream list;
	for (const int id : walls) list << (list.tellp() > 0 ? ", " : "") << '#' << id;
	vector<int> sorted = walls;
	std::sort(sorted.begin(), sorted.end());
	const bool different = std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
	if (!sorted.empty() && !(sorted.size() == 6 && different && sorted[0] >= 0))
		refuseAttribute("ContactDynamicsTriaxialController.walls", list.str(),
						"it must be six different ids of bodies, those at -x, +x, -y, +y, -z and +z");
	for (int axis = 0; axis < 3; axis++) {
		if (!(stress[axis] <= 0 && std::isfinite(stress[axis])))
			refuseAttribute("ContactDynamicsTriaxialController.stress", stress.transpose(),
							"each must be finite and not positive (compression is negative)");
		if (!std::isfinite(strainRate[axis]))
			refuseAttribute("ContactDynamicsTriaxialController.strainRate", strainRate.transpose(), "each must be finite");
	}
	if (stressMask < 0 || stressMask > 7)
		refuseAttribute("ContactDynamicsTriaxialController.stressMask", stressMask, "it must be a sum of 1 (x), 2 (y), 4 (z)");
	if (!(wallMass >= 0 && std::isfinite(wallMass)))
		refuseAttribute("ContactDynamicsTriaxialController.wallMass", wallMass, "it must be finite and not negative (0: from the bodies)");
	if (!(maxStrainRate > 0)) refuseAttribute("ContactDynamicsTriaxialController.maxStrainRate", maxStrainRate, "it must be positive");
	if (!(referenceSize.allFinite() && (referenceSize.minCoeff() > 0 || referenceSize == Vector3r::Zero())))
		refuseAttribute("ContactDynamicsTriaxialController.referenceSize", referenceSize.transpose(), "all must be positive and finite, or all 0");
}

void ContactDynamicsTriaxialController::postLoad(ContactDynamicsTriaxialController&)
{
	const Real before = std::get<4>(admitted);
	admit(attributes(), admitted, [this] { requireAdmissible(); });
	if (wallMass == 0 && before > 0) wallMassInUse = 0; // to be taken from the bodies again; what a scene was saved with is kept
}

const Body& ContactDynamicsTriaxialController::wall(const Scene& ofScene, int place) const
{
	const int id = walls[place];
	const Body* body = id < static_cast<int>(ofScene.bodies->size()) ? (*ofScene.bodies)[id].get() : nullptr;
	if (!body || halfThickness(body->shape.get(), place / 2) < 0)
		throw std::runtime_error("ContactDynamicsTriaxialController.walls: body #" + std::to_string(id) +
								 (body ? " is no Box or Wall perpendicular to " : " does not exist; needed is the wall perpendicular to ") +
								 "xyz"[place / 2] + ".");
	return *body;
}

Vector3r ContactDynamicsTriaxialController::measureSize(const Scene& ofScene) const
{
	Vector3r edges;
	for (int axis = 0; axis < 3; axis++) {
		const Body &low = wall(ofScene, 2 * axis), &high = wall(ofScene, 2 * axis + 1);
		edges[axis] = high.state->pos[axis] - low.state->pos[axis] - halfThickness(high.shape.get(), axis) - halfThickness(low.shape.get(), axis);
		if (!(edges[axis] > 0))
			throw std::runtime_error("ContactDynamicsTriaxialController: the box has the length " + std::to_string(edges[axis]) + " along " +
									 "xyz"[axis] + ", between the walls #" + std::to_string(low.getId()) + " and #" + std::to_string(high.getId()) +
									 "; it must be positive.");
	}
	return edges;
}

/// Mass that the step is made with; 0 if it is to come from the bodies and none is movable.
Real ContactDynamicsTriaxialController::massFor(const Scene& ofScene) const
{
	if (wallMass > 0) return wallMass;
	if (wallMassInUse > 0) return wallMassInUse;
	const auto grains = MovableBodies::of(ofScene, [this](const Body& body) { return std::count(walls.begin(), walls.end(), body.getId()) == 0; });
	return grains.mass > 0 ? 0.1 * grains.mass / std::cbrt(grains.count) : 0;
}

std::vector<ContactDynamicsTriaxialController::Outlook> ContactDynamicsTriaxialController::outlook(const Scene& ofScene) const
{
	const Real mass = massFor(ofScene);
	if (walls.size() != 6 || !(mass > 0)) return {};
	Vector3r edges;
	try {
		edges = measureSize(ofScene);
	} catch (const std::runtime_error&) {
		return {};
	}
	std::vector<Outlook> coming;
	for (int axis = 0; axis < 3; axis++) {
		const Body& body = wall(ofScene, 2 * axis + 1);
		if (!(stressMask & (1 << axis))) {
			coming.push_back({body.getId(), std::abs(strainRate[axis]) * edges[axis], 0});
			continue;
		}
		const Real push = -stress[axis] * edges[(axis + 1) % 3] * edges[(axis + 2) % 3], speed = std::abs(body.state->vel[axis]);
		const Real faster = speed + ofScene.dt * std::abs(push - resistance(body, axis)) / mass;
		coming.push_back({body.getId(), std::max(speed, std::min(faster, maxStrainRate * edges[axis])), push / mass});
	}
	return coming;
}

/// What the grains pushed it with in the last step, along the axis [N].
Real ContactDynamicsTriaxialController::resistance(const Body& body, int axis)
{
	Real sum = 0;
	for (const auto& other : body.intrs) {
		if (!other.second->isReal()) continue;
		const auto* phys = dynamic_cast<const NormShearPhys*>(other.second->phys.get());
		if (phys) sum += (other.second->getId2() == body.getId() ? 1 : -1) * (phys->normalForce[axis] + phys->shearForce[axis]);
	}
	return sum;
}

/// Force along the axis, for the area across it, and at most what leads to the bound on the rate while the grains resist twice as much as they did.
void ContactDynamicsTriaxialController::press(int axis, Real area)
{
	const Body& body = wall(*scene, 2 * axis + 1);
	State& state = *body.state;
	state.blockedDOFs = State::DOF_ALL & ~State::axisDOF(axis);
	state.mass = wallMassInUse;
	const Real fastest = maxStrainRate * size[axis], h = scene->dt;
	const Real lightest = 4 * h * h * std::abs(stress[axis]) * area / size[axis];
	if (wallMassInUse < lightest) {
		std::ostringstream message;
		message << "ContactDynamicsTriaxialController.wallMass: with " << wallMassInUse << " kg, wall #" << body.getId()
				<< " would be carried by its force over more than a quarter of the box in one step of O.dt = " << h
				<< " as soon as nothing resists; at least " << lightest << " kg are needed, or a smaller O.dt.";
		throw std::runtime_error(message.str());
	}
	// Without the resistance a light wall would never be pressed with more than its own mass can take in a step, however slowly it moves. Twice:
	// then the force grows to the goal within a few steps, and what grains that settle take off for a moment does not weaken the next step.
	const Real force = std::max(stress[axis] * area, wallMassInUse * (-fastest - state.vel[axis]) / h - 2 * resistance(body, axis));
	Vector3r total = Vector3r::Zero();
	total[axis] = force - wallMassInUse * gravityOf(*scene)[axis];
	scene->forces.addForce(body.getId(), total);
}

void ContactDynamicsTriaxialController::drive(int axis)
{
	State& state = *wall(*scene, 2 * axis + 1).state;
	state.blockedDOFs = State::DOF_ALL;
	state.vel = Vector3r::Zero();
	state.vel[axis] = size[axis] * std::expm1(strainRate[axis] * scene->dt) / scene->dt;
}

void ContactDynamicsTriaxialController::action()
{
	requireAdmissible(); // again: Python writes single components of a vector past postLoad()
	if (walls.empty())
		throw std::runtime_error("ContactDynamicsTriaxialController.walls is empty: it must be six ids. contactdynamics.triaxial.box() builds them.");
	size = measureSize(*scene);
	wallMassInUse = massFor(*scene);
	if (!(wallMassInUse > 0))
		throw std::runtime_error(
				"ContactDynamicsTriaxialController.wallMass = 0: it cannot be taken from the bodies, because none is movable and has mass.");
	if (referenceSize == Vector3r::Zero()) std::get<6>(admitted) = referenceSize = size;
	for (int axis = 0; axis < 3; axis++) {
		strain[axis] = std::log(size[axis] / referenceSize[axis]);
		State& held = *wall(*scene, 2 * axis).state;
		held.blockedDOFs = State::DOF_ALL;
		held.vel = held.angVel = Vector3r::Zero();
		if (stressMask & (1 << axis))
			press(axis, size[(axis + 1) % 3] * size[(axis + 2) % 3]);
		else
			drive(axis);
	}
}

} // namespace yade
