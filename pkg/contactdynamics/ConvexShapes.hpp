// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/Body.hpp>
#include <pkg/geometry/ConvexShape.hpp>

namespace yade {

/// Vertices, faces and edges of YADE's shapes, worked out when a shape is first met and again when its vertices change.
namespace ConvexShapes {
/// Of a Polyhedra, Box or Facet. Thread-safe; what is returned stays valid while the shape exists and is not changed.
/// @throws std::invalid_argument  the shape has no volume (a facet: no area) or is not finite; the message names the attribute
const contactdynamics::ConvexShape& of(const shared_ptr<Shape>& shape);
} // namespace ConvexShapes

} // namespace yade
