// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <array>
#include <core/Body.hpp>
#include <memory>
#include <pkg/geometry/PlacedShape.hpp>

namespace yade {

/// The body of a boundary as a convex set: a facet, a box, a wall or a polyhedron, placed relative to a point of the caller's choice.
class Surface {
public:
	Surface() = default;
	/// @param origin  place of the body's position in the caller's axes (those of the scene, shifted) [m]
	/// @throws std::logic_error  for another shape
	Surface(const shared_ptr<Shape>& shape, const State& state, const Vector3r& origin);

	/// False only when p is farther than `close` from the set; much cheaper than nearest().
	bool mayBeWithin(const Vector3r& p, Real close) const { return ((p - low).array() >= -close).all() && ((p - high).array() <= close).all(); }
	Vector3r nearest(const Vector3r& p) const; ///< point of the set that is nearest to p; p itself inside of a box or polyhedron
	/// How far the set reaches in the direction of the unit vector n: the largest n·x of its points; infinite for most directions of a wall.
	Real extent(const Vector3r& n) const;
	/// Largest distance from the origin of the caller's axes of what can be compared with it to round-off [m].
	Real size() const;
	bool isFacet() const { return kind == Kind::facet; }
	Vector3r faceNormal() const; ///< of a facet, unit; zero when its area vanishes
	/// Whether p, a point of a facet, lies on one of its edges, more than `close` away from both ends.
	bool insideEdge(const Vector3r& p, Real close) const;

private:
	enum class Kind { facet, box, wall, polyhedron } kind = Kind::facet;
	std::array<Vector3r, 3> corners; // facet: its corners; box: its half edges, as vectors; wall: the first is the normal
	Vector3r centre;				 // of box, wall and polyhedron
	std::shared_ptr<const contactdynamics::PlacedShape> polyhedron;
	Vector3r low, high; // corners of an upright box around the set
};

} // namespace yade
