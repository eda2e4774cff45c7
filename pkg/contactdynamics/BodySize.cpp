// SPDX-License-Identifier: GPL-2.0-or-later
#include "BodySize.hpp"
#include <pkg/common/Box.hpp>
#include <pkg/polyhedra/Polyhedra.hpp>
#include <algorithm>
#include <cmath>

namespace yade {

Real polyhedronRadius(const Shape& shape)
{
	const auto* polyhedra = dynamic_cast<const Polyhedra*>(&shape);
	if (!polyhedra) return 0;
	Real squared = 0;
	for (const Vector3r& vertex : polyhedra->v) squared = std::max(squared, vertex.squaredNorm());
	return std::sqrt(squared);
}

Real grainRadius(const Body& body)
{
	if (const Sphere* sphere = asSphere(body.shape.get())) return sphere->radius;
	return body.shape ? polyhedronRadius(*body.shape) : 0;
}

Real extentAlong(const Body& body, const Vector3r& direction)
{
	if (const Sphere* sphere = asSphere(body.shape.get())) return 2 * sphere->radius;
	const Vector3r along = body.state->ori.conjugate() * direction;
	if (const auto* box = dynamic_cast<const Box*>(body.shape.get())) return 2 * box->extents.dot(along.cwiseAbs());
	const auto* polyhedra = dynamic_cast<const Polyhedra*>(body.shape.get());
	if (!polyhedra || polyhedra->v.empty()) return 0;
	Real least = polyhedra->v.front().dot(along), most = least;
	for (const Vector3r& vertex : polyhedra->v) {
		least = std::min(least, vertex.dot(along));
		most = std::max(most, vertex.dot(along));
	}
	return most - least;
}

} // namespace yade
