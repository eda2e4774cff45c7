// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <pkg/geometry/ConvexShape.hpp>

/// Signed distance of the convex hulls of two sets of points by CGAL, with exact arithmetic and none of our code: quadratic programming where they
/// are apart, the faces of the convex hull of all differences where they overlap.
double independentDistance(const std::vector<contactdynamics::Vector3>& one, const std::vector<contactdynamics::Vector3>& two);
