// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "PlacedShape.hpp"

namespace contactdynamics {

/// Whether the foot of the perpendicular from `point` on a face lies inside of it.
bool isAboveFace(const PlacedShape& shape, std::size_t face, const Vector3& point);

/// Point of the segment a b that is nearest to p.
Vector3 nearestOnSegment(const Vector3& p, const Vector3& a, const Vector3& b);

/// Nearest point of the surface of a convex polyhedron, and the signed distance of `point` from it.
struct SurfacePoint {
	double distance; ///< < 0 inside [m]
	Vector3 place;
	Vector3 normal; ///< unit, outward; from `place` to an outer point
};
SurfacePoint nearestOnSurface(const PlacedShape& shape, const Vector3& point);

} // namespace contactdynamics
