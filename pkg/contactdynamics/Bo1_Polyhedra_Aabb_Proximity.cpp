// SPDX-License-Identifier: GPL-2.0-or-later
#include "Bo1_Polyhedra_Aabb_Proximity.hpp"
#include "DeferredError.hpp"
#include <core/Cell.hpp>
#include <core/Scene.hpp>

namespace yade {

YADE_PLUGIN((Bo1_Polyhedra_Aabb_Proximity));

// Not Bo1_Polyhedra_Aabb: it works the hull out anew when a saved scene is loaded, and may shift the vertices by round-off then.
void Bo1_Polyhedra_Aabb_Proximity::bound(const shared_ptr<Shape>& shape, shared_ptr<Bound>& bound, const Se3r& se3, const Body* body)
{
	if (!bound) bound = shared_ptr<Aabb>(new Aabb);
	bound->min = bound->max = se3.position;
	const auto& vertices = static_cast<const Polyhedra&>(*shape).v;
	if (vertices.empty())
		DeferredError::report(scene, body->getId(), body->getId(),
							  "body #" + std::to_string(body->getId()) +
									  ": Polyhedra.v has no vertices; make the body with polyhedra_utils.polyhedra, or call shape.Initialize().");
	const Matrix3r rotation = se3.orientation.toRotationMatrix();
	const bool sheared = scene->isPeriodic && scene->cell->hasShear();
	for (std::size_t i = 0; i < vertices.size(); i++) {
		Vector3r place = rotation * vertices[i] + se3.position;
		if (sheared) place = scene->cell->unshearPt(place);
		bound->min = i == 0 ? place : Vector3r(bound->min.cwiseMin(place));
		bound->max = i == 0 ? place : Vector3r(bound->max.cwiseMax(place));
	}
}

} // namespace yade
