// SPDX-License-Identifier: GPL-2.0-or-later
#include "Surface.hpp"
#include "ConvexShapes.hpp"
#include "Triangle.hpp"
#include <core/State.hpp>
#include <pkg/common/Box.hpp>
#include <pkg/common/Facet.hpp>
#include <pkg/common/Wall.hpp>
#include <pkg/geometry/PointDistance.hpp>
#include <pkg/polyhedra/Polyhedra.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace yade {

Surface::Surface(const shared_ptr<Shape>& shape, const State& state, const Vector3r& origin) : centre(origin)
{
	if (const auto* facet = dynamic_cast<const Facet*>(shape.get())) {
		for (int i = 0; i < 3; i++) corners[i] = origin + state.ori * facet->vertices[i];
		low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
		high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
	} else if (const auto* box = dynamic_cast<const Box*>(shape.get())) {
		kind = Kind::box;
		for (int i = 0; i < 3; i++) corners[i] = state.ori * Vector3r(box->extents[i] * Vector3r::Unit(i));
		high = centre + corners[0].cwiseAbs() + corners[1].cwiseAbs() + corners[2].cwiseAbs();
		low = 2 * centre - high;
	} else if (const auto* wall = dynamic_cast<const Wall*>(shape.get())) {
		kind = Kind::wall;
		corners[0] = Vector3r::Unit(wall->axis);
		low = Vector3r::Constant(-std::numeric_limits<Real>::infinity());
		high = -low;
		low[wall->axis] = high[wall->axis] = centre[wall->axis];
	} else if (dynamic_cast<const Polyhedra*>(shape.get())) {
		kind = Kind::polyhedron;
		const auto placed = std::make_shared<contactdynamics::PlacedShape>();
		placed->place(ConvexShapes::of(shape), state.ori.toRotationMatrix(), origin);
		low = high = placed->vertices[0];
		for (const Vector3r& vertex : placed->vertices) {
			low = low.cwiseMin(vertex);
			high = high.cwiseMax(vertex);
		}
		polyhedron = placed;
	} else {
		throw std::logic_error("Surface: the shape is neither facet nor box nor wall nor polyhedron");
	}
}

Vector3r Surface::nearest(const Vector3r& p) const
{
	if (kind == Kind::facet) return nearestOnTriangle(p, corners[0], corners[1], corners[2]);
	if (kind == Kind::polyhedron) {
		const contactdynamics::SurfacePoint found = contactdynamics::nearestOnSurface(*polyhedron, p);
		return found.distance > 0 ? found.place : p;
	}
	const Vector3r offset = p - centre;
	if (kind == Kind::wall) return p - offset.dot(corners[0]) * corners[0];
	Vector3r point = p; // moved to the box along its axes, as far as needed
	for (const Vector3r& half : corners) {
		const Real squared = half.squaredNorm();
		if (!(squared > 0)) continue;
		const Real place = offset.dot(half) / squared;
		if (std::abs(place) > 1) point += (std::clamp(place, Real(-1), Real(1)) - place) * half;
	}
	return point;
}

Real Surface::extent(const Vector3r& n) const
{
	switch (kind) {
	case Kind::facet:
		return std::max({n.dot(corners[0]), n.dot(corners[1]), n.dot(corners[2])});
	case Kind::box:
		return n.dot(centre) + std::abs(n.dot(corners[0])) + std::abs(n.dot(corners[1])) + std::abs(n.dot(corners[2]));
	case Kind::polyhedron:
		return polyhedron->highest(n);
	default:
		return std::abs(n.dot(corners[0])) == 1 ? n.dot(centre) : std::numeric_limits<Real>::infinity();
	}
}

Real Surface::size() const
{
	switch (kind) {
	case Kind::facet:
		return std::max({corners[0].norm(), corners[1].norm(), corners[2].norm()});
	case Kind::box:
		return centre.norm() + corners[0].norm() + corners[1].norm() + corners[2].norm();
	case Kind::polyhedron:
		return centre.norm() + polyhedron->shape->radius;
	default:
		return std::abs(centre.dot(corners[0]));
	}
}

Vector3r Surface::faceNormal() const
{
	const Vector3r areaNormal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
	const Real length = areaNormal.norm();
	return length > 0 ? Vector3r(areaNormal / length) : Vector3r(Vector3r::Zero());
}

bool Surface::insideEdge(const Vector3r& p, Real close) const
{
	for (const Vector3r& corner : corners)
		if ((p - corner).norm() <= close) return false;
	for (int i = 0; i < 3; i++) {
		const Vector3r &a = corners[i], along = corners[(i + 1) % 3] - a;
		if ((p - a).cross(along).norm() <= close * along.norm()) return true;
	}
	return false;
}

} // namespace yade
