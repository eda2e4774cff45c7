// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

namespace contactdynamics {

using Vector3 = Eigen::Vector3d;

/// A convex polyhedron in its own frame. A plate is one, too: a prism without thickness.
struct ConvexShape {
	struct Face {
		Vector3 normal = Vector3::Zero();  ///< unit, outward
		double offset = 0;				   ///< largest normal.x over all vertices of the shape [m]
		std::int32_t first = 0, count = 0; ///< its corners are loops[first] ... loops[first + count - 1], anticlockwise seen from outside
	};
	struct Edge {
		std::int32_t from, to;	  ///< vertices
		std::int32_t left, right; ///< faces; `left` has the edge in the direction from -> to
	};

	std::vector<Vector3> vertices; ///< [m]
	std::vector<std::int32_t> loops;
	std::vector<Face> faces;
	std::vector<Edge> edges;
	double radius = 0; ///< largest distance of a vertex from the origin [m]

	/// Fills offsets, edges and radius from vertices, loops and the normals of the faces.
	/// @throws std::invalid_argument  when the faces do not close a surface
	void complete();
};

/// Faces that are coplanar to this part of the diagonal of the box around the points are one face.
constexpr double coplanar = 1e-11;

/// Convex hull of `points`, coplanar facets joined. The topology is decided by CGAL's exact predicates, and numbered by the
/// coordinates of the points: their order does not matter.
/// @throws std::invalid_argument  fewer than four points, one that is not finite, or all in one plane (to the same part)
ConvexShape convexHull(const std::vector<Vector3>& points);

/// A cuboid around the origin with half edges `half`, all > 0 [m].
ConvexShape cuboid(const Vector3& half);

/// The plane convex polygon with these corners, in order: both sides are faces, and its edges faces of no width in between.
/// @throws std::invalid_argument  fewer than three corners, one that is not finite, or the first three in one line
ConvexShape plate(const std::vector<Vector3>& corners);

} // namespace contactdynamics
