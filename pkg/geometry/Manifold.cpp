// SPDX-License-Identifier: GPL-2.0-or-later
#include "Manifold.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

namespace contactdynamics {
namespace {
/// A face counts for upper or lower surface if its normal has at least this component along the direction of view; steeper ones show
/// themselves as edges.
constexpr double steep = 1e-6;

Eigen::Matrix3d viewAlong(const Vector3& normal)
{
	int axis;
	normal.cwiseAbs().minCoeff(&axis);
	const Vector3 across = (Vector3::Unit(axis) - normal[axis] * normal).normalized();
	Eigen::Matrix3d view;
	view.row(0) = across;
	view.row(1) = normal.cross(across);
	view.row(2) = normal;
	return view;
}

/// The surface of a body that looks in the direction `side` (+1 along the normal, -1 against it), in the axes of the view.
class Terrain {
public:
	void survey(const PlacedShape& body, const Eigen::Matrix3d& view, int side_)
	{
		shape = body.shape;
		side = side_;
		seen.resize(body.vertices.size());
		extreme = -std::numeric_limits<double>::infinity();
		for (std::size_t i = 0; i < seen.size(); i++) {
			seen[i] = view * body.vertices[i];
			extreme = std::max(extreme, side * seen[i][2]);
		}
		normals.resize(body.normals.size());
		onSurface.assign(seen.size(), 0);
		for (std::size_t f = 0; f < normals.size(); f++) {
			normals[f] = view * body.normals[f];
			if (!isOpen(f)) continue;
			const ConvexShape::Face& face = shape->faces[f];
			for (std::int32_t i = 0; i < face.count; i++) onSurface[shape->loops[face.first + i]] = 1;
		}
	}
	bool isOpen(std::size_t face) const { return side * normals[face][2] > steep; }

	/// Height of the surface at x, y, or nothing beside it; `close` is how far beside counts as on it.
	std::optional<double> height(double x, double y, double close, double lowestOfInterest) const
	{
		std::optional<double> found;
		for (std::size_t f = 0; f < normals.size(); f++) {
			if (!isOpen(f) || !covers(f, x, y, close, lowestOfInterest)) continue;
			const ConvexShape::Face& face = shape->faces[f];
			double low = std::numeric_limits<double>::infinity(), high = -low;
			for (std::int32_t i = 0; i < face.count; i++) {
				const double z = seen[shape->loops[face.first + i]][2];
				low = std::min(low, z);
				high = std::max(high, z);
			}
			const Vector3& on = seen[shape->loops[face.first]];
			const Vector3& n = normals[f];
			const double z = std::clamp(on[2] - (n[0] * (x - on[0]) + n[1] * (y - on[1])) / n[2], low, high);
			if (!found || side * z > side * *found) found = z;
		}
		return found;
	}

	const ConvexShape* shape = nullptr;
	std::vector<Vector3> seen, normals;
	std::vector<std::uint8_t> onSurface;
	double extreme = 0; // side * z, the largest

private:
	int side = 1;

	bool covers(std::size_t f, double x, double y, double close, double lowestOfInterest) const
	{
		const ConvexShape::Face& face = shape->faces[f];
		bool high = false;
		for (std::int32_t i = 0; i < face.count; i++) {
			const Vector3 &from = seen[shape->loops[face.first + i]], &to = seen[shape->loops[face.first + (i + 1) % face.count]];
			const double dx = to[0] - from[0], dy = to[1] - from[1];
			if (side * (dx * (y - from[1]) - dy * (x - from[0])) < -close * std::sqrt(dx * dx + dy * dy)) return false;
			high = high || side * from[2] >= lowestOfInterest;
		}
		return high;
	}
};

class Overlay {
public:
	Overlay(const PlacedShape& one, const PlacedShape& two, const Separation& separation, double reach_, double beside,
			std::vector<ManifoldPoint>& points_)
		: reach(reach_), points(points_), view(viewAlong(separation.normal))
	{
		const double smaller = std::min(one.shape->radius, two.shape->radius), larger = std::max(one.shape->radius, two.shape->radius);
		close = std::max({1e-9 * smaller, 1e-14 * larger, beside}); // round-off of the coordinates is a hundredth of the first two
		same = 1e-6 * smaller;
		leastGap = separation.gap - steady * smaller;
		upper.survey(one, view, 1);
		lower.survey(two, view, -1);
		points.clear();
	}

	void vertices()
	{
		for (std::size_t i = 0; i < lower.seen.size(); i++) {
			const Vector3& at = lower.seen[i];
			if (!lower.onSurface[i] || at[2] - upper.extreme > reach) continue;
			if (const auto ground = upper.height(at[0], at[1], close, at[2] - reach))
				add(at[0], at[1], *ground, at[2], featureOfVertex(1, static_cast<std::int32_t>(i)));
		}
		for (std::size_t i = 0; i < upper.seen.size(); i++) {
			const Vector3& at = upper.seen[i];
			if (!upper.onSurface[i] || -lower.extreme - at[2] > reach) continue;
			if (const auto ceiling = lower.height(at[0], at[1], close, -at[2] - reach))
				add(at[0], at[1], at[2], *ceiling, featureOfVertex(0, static_cast<std::int32_t>(i)));
		}
	}

	void crossings()
	{
		for (std::size_t i = 0; i < upper.shape->edges.size(); i++) {
			const ConvexShape::Edge& edge1 = upper.shape->edges[i];
			const Vector3 &a = upper.seen[edge1.from], &b = upper.seen[edge1.to];
			if (!(upper.isOpen(edge1.left) || upper.isOpen(edge1.right)) || -lower.extreme - std::max(a[2], b[2]) > reach) continue;
			for (std::size_t j = 0; j < lower.shape->edges.size(); j++) {
				const ConvexShape::Edge& edge2 = lower.shape->edges[j];
				const Vector3 &c = lower.seen[edge2.from], &d = lower.seen[edge2.to];
				if (!(lower.isOpen(edge2.left) || lower.isOpen(edge2.right)) || std::min(c[2], d[2]) - std::max(a[2], b[2]) > reach) continue;
				if (apart(a, b, c, d, 0) || apart(a, b, c, d, 1)) continue;
				const double x1 = b[0] - a[0], y1 = b[1] - a[1], x2 = d[0] - c[0], y2 = d[1] - c[1], x = c[0] - a[0], y = c[1] - a[1];
				const double area = x1 * y2 - y1 * x2;
				if (!(area * area > 1e-24 * (x1 * x1 + y1 * y1) * (x2 * x2 + y2 * y2))) continue; // parallel: their ends are points already
				const double place1 = (x * y2 - y * x2) / area, place2 = (x * y1 - y * x1) / area;
				if (!(place1 >= 0 && place1 <= 1 && place2 >= 0 && place2 <= 1)) continue;
				add(a[0] + place1 * x1, a[1] + place1 * y1, a[2] + place1 * (b[2] - a[2]), c[2] + place2 * (d[2] - c[2]),
					featureOfEdges(static_cast<std::int32_t>(i), static_cast<std::int32_t>(j)));
			}
		}
	}

private:
	double reach, close, same, leastGap;
	std::vector<ManifoldPoint>& points;
	Eigen::Matrix3d view;
	inline static thread_local Terrain upper, lower;

	static bool apart(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d, int axis)
	{
		return std::max(a[axis], b[axis]) < std::min(c[axis], d[axis]) || std::max(c[axis], d[axis]) < std::min(a[axis], b[axis]);
	}

	void add(double x, double y, double z1, double z2, std::int32_t feature)
	{
		const double gap = z2 - z1;
		// No gap is smaller than s(n), but for points that stand beside a steep face by round-off.
		if (!(gap <= reach) || gap < leastGap) return;
		const Vector3 place = view.transpose() * Vector3(x, y, 0.5 * (z1 + z2));
		for (ManifoldPoint& known : points) {
			if ((known.place - place).squaredNorm() > same * same) continue;
			known.gap = std::min(known.gap, gap);
			return;
		}
		points.push_back({place, gap, feature});
	}
};
} // namespace

Separation findManifold(const PlacedShape& one, const PlacedShape& two, double reach, const DecidingFeature& last, std::vector<ManifoldPoint>& points)
{
	points.clear();
	const auto overlay = [&](const DecidingFeature& preferred) {
		Separation separation = separate(one, two, reach, preferred);
		if (separation.gap > reach) return separation;
		Overlay laid(one, two, separation, reach, 0, points);
		laid.vertices();
		laid.crossings();
		return separation;
	};
	// The nearest of the points is at the distance of the bodies. For two plates side by side in one plane round-off may hide it: seen from the edge
	// they are lines.
	const double close = steady * std::min(one.shape->radius, two.shape->radius);
	const auto seesNearest = [&](const Separation& separation) {
		return std::any_of(points.begin(), points.end(), [&](const ManifoldPoint& point) { return point.gap <= separation.gap + close; });
	};
	Separation separation = overlay(last);
	if (separation.gap > reach || seesNearest(separation)) return separation;
	// The direction of the last step may see the bodies side by side now; then that of this step.
	if (last.kind != DecidingFeature::none) separation = overlay({});
	// They touch at a corner of both, within round-off.
	if (!seesNearest(separation)) points.push_back({separation.witness, separation.gap, featureOfEdges(0x3fff, 0x3fff)});
	return separation;
}

Separation findManifoldAlong(const PlacedShape& one, const PlacedShape& two, const Vector3& normal, double reach, double beside,
							 std::vector<ManifoldPoint>& points)
{
	points.clear();
	Separation separation;
	separation.normal = normal;
	separation.gap = two.lowest(normal) - one.highest(normal);
	separation.witness = 0.5 * (one.centre + two.centre);
	if (separation.gap > reach) return separation;
	Overlay laid(one, two, separation, reach, beside, points);
	laid.vertices();
	laid.crossings();
	return separation;
}

} // namespace contactdynamics
