// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "ConvexShape.hpp"

namespace contactdynamics {

/// A convex shape where it stands. Meant to be kept and placed anew, so that no memory is allocated once warm.
struct PlacedShape {
	const ConvexShape* shape = nullptr;
	std::vector<Vector3> vertices, normals; ///< of vertices and faces, global axes
	std::vector<double> offsets;			///< of the faces [m]
	Vector3 centre;							///< where the shape's origin is [m]

	void place(const ConvexShape& what, const Eigen::Matrix3d& rotation, const Vector3& translation);

	double highest(const Vector3& direction) const; ///< largest direction.x over the vertices
	double lowest(const Vector3& direction) const;
	Vector3 direction(const ConvexShape::Edge& edge) const { return vertices[edge.to] - vertices[edge.from]; }
};

} // namespace contactdynamics
