// SPDX-License-Identifier: GPL-2.0-or-later
#include "LargestRates.hpp"
#include "BodySize.hpp"
#include "ContactDynamicsCellController.hpp"
#include "ContactDynamicsTriaxialController.hpp"
#include "ConvexShapes.hpp"
#include "Gravity.hpp"
#include <core/Scene.hpp>
#include <pkg/common/Box.hpp>
#include <pkg/polyhedra/Polyhedra.hpp>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace yade {
namespace {
void raise(Real& largest, Real value)
{
	if (std::isfinite(value)) largest = std::max(largest, value);
}

/// Of a sphere the radius, of a polyhedron the distance of its nearest face, of a box that can move half of its thickness (other boxes are walls); 0
/// for other shapes, and for those that the search for contacts refuses.
Real innerRadius(const Body& body)
{
	if (const Sphere* sphere = asSphere(body.shape.get())) return sphere->radius;
	if (const auto* box = dynamic_cast<const Box*>(body.shape.get())) return body.isDynamic() || body.isClumpMember() ? box->extents.minCoeff() : 0;
	if (!dynamic_cast<const Polyhedra*>(body.shape.get())) return 0;
	try {
		const auto& faces = ConvexShapes::of(body.shape).faces;
		return std::min_element(faces.begin(), faces.end(), [](const auto& a, const auto& b) { return a.offset < b.offset; })->offset;
	} catch (const std::invalid_argument&) {
		return 0;
	}
}
} // namespace

LargestRates::LargestRates(const Scene& scene)
{
	Real gravity = 0;
	raise(gravity, gravityOf(scene).norm());
	ForceContainer& forces = const_cast<Scene&>(scene).forces; // YADE's getters are not const
	const bool permForces = forces.getPermForceUsed();
	for (const auto& body : *scene.bodies) {
		const State& state = *body->state;
		if (const Real radius = innerRadius(*body); radius > 0) smallestRadius = smallestRadius > 0 ? std::min(smallestRadius, radius) : radius;
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
