// SPDX-License-Identifier: GPL-2.0-or-later
#include "ConvexShape.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

namespace contactdynamics {

void ConvexShape::complete()
{
	radius = 0;
	for (const Vector3& vertex : vertices) radius = std::max(radius, vertex.norm());
	std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> leftOf;
	for (std::size_t f = 0; f < faces.size(); f++) {
		Face& face = faces[f];
		face.offset = face.normal.dot(vertices[0]);
		for (const Vector3& vertex : vertices) face.offset = std::max(face.offset, face.normal.dot(vertex));
		for (std::int32_t i = 0; i < face.count; i++) {
			const std::int32_t from = loops[face.first + i], to = loops[face.first + (i + 1) % face.count];
			if (!leftOf.emplace(std::make_pair(from, to), static_cast<std::int32_t>(f)).second)
				throw std::invalid_argument("two faces of a polyhedron have an edge in the same direction");
		}
	}
	edges.clear();
	for (const auto& [ends, left] : leftOf) {
		const auto twin = leftOf.find({ends.second, ends.first});
		if (twin == leftOf.end()) throw std::invalid_argument("an edge of a polyhedron has one face only");
		if (ends.first < ends.second) edges.push_back({ends.first, ends.second, left, twin->second});
	}
}

ConvexShape cuboid(const Vector3& half)
{
	ConvexShape shape;
	for (int corner = 0; corner < 8; corner++)
		shape.vertices.push_back(half.cwiseProduct(Vector3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1)));
	for (int axis = 0; axis < 3; axis++) {
		const int b = 1 << (axis + 1) % 3, c = 1 << (axis + 2) % 3, up = 1 << axis;
		for (const int side : {0, up}) {
			ConvexShape::Face face;
			face.normal = (side ? 1 : -1) * Vector3::Unit(axis);
			face.first = static_cast<std::int32_t>(shape.loops.size());
			face.count = 4;
			if (side)
				shape.loops.insert(shape.loops.end(), {side, side + b, side + b + c, side + c});
			else
				shape.loops.insert(shape.loops.end(), {side, side + c, side + b + c, side + b});
			shape.faces.push_back(face);
		}
	}
	shape.complete();
	return shape;
}

ConvexShape plate(const std::vector<Vector3>& corners)
{
	const auto count = static_cast<std::int32_t>(corners.size());
	if (count < 3) throw std::invalid_argument("a plate needs three corners");
	for (const Vector3& corner : corners)
		if (!corner.allFinite()) throw std::invalid_argument("a corner is not finite");
	const Vector3 first = corners[1] - corners[0], second = corners[2] - corners[1], normal = first.cross(second);
	const double longest = std::max({first.norm(), second.norm(), (corners[2] - corners[0]).norm()});
	if (!(normal.norm() > coplanar * longest * longest)) throw std::invalid_argument("the corners lie in one line");
	// Two sheets of corners, so that every edge has two faces: the first half on the side of the normal, the second on the other.
	ConvexShape shape;
	shape.vertices = corners;
	shape.vertices.insert(shape.vertices.end(), corners.begin(), corners.end());
	for (std::int32_t i = 0; i < count; i++) shape.loops.push_back(i);
	for (std::int32_t i = count; i > 0; i--) shape.loops.push_back(count + i - 1);
	shape.faces.resize(2);
	shape.faces[0] = {normal.normalized(), 0, 0, count};
	shape.faces[1] = {-normal.normalized(), 0, count, count};
	for (std::int32_t i = 0; i < count; i++) {
		const std::int32_t j = (i + 1) % count;
		const Vector3 along = corners[j] - corners[i];
		shape.faces.push_back({along.cross(normal).normalized(), 0, static_cast<std::int32_t>(shape.loops.size()), 4});
		shape.loops.insert(shape.loops.end(), {i, i + count, j + count, j});
	}
	shape.complete();
	return shape;
}

} // namespace contactdynamics
