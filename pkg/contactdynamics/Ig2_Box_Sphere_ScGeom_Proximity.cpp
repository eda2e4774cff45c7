// SPDX-License-Identifier: GPL-2.0-or-later
#include "Ig2_Box_Sphere_ScGeom_Proximity.hpp"
#include "ProximityGeometry.hpp"
#include <core/Scene.hpp>

namespace yade {

YADE_PLUGIN((Ig2_Box_Sphere_ScGeom_Proximity));

bool Ig2_Box_Sphere_ScGeom_Proximity::go(const shared_ptr<Shape>& shape1, const shared_ptr<Shape>& shape2, const State& state1, const State& state2,
										 const Vector3r& shift2, const bool& force, const shared_ptr<Interaction>& interaction)
{
	const Vector3r& extents = static_cast<const Box&>(*shape1).extents;
	const Real radius = static_cast<const Sphere&>(*shape2).radius;
	const Vector3r centre = state1.ori.conjugate() * (state2.pos + shift2 - state1.pos); // of the sphere, in the box's axes

	Vector3r onBox = centre.cwiseMax(-extents).cwiseMin(extents);
	Vector3r normal = centre - onBox;
	const Real distance = normal.norm();
	Real gap = distance - radius;
	if (distance > 0) {
		normal /= distance;
	} else { // centre inside the box or on its face: out through the nearest face
		int face;
		const Real depth = (extents - centre.cwiseAbs()).minCoeff(&face);
		normal = Vector3r::Zero();
		normal[face] = centre[face] < 0 ? -1 : 1;
		onBox[face] = normal[face] * extents[face];
		gap = -depth - radius;
	}
	if (beyondReach(*scene, *interaction, gap, force) || lacksMaterial(*scene, *interaction)) return false;
	return updateScGeom(*scene, interaction, state1, state2, shift2, {state1.pos + state1.ori * onBox, state1.ori * normal, gap, radius, radius},
						!(distance > 0));
}

} // namespace yade
