// SPDX-License-Identifier: GPL-2.0-or-later
#include "ClosestFeatures.hpp"
#include "PointDistance.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace contactdynamics {
namespace {
class Nearest {
public:
	Nearest(const PlacedShape& one, const PlacedShape& two, const Vector3& normal, double gap_) : gap(gap_)
	{
		const double top = one.highest(normal), bottom = two.lowest(normal);
		behind1.resize(one.vertices.size());
		behind2.resize(two.vertices.size());
		for (std::size_t i = 0; i < behind1.size(); i++) behind1[i] = top - normal.dot(one.vertices[i]);
		for (std::size_t i = 0; i < behind2.size(); i++) behind2[i] = normal.dot(two.vertices[i]) - bottom;
		slack = 1e-12 * (one.shape->radius + two.shape->radius);
	}

	void verticesAndFaces(const PlacedShape& points, const std::vector<double>& behind, const PlacedShape& faces, bool facesAreOne)
	{
		for (std::size_t face = 0; face < faces.normals.size(); face++)
			for (std::size_t i = 0; i < points.vertices.size(); i++) {
				if (excludes(behind[i])) continue;
				const double height = faces.normals[face].dot(points.vertices[i]) - faces.offsets[face];
				if (!(height > 0 && height < best.distance) || !isAboveFace(faces, face, points.vertices[i])) continue;
				const Vector3 foot = points.vertices[i] - height * faces.normals[face];
				best = facesAreOne ? ClosestPoints{height, foot, points.vertices[i]} : ClosestPoints{height, points.vertices[i], foot};
			}
	}

	void edges(const PlacedShape& one, const PlacedShape& two)
	{
		for (const ConvexShape::Edge& edge1 : one.shape->edges) {
			const double before = std::min(behind1[edge1.from], behind1[edge1.to]);
			if (excludes(before)) continue;
			for (const ConvexShape::Edge& edge2 : two.shape->edges)
				if (!excludes(before + std::min(behind2[edge2.from], behind2[edge2.to])))
					edgePair(one.vertices[edge1.from], one.vertices[edge1.to], two.vertices[edge2.from], two.vertices[edge2.to]);
		}
	}

	ClosestPoints best{std::numeric_limits<double>::infinity(), Vector3::Zero(), Vector3::Zero()};
	inline static thread_local std::vector<double> behind1, behind2;

private:
	double gap, slack;

	bool excludes(double behind) const { return gap + behind > best.distance + slack; }
	void offer(const Vector3& on1, const Vector3& on2)
	{
		const double distance = (on2 - on1).norm();
		if (distance < best.distance) best = {distance, on1, on2};
	}
	void edgePair(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d)
	{
		// Ends against the other edge; then the common perpendicular, with Cramer's rule along it, which loses less to round-off for
		// nearly parallel edges than the normal equations of the two parameters.
		offer(a, nearestOnSegment(a, c, d));
		offer(b, nearestOnSegment(b, c, d));
		offer(nearestOnSegment(c, a, b), c);
		offer(nearestOnSegment(d, a, b), d);
		const Vector3 along1 = b - a, along2 = d - c, across = along1.cross(along2), between = c - a;
		const double squared = across.squaredNorm();
		if (!(squared > 0)) return;
		const double place1 = between.cross(along2).dot(across) / squared, place2 = between.cross(along1).dot(across) / squared;
		if (place1 > 0 && place1 < 1 && place2 > 0 && place2 < 1) offer(a + place1 * along1, c + place2 * along2);
	}
};
} // namespace

ClosestPoints closestPoints(const PlacedShape& one, const PlacedShape& two, const Vector3& normal, double gap)
{
	Nearest nearest(one, two, normal, gap);
	nearest.edges(one, two);
	nearest.verticesAndFaces(one, Nearest::behind1, two, false);
	nearest.verticesAndFaces(two, Nearest::behind2, one, true);
	return nearest.best;
}

} // namespace contactdynamics
