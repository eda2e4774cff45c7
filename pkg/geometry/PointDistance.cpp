// SPDX-License-Identifier: GPL-2.0-or-later
#include "PointDistance.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace contactdynamics {

bool isAboveFace(const PlacedShape& shape, std::size_t face, const Vector3& point)
{
	const ConvexShape::Face& of = shape.shape->faces[face];
	const Vector3& normal = shape.normals[face];
	for (std::int32_t i = 0; i < of.count; i++) {
		const Vector3 &from = shape.vertices[shape.shape->loops[of.first + i]],
					  &to = shape.vertices[shape.shape->loops[of.first + (i + 1) % of.count]];
		if (to == from) return false; // a face without width, at the edge of a triangle: nothing stands above it, and its ends bound nothing
		if (normal.cross(to - from).dot(point - from) < 0) return false;
	}
	return true;
}

Vector3 nearestOnSegment(const Vector3& p, const Vector3& a, const Vector3& b)
{
	const Vector3 along = b - a;
	const double squared = along.squaredNorm();
	if (!(squared > 0)) return a;
	return a + std::clamp((p - a).dot(along) / squared, 0., 1.) * along;
}

SurfacePoint nearestOnSurface(const PlacedShape& shape, const Vector3& point)
{
	std::size_t nearest = 0;
	double height = shape.normals[0].dot(point) - shape.offsets[0];
	for (std::size_t face = 1; face < shape.normals.size(); face++) {
		const double above = shape.normals[face].dot(point) - shape.offsets[face];
		if (above > height) {
			height = above;
			nearest = face;
		}
	}
	SurfacePoint byFace{height, point - height * shape.normals[nearest], shape.normals[nearest]};
	// Inside, the nearest face is the nearest part of the surface; outside, only if the point stands above it.
	if (height <= 0 || isAboveFace(shape, nearest, point)) return byFace;
	// Of all faces the point stands above, and edges, the nearest: the height above the plane of any other face is only a lower bound.
	SurfacePoint found = byFace;
	found.distance = std::numeric_limits<double>::infinity();
	for (std::size_t face = 0; face < shape.normals.size(); face++) {
		const double above = shape.normals[face].dot(point) - shape.offsets[face];
		if (above > 0 && above < found.distance && isAboveFace(shape, face, point))
			found = {above, point - above * shape.normals[face], shape.normals[face]};
	}
	for (const ConvexShape::Edge& edge : shape.shape->edges) {
		const Vector3 place = nearestOnSegment(point, shape.vertices[edge.from], shape.vertices[edge.to]);
		const double distance = (point - place).norm();
		if (distance < found.distance) found = {distance, place, distance > 0 ? Vector3((point - place) / distance) : byFace.normal};
	}
	// Very near to an edge the direction to it is lost in round-off; the plane then is as near.
	return found.distance > height + 1e-12 * shape.shape->radius ? found : byFace;
}

} // namespace contactdynamics
