// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "PlacedShape.hpp"

namespace contactdynamics {

struct ClosestPoints {
	double distance; ///< [m]
	Vector3 on1, on2;
};

/// Nearest points of two convex polyhedra that are apart: the smallest of all distances between a vertex of one and a face of the other, and between
/// two edges.
/// @param normal, gap  a direction that parts them by `gap` > 0. A vertex that lies deeper behind that plane than the best distance so far allows
///                     is left out, which mostly leaves a handful of features.
ClosestPoints closestPoints(const PlacedShape& one, const PlacedShape& two, const Vector3& normal, double gap);

} // namespace contactdynamics
