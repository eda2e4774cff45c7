// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <lib/base/Math.hpp>
#include <pkg/geometry/ConvexShape.hpp>
#include <vector>

namespace yade {

/// Contact of a polyhedron with a surface. Places are relative to the polyhedron's position.
struct BlockContact {
	const contactdynamics::ConvexShape* shape = nullptr; // of the surface; null for a wall
	Matrix3r rotation = Matrix3r::Identity();			 // of the surface
	Vector3r place = Vector3r::Zero();					 // of its position [m]
	Vector3r normal = Vector3r::Zero();					 // unit, from the surface to the polyhedron
	Real gap = 0;										 // [m]
	bool isFacet = false;
	std::vector<Vector3r> points; // of the contact, on the surface [m]

	enum class Seam {
		none,
		flush, // lies behind the plane of another contact, and takes its direction
		hollow // a facet beyond a hollow seam; takes the direction of its face
	} seam = Seam::none;
	Vector3r direction = Vector3r::Zero(); // to be taken at a seam
};

/// The seams between blocks, boxes, facets and walls under a polyhedron, as Seams.hpp has them for spheres.
///
/// A block that slides along a floor of flush blocks is beside the next one before it is above it: the shortest way to part the two then leads across
/// the joint, and a contact in that direction would stop the block. But when surface B lies behind the plane that parts the block from surface A,
/// that plane parts it from B as well, by no less than from A. So B gets the direction of A: over a flat surface all contacts have the same, and
/// joints are not felt. A step upwards lies in front of the plane and stops the block.
///
/// A facet that rises beyond a hollow seam is not behind the plane of the facet on this side, and its nearest edge would stop the block likewise. It
/// gets the direction of its own face where that one parts the two bodies and all points of the contact lie on another surface, too.
///
/// @param rotation  of the polyhedron
/// @param contacts  with all polyhedra, boxes, facets and walls; the result is in seam and direction
void settleBlockSeams(const contactdynamics::ConvexShape& block, const Matrix3r& rotation, std::vector<BlockContact>& contacts);

} // namespace yade
