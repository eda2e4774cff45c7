// SPDX-License-Identifier: GPL-2.0-or-later
#include "Ig2_Sphere_Sphere_ScGeom_Proximity.hpp"
#include "ProximityGeometry.hpp"
#include <core/Scene.hpp>

namespace yade {

YADE_PLUGIN((Ig2_Sphere_Sphere_ScGeom_Proximity));

bool Ig2_Sphere_Sphere_ScGeom_Proximity::go(const shared_ptr<Shape>& shape1, const shared_ptr<Shape>& shape2, const State& state1,
											const State& state2, const Vector3r& shift2, const bool& force,
											const shared_ptr<Interaction>& interaction)
{
	prefetchComing(*scene, *interaction);
	const Real r1 = static_cast<const Sphere&>(*shape1).radius;
	const Real r2 = static_cast<const Sphere&>(*shape2).radius;
	const Vector3r branch = state2.pos + shift2 - state1.pos;
	const Real distance = branch.norm();
	const Real gap = distance - r1 - r2;
	if (beyondReach(*scene, *interaction, gap, force) || lacksMaterial(*scene, *interaction)) return false;
	// Concentric spheres have no normal of their own; any fixed one is as good, and NaN is not.
	const Vector3r normal = distance > 0 ? Vector3r(branch / distance) : Vector3r(Vector3r::UnitZ());
	return updateScGeom(*scene, interaction, state1, state2, shift2, {state1.pos + r1 * normal, normal, gap, r1, r2}, distance > 0);
}

} // namespace yade
