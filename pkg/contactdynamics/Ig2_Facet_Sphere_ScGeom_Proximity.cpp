// SPDX-License-Identifier: GPL-2.0-or-later
#include "Ig2_Facet_Sphere_ScGeom_Proximity.hpp"
#include "ProximityGeometry.hpp"
#include "Triangle.hpp"
#include <core/Scene.hpp>

namespace yade {

YADE_PLUGIN((Ig2_Facet_Sphere_ScGeom_Proximity));

bool Ig2_Facet_Sphere_ScGeom_Proximity::go(const shared_ptr<Shape>& shape1, const shared_ptr<Shape>& shape2, const State& state1, const State& state2,
										   const Vector3r& shift2, const bool& force, const shared_ptr<Interaction>& interaction)
{
	const Facet& facet = static_cast<const Facet&>(*shape1);
	const Real radius = static_cast<const Sphere&>(*shape2).radius;
	const Vector3r centre = state1.ori.conjugate() * (state2.pos + shift2 - state1.pos); // of the sphere, in the facet's axes
	const Vector3r onFacet = nearestOnTriangle(centre, facet.vertices[0], facet.vertices[1], facet.vertices[2]);
	const Real distance = (centre - onFacet).norm();
	const Real gap = distance - radius;
	if (beyondReach(*scene, *interaction, gap, force) || lacksMaterial(*scene, *interaction)) return false;
	// A centre that lies in the facet has two normals; the facet's own is taken.
	const Vector3r normal = distance > 0 ? Vector3r((centre - onFacet) / distance) : facet.normal;
	return updateScGeom(*scene, interaction, state1, state2, shift2,
						{state1.pos + state1.ori * onFacet, state1.ori * normal, gap, 2 * radius, radius});
}

} // namespace yade
