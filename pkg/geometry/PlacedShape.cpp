// SPDX-License-Identifier: GPL-2.0-or-later
#include "PlacedShape.hpp"

#include <algorithm>

namespace contactdynamics {

void PlacedShape::place(const ConvexShape& what, const Eigen::Matrix3d& rotation, const Vector3& translation)
{
	shape = &what;
	centre = translation;
	vertices.resize(what.vertices.size());
	for (std::size_t i = 0; i < vertices.size(); i++) vertices[i] = rotation * what.vertices[i] + translation;
	normals.resize(what.faces.size());
	offsets.resize(what.faces.size());
	for (std::size_t i = 0; i < normals.size(); i++) {
		normals[i] = rotation * what.faces[i].normal;
		offsets[i] = what.faces[i].offset + normals[i].dot(translation);
	}
}

double PlacedShape::highest(const Vector3& direction) const
{
	double most = direction.dot(vertices[0]);
	for (const Vector3& vertex : vertices) most = std::max(most, direction.dot(vertex));
	return most;
}

double PlacedShape::lowest(const Vector3& direction) const { return -highest(-direction); }

} // namespace contactdynamics
