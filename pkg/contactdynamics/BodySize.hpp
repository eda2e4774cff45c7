// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/Body.hpp>
#include <pkg/common/Sphere.hpp>
#include <typeinfo>

namespace yade {

/// Null for any other shape and for none. Most shapes are spheres: those are told without a walk through the bases.
inline const Sphere* asSphere(const Shape* shape)
{
	return shape && typeid(*shape) == typeid(Sphere) ? static_cast<const Sphere*>(shape) : dynamic_cast<const Sphere*>(shape);
}

/// Largest distance of a vertex of a Polyhedra from the body's position [m]; 0 for any other shape.
Real polyhedronRadius(const Shape& shape);

/// Radius of a sphere, or of the ball around a polyhedron [m]; 0 for any other shape and for none.
Real grainRadius(const Body& body);

/// Length of a sphere, polyhedron or box along a direction [m]; 0 for any other shape and for none.
/// @param direction  unit, global axes
Real extentAlong(const Body& body, const Vector3r& direction);

} // namespace yade
