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

ConvexShape triangle(const Vector3& a, const Vector3& b, const Vector3& c)
{
	if (!(a.allFinite() && b.allFinite() && c.allFinite())) throw std::invalid_argument("a corner of the triangle is not finite");
	const Vector3 normal = (b - a).cross(c - a);
	const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
	if (!(normal.norm() > coplanar * longest * longest)) throw std::invalid_argument("the corners of the triangle lie in one line");
	// Two sheets of corners, so that every edge has two faces: 0, 1, 2 on the side of the normal, 3, 4, 5 on the other.
	ConvexShape shape;
	shape.vertices = {a, b, c, a, b, c};
	shape.loops = {0, 1, 2, 5, 4, 3};
	shape.faces.resize(2);
	shape.faces[0] = {normal.normalized(), 0, 0, 3};
	shape.faces[1] = {-normal.normalized(), 0, 3, 3};
	for (int i = 0; i < 3; i++) {
		const int j = (i + 1) % 3;
		const Vector3 along = shape.vertices[j] - shape.vertices[i];
		shape.faces.push_back({along.cross(normal).normalized(), 0, static_cast<std::int32_t>(shape.loops.size()), 4});
		shape.loops.insert(shape.loops.end(), {i, i + 3, j + 3, j});
	}
	shape.complete();
	return shape;
}

} // namespace contactdynamics
