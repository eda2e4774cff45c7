// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <lib/base/Math.hpp>

namespace yade {

/// Point of the triangle a, b, c that is nearest to p. Works for degenerate triangles (then it is the nearest point of an edge).
Vector3r nearestOnTriangle(const Vector3r& p, const Vector3r& a, const Vector3r& b, const Vector3r& c);

} // namespace yade
