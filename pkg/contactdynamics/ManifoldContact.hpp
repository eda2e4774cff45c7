// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/Interaction.hpp>
#include <core/Scene.hpp>
#include <pkg/common/Wall.hpp>
#include <pkg/geometry/ConvexShape.hpp>

namespace yade {

/// ConvexShapes::of for body number `id` of a functor; null after an error has been reported (see DeferredError).
const contactdynamics::ConvexShape* convexShape(const Scene& scene, const Interaction& interaction, const shared_ptr<Shape>& shape, int id);

/// Body of the Ig2 functors for two convex polyhedra (Polyhedra, Box, Facet): creates or updates the interaction's ManifoldGeom. Errors are deferred.
/// @return  the functor's answer
bool updateManifold(const Scene& scene, Interaction& interaction, const shared_ptr<Shape>& shape1, const shared_ptr<Shape>& shape2,
					const State& state1, const State& state2, const Vector3r& shift2, bool force);

/// Gives a manifold of two convex polyhedra another direction, and the points that are seen along it.
/// @param normal  unit, from body 1 to body 2
/// @param beside  see findManifoldAlong() [m]
void turnManifold(const Scene& scene, Interaction& interaction, const Vector3r& normal, Real beside);

/// As updateManifold(), for a wall (body 1) and a Polyhedra or Box.
bool updateManifoldOnWall(const Scene& scene, Interaction& interaction, const Wall& wall, const shared_ptr<Shape>& shape2, const State& state1,
						  const State& state2, const Vector3r& shift2, bool force);

} // namespace yade
