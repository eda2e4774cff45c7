// SPDX-License-Identifier: GPL-2.0-or-later
#include "LargestRates.hpp"
#include "ContactDynamicsCellController.hpp"
#include "ContactDynamicsTriaxialController.hpp"
#include <core/Scene.hpp>
#include <pkg/common/Sphere.hpp>
#include <pkg/dem/NewtonIntegrator.hpp>
#include <algorithm>
#include <cmath>

namespace yade {
namespace {
void raise(Real& largest, Real value)
{
	if (std::isfinite(value)) largest = std::max(largest, value);
}
} // namespace

LargestRates::LargestRates(const Scene& scene)
{
	Real gravity = 0;
	for (const auto& engine : scene.engines) {
		const auto* newton = dynamic_cast<const NewtonIntegrator*>(engine.get());
		if (newton && !newton->dead) raise(gravity, newton->gravity.norm());
	}
	ForceContainer& forces = const_cast<Scene&>(scene).forces; // YADE's getters are not const
	const bool permForces = forces.getPermForceUsed();
	for (const auto& body : *scene.bodies) {
		const State& state = *body->state;
		if (const auto* sphere = dynamic_cast<const Sphere*>(body->shape.get()))
			if (sphere->radius > 0) smallestRadius = smallestRadius > 0 ? std::min(smallestRadius, sphere->radius) : sphere->radius;
		raise(speed, (scene.isPeriodic ? Vector3r(state.vel - scene.cell->velGrad * state.pos) : state.vel).norm());
		raise(rotation, state.angVel.norm());
		if (!body->isDynamic() || body->isClumpMember()) continue;
		raise(acceleration, gravity + (permForces && state.mass > 0 ? forces.getPermForce(body->getId()).norm() / state.mass : 0));
	}
	Real strain = scene.isPeriodic ? scene.cell->velGrad.norm() : 0, straining = 0;
	for (const auto& engine : scene.engines) {
		if (const auto* cell = dynamic_cast<const ContactDynamicsCellController*>(engine.get()); cell && !cell->dead) {
			const auto coming = cell->outlook(scene);
			raise(strain, coming.rate);
			raise(straining, coming.acceleration);
		}
		if (const auto* box = dynamic_cast<const ContactDynamicsTriaxialController*>(engine.get()); box && !box->dead)
			for (const auto& wall : box->outlook(scene)) {
				raise(speed, wall.speed);
				raise(acceleration, wall.acceleration);
			}
	}
	raise(rotation, strain);
	// Two touching bodies part or meet by the strain times the sum of their radii; each of them gets its own.
	raise(speed, speed + strain * smallestRadius);
	raise(acceleration, acceleration + straining * smallestRadius);
}

} // namespace yade
