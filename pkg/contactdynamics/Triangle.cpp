// SPDX-License-Identifier: GPL-2.0-or-later
#include "Triangle.hpp"
#include <pkg/geometry/PointDistance.hpp>
#include <algorithm>

namespace yade {
Vector3r nearestOnTriangle(const Vector3r& p, const Vector3r& a, const Vector3r& b, const Vector3r& c)
{
	const Vector3r areaNormal = (b - a).cross(c - a);
	const Real squared = areaNormal.squaredNorm();
	if (squared > 0) {
		// barycentric coordinates of the foot of the perpendicular; all of them non-negative: the face is nearest
		const Real alongC = (b - a).cross(p - a).dot(areaNormal) / squared;
		const Real alongB = (p - a).cross(c - a).dot(areaNormal) / squared;
		if (alongB >= 0 && alongC >= 0 && alongB + alongC <= 1) return a + alongB * (b - a) + alongC * (c - a);
	}
	// otherwise one of the edges; the shorter code of three segments was preferred to a walk through the Voronoi regions
	using contactdynamics::nearestOnSegment;
	const Vector3r candidates[3] = {nearestOnSegment(p, a, b), nearestOnSegment(p, b, c), nearestOnSegment(p, c, a)};
	return *std::min_element(candidates, candidates + 3,
							 [&p](const Vector3r& one, const Vector3r& other) { return (p - one).squaredNorm() < (p - other).squaredNorm(); });
}

} // namespace yade
