// SPDX-License-Identifier: GPL-2.0-or-later
#include "Ig2_Wall_Sphere_ScGeom_Proximity.hpp"
#include "ProximityGeometry.hpp"
#include <core/Scene.hpp>

namespace yade {

YADE_PLUGIN((Ig2_Wall_Sphere_ScGeom_Proximity));

bool Ig2_Wall_Sphere_ScGeom_Proximity::go(const shared_ptr<Shape>& shape1, const shared_ptr<Shape>& shape2, const State& state1, const State& state2,
										  const Vector3r& shift2, const bool& force, const shared_ptr<Interaction>& interaction)
{
	const Wall& wall = static_cast<const Wall&>(*shape1);
	const Real radius = static_cast<const Sphere&>(*shape2).radius;
	const Vector3r centre = state2.pos + shift2;
	const Real distance = centre[wall.axis] - state1.pos[wall.axis];
	const Real side = wall.sense != 0 ? wall.sense : (distance < 0 ? -1 : 1);
	const Real gap = side * distance - radius;
	// A sphere wholly behind a one-sided wall is not held by it; one that is partly through is pushed back to the side the wall acts on.
	if (wall.sense != 0 && !interaction->isReal() && !force && gap < -2 * radius) return false;
	if (beyondReach(*scene, *interaction, gap, force) || lacksMaterial(*scene, *interaction)) return false;
	Vector3r normal = Vector3r::Zero();
	normal[wall.axis] = side;
	Vector3r onWall = centre;
	onWall[wall.axis] = state1.pos[wall.axis];
	return updateScGeom(*scene, interaction, state1, state2, shift2, {onWall, normal, gap, radius, radius}, true);
}

} // namespace yade
