// SPDX-License-Identifier: GPL-2.0-or-later
#include "Ig2_Sphere_Polyhedra_ScGeom_Proximity.hpp"
#include "ManifoldContact.hpp"
#include "ProximityGeometry.hpp"
#include <pkg/geometry/PointDistance.hpp>

namespace yade {

YADE_PLUGIN((Ig2_Sphere_Polyhedra_ScGeom_Proximity));

bool Ig2_Sphere_Polyhedra_ScGeom_Proximity::go(const shared_ptr<Shape>& shape1, const shared_ptr<Shape>& shape2, const State& state1,
											   const State& state2, const Vector3r& shift2, const bool& force,
											   const shared_ptr<Interaction>& interaction)
{
	const Real radius = static_cast<const Sphere&>(*shape1).radius;
	const Vector3r centre = state1.pos - state2.pos - shift2; // of the sphere, from the position of the polyhedron
	if (!centre.allFinite() || !state2.ori.coeffs().allFinite()) return false;
	const auto* convex = convexShape(*scene, *interaction, shape2, interaction->getId2());
	if (!convex || beyondReach(*scene, *interaction, centre.norm() - radius - convex->radius, force)) return false;
	static thread_local contactdynamics::PlacedShape polyhedron;
	polyhedron.place(*convex, state2.ori.toRotationMatrix(), Vector3r::Zero());
	const contactdynamics::SurfacePoint nearest = nearestOnSurface(polyhedron, centre);
	const Real gap = nearest.distance - radius;
	if (beyondReach(*scene, *interaction, gap, force) || lacksMaterial(*scene, *interaction)) return false;
	return updateScGeom(*scene, interaction, state1, state2, shift2, {state1.pos - radius * nearest.normal, -nearest.normal, gap, radius, radius});
}

} // namespace yade
