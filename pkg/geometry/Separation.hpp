// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "PlacedShape.hpp"

namespace contactdynamics {

/// What decides the direction in which two convex polyhedra part.
struct DecidingFeature {
	enum Kind : std::int32_t {
		none,
		faceOfOne, ///< `one` is a face of the first body
		faceOfTwo, ///< `two` is a face of the second body
		edges,	   ///< perpendicular to edge `one` of the first and edge `two` of the second
		points	   ///< the line between the nearest points, at a corner: not a direction of the shapes themselves
	};
	std::int32_t kind = none, one = -1, two = -1;
};

/// Signed distance of two convex polyhedra: the distance where they are apart, minus the shortest translation that parts them where they overlap.
struct Separation {
	double gap = 0;					   ///< [m]
	Vector3 normal = Vector3::UnitX(); ///< unit, from the first to the second; parts them by `gap`
	Vector3 witness = Vector3::Zero(); ///< in the middle of nearest or deepest points [m]
	DecidingFeature feature;
};

/// For any unit n, s(n) = min over two of n.x - max over one of n.x is a lower bound of the signed distance, and the largest s(n) is that distance if
/// they overlap: it occurs for a face normal of either body or the cross product of two edges (Gottschalk, Lin & Manocha 1996). So a direction that
/// rounding spoils or that is no candidate cannot give a wrong answer, only a smaller s(n). Where the bodies are apart the distance may be that
/// of corners: the nearest pairs of features are then searched among those that s(n) does not exclude.
///
/// @param reach  bodies further apart than this are of no interest: `gap` is then a lower bound above `reach`, without more                [m]
/// @param last   feature of the step before: it stays unless another one parts the bodies better by `steady` times the smaller radius. Keeps
///               the direction of resting bodies from flickering between equal ones; nothing else is remembered.
Separation separate(const PlacedShape& one, const PlacedShape& two, double reach, const DecidingFeature& last = {});

constexpr double steady = 1e-6;

} // namespace contactdynamics
