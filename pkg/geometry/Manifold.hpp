// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "Separation.hpp"

namespace contactdynamics {

/// One point of the contact between two convex polyhedra.
struct ManifoldPoint {
	Vector3 place;		  ///< in the middle of gap or overlap [m]
	double gap;			  ///< along the common normal [m]
	std::int32_t feature; ///< what makes the point, the same in every step: see featureOfVertex and featureOfEdges
};

/// Identifiers of points: a vertex of the first (body 0) or second (body 1) shape, or a crossing of an edge of each.
constexpr std::int32_t featureOfVertex(int body, std::int32_t vertex) { return (body << 28) | vertex; }
constexpr std::int32_t featureOfEdges(std::int32_t edge1, std::int32_t edge2) { return (2 << 28) | ((edge1 & 0x3fff) << 14) | (edge2 & 0x3fff); }

/// Direction, gap and points of the contact of two convex polyhedra.
///
/// Seen along the normal of separate(), the upper surface of the first and the lower surface of the second are laid over each other. Where both
/// are, the gap is a convex function, linear over each piece of the overlay: so the corners of the overlay (vertices of either body, crossings of
/// edges) carry all there is to know; the nearest of them is at the distance of the bodies, but for `steady` times the smaller radius. For two
/// parallel faces these are the corners of the polygon they share, all of them, so no part of the support is lost; other pairs of features give one
/// point or two. Neither body is the reference.
///
/// @param reach   corners with a larger gap are left out; no points at all when the bodies are further apart [m]
/// @param last    feature of the step before, see separate()
/// @param points  out
Separation findManifold(const PlacedShape& one, const PlacedShape& two, double reach, const DecidingFeature& last,
						std::vector<ManifoldPoint>& points);

/// The same along a given direction, which need not be the best one.
///
/// @param normal  unit, from the first to the second
/// @param beside  corners that miss the other body by no more than this across the normal are taken as if its face reached out to them [m]
Separation findManifoldAlong(const PlacedShape& one, const PlacedShape& two, const Vector3& normal, double reach, double beside,
							 std::vector<ManifoldPoint>& points);

} // namespace contactdynamics
