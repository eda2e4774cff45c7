// SPDX-License-Identifier: GPL-2.0-or-later
#include "Separation.hpp"
#include "ClosestFeatures.hpp"
#include "PointDistance.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace contactdynamics {
namespace {
double gapAlong(const PlacedShape& one, const PlacedShape& two, const Vector3& normal) { return two.lowest(normal) - one.highest(normal); }

/// Unit vector perpendicular to both edges; zero when they are parallel to round-off, where the faces at the edges say the same.
Vector3 acrossEdges(const Vector3& along1, const Vector3& along2)
{
	Vector3 across = along1.cross(along2);
	const double length = across.norm(), full = along1.norm() * along2.norm();
	if (!(length > 1e-12 * full)) return Vector3::Zero();
	across /= length;
	// The cross product of nearly parallel edges is off by round-off / sine; along the edges that would count in full.
	across -= across.dot(along1) / along1.squaredNorm() * along1;
	return across.normalized();
}

constexpr double doubt = 1e-9; // sines and cosines as small as this may have either sign

class Search {
public:
	Search(const PlacedShape& one_, const PlacedShape& two_, double reach_) : one(one_), two(two_), reach(reach_) {}

	/// @return  false when the bodies are out of reach
	bool faces()
	{
		for (std::size_t i = 0; i < one.normals.size(); i++)
			if (!offer(two.lowest(one.normals[i]) - one.offsets[i], one.normals[i], {DecidingFeature::faceOfOne, static_cast<std::int32_t>(i), -1}))
				return false;
		for (std::size_t i = 0; i < two.normals.size(); i++)
			if (!offer(-two.offsets[i] - one.highest(-two.normals[i]), -two.normals[i],
					   {DecidingFeature::faceOfTwo, -1, static_cast<std::int32_t>(i)}))
				return false;
		return true;
	}

	/// Edges decide only where they come as near to each other as the bodies can be apart, or deep: the others are not looked at.
	bool edges()
	{
		const double near = std::max(reach, -best.gap);
		nearEdges(one, two, near, edges1);
		nearEdges(two, one, near, edges2);
		for (const std::int32_t i : edges1) {
			const ConvexShape::Edge& edge1 = one.shape->edges[i];
			const Vector3 along1 = one.direction(edge1);
			const Vector3 &a = one.normals[edge1.left], &b = one.normals[edge1.right];
			for (const std::int32_t j : edges2) {
				const ConvexShape::Edge& edge2 = two.shape->edges[j];
				const Vector3 along2 = two.direction(edge2);
				if (!maySpanFace(along1, a, b, along2, two.normals[edge2.left], two.normals[edge2.right])) continue;
				const Vector3 across = acrossEdges(along1, along2), between = two.vertices[edge2.from] - one.vertices[edge1.from];
				if (across.isZero(0)) continue;
				for (const double sign : {1., -1.}) {
					const Vector3 normal = sign * across;
					if (normal.dot(a + b) < -doubt || normal.dot(two.normals[edge2.left] + two.normals[edge2.right]) > doubt) continue;
					// The edges' own distance bounds s(n) from above: mostly the supports need not be worked out.
					if (!(normal.dot(between) > best.gap)) continue;
					if (!offer(gapAlong(one, two, normal), normal, {DecidingFeature::edges, i, j})) return false;
				}
			}
		}
		return true;
	}

	void nearestPoints()
	{
		if (!(best.gap > 0) || meetsAlongNormal()) return;
		const ClosestPoints closest = closestPoints(one, two, best.normal, best.gap);
		const double size = std::min(one.shape->radius, two.shape->radius);
		best.witness = 0.5 * (closest.on1 + closest.on2);
		witnessed = true;
		if (!(closest.distance > best.gap + 1e-12 * size)) return;
		const Vector3 normal = (closest.on2 - closest.on1) / closest.distance;
		if (!(gapAlong(one, two, normal) > best.gap)) return; // too near for a direction of its own
		best.gap = closest.distance;
		best.normal = normal;
		best.feature = {DecidingFeature::points, -1, -1};
	}

	void keep(const DecidingFeature& last)
	{
		const Vector3 normal = directionOf(last);
		if (normal.isZero(0)) return;
		const double gap = gapAlong(one, two, normal);
		if (!(gap >= best.gap - steady * std::min(one.shape->radius, two.shape->radius))) return;
		if (last.kind == best.feature.kind && last.one == best.feature.one && last.two == best.feature.two) return;
		best.gap = gap;
		best.normal = normal;
		best.feature = last;
		witnessed = false;
	}

	Separation result()
	{
		if (!witnessed) best.witness = witness();
		return best;
	}
	double gap() const { return best.gap; }

private:
	const PlacedShape &one, &two;
	double reach;
	bool witnessed = false;
	Separation best = {-std::numeric_limits<double>::infinity(), Vector3::UnitX(), Vector3::Zero(), {}};
	inline static thread_local std::vector<std::int32_t> edges1, edges2;

	bool offer(double gap, const Vector3& normal, const DecidingFeature& feature)
	{
		if (gap > best.gap) {
			best.gap = gap;
			best.normal = normal;
			best.feature = feature;
		}
		return !(best.gap > reach);
	}

	/// Whether the line along the normal through the deciding features hits both: then the plane's gap is the distance of the bodies.
	bool meetsAlongNormal() const
	{
		const std::int32_t face = best.feature.kind == DecidingFeature::faceOfOne ? best.feature.one : best.feature.two;
		if (best.feature.kind == DecidingFeature::faceOfOne) return isAboveFace(one, face, extreme(two, -best.normal));
		if (best.feature.kind == DecidingFeature::faceOfTwo) return isAboveFace(two, face, extreme(one, best.normal));
		return false;
	}

	static const Vector3& extreme(const PlacedShape& shape, const Vector3& direction)
	{
		return *std::max_element(shape.vertices.begin(), shape.vertices.end(),
								 [&](const Vector3& a, const Vector3& b) { return direction.dot(a) < direction.dot(b); });
	}

	static void nearEdges(const PlacedShape& own, const PlacedShape& other, double near, std::vector<std::int32_t>& found)
	{
		Vector3 low = other.vertices[0], high = low;
		for (const Vector3& vertex : other.vertices) {
			low = low.cwiseMin(vertex);
			high = high.cwiseMax(vertex);
		}
		// Rounding must not cut off an edge that only just counts.
		const Vector3 margin = Vector3::Constant(near + 1e-9 * (own.shape->radius + other.shape->radius));
		low -= margin;
		high += margin;
		found.clear();
		for (std::size_t i = 0; i < own.shape->edges.size(); i++) {
			const ConvexShape::Edge& edge = own.shape->edges[i];
			const Vector3 &a = own.vertices[edge.from], &b = own.vertices[edge.to];
			if (a == b) continue; // between the two sheets of a triangle
			if ((a.cwiseMax(b).array() >= low.array()).all() && (a.cwiseMin(b).array() <= high.array()).all())
				found.push_back(static_cast<std::int32_t>(i));
		}
	}

	/// Whether the edges span a face of the Minkowski difference: the arcs between the normals at the edges, a b and -c -d, cross on the sphere of
	/// directions, or opposite ones do. Answers yes in doubt.
	static bool maySpanFace(const Vector3& along1, const Vector3& a, const Vector3& b, const Vector3& along2, const Vector3& c, const Vector3& d)
	{
		const double c1 = -c.dot(along1), d1 = -d.dot(along1), a2 = a.dot(along2), b2 = b.dot(along2);
		const double doubt1 = doubt * along1.norm(), doubt2 = doubt * along2.norm();
		return !(std::min(c1, d1) > doubt1 || std::max(c1, d1) < -doubt1 || std::min(a2, b2) > doubt2 || std::max(a2, b2) < -doubt2);
	}

	Vector3 directionOf(const DecidingFeature& feature) const
	{
		const auto within = [](std::int32_t index, std::size_t count) { return index >= 0 && static_cast<std::size_t>(index) < count; };
		switch (feature.kind) {
		case DecidingFeature::faceOfOne:
			if (within(feature.one, one.normals.size())) return one.normals[feature.one];
			break;
		case DecidingFeature::faceOfTwo:
			if (within(feature.two, two.normals.size())) return -two.normals[feature.two];
			break;
		case DecidingFeature::edges:
			if (within(feature.one, one.shape->edges.size()) && within(feature.two, two.shape->edges.size())) {
				const ConvexShape::Edge& edge = one.shape->edges[feature.one];
				const Vector3 normal = acrossEdges(one.direction(edge), two.direction(two.shape->edges[feature.two]));
				return normal.dot(one.normals[edge.left] + one.normals[edge.right]) < 0 ? Vector3(-normal) : normal;
			}
			break;
		default:
			break;
		}
		return Vector3::Zero();
	}

	/// Middle between the bodies where they are deepest in each other.
	Vector3 witness() const
	{
		if (best.feature.kind == DecidingFeature::faceOfOne) return extreme(two, -best.normal) - 0.5 * best.gap * best.normal;
		if (best.feature.kind == DecidingFeature::faceOfTwo) return extreme(one, best.normal) + 0.5 * best.gap * best.normal;
		const ConvexShape::Edge &edge1 = one.shape->edges[best.feature.one], &edge2 = two.shape->edges[best.feature.two];
		const Vector3 along1 = one.direction(edge1), along2 = two.direction(edge2), between = two.vertices[edge2.from] - one.vertices[edge1.from];
		const double place = std::clamp(between.cross(along2).dot(best.normal) / along1.cross(along2).dot(best.normal), 0., 1.);
		return one.vertices[edge1.from] + place * along1 + 0.5 * best.gap * best.normal;
	}
};
} // namespace

Separation separate(const PlacedShape& one, const PlacedShape& two, double reach, const DecidingFeature& last)
{
	Search search(one, two, reach);
	if (search.faces() && search.edges()) {
		search.nearestPoints();
		if (!(search.gap() > reach)) search.keep(last);
	}
	return search.result();
}

} // namespace contactdynamics
