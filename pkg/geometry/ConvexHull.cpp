// SPDX-License-Identifier: GPL-2.0-or-later
#include "ConvexShape.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <stdexcept>

namespace contactdynamics {
namespace {
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

struct Facet { // of the hull before coplanar ones are joined
	std::array<std::int32_t, 3> corners;
	Vector3 areaNormal;
	int face = -1;
};

/// Facets numbered by their corners, each starting with the smallest: no trace of the order in which CGAL found them.
std::vector<Facet> facetsOfHull(const std::vector<Vector3>& points)
{
	std::map<std::array<double, 3>, std::int32_t> numberOf;
	std::vector<Kernel::Point_3> input;
	for (std::size_t i = 0; i < points.size(); i++) {
		const std::array<double, 3> place{points[i][0], points[i][1], points[i][2]};
		if (numberOf.emplace(place, static_cast<std::int32_t>(i)).second) input.emplace_back(place[0], place[1], place[2]);
	}
	Mesh hull;
	CGAL::convex_hull_3(input.begin(), input.end(), hull);
	// Points in one line or plane give a sheet, or nothing.
	if (hull.number_of_faces() < 4 || !CGAL::is_closed(hull)) throw std::invalid_argument("the vertices of the polyhedron lie in one plane");
	std::vector<Facet> facets;
	for (const auto f : hull.faces()) {
		std::array<std::int32_t, 3> corners{};
		int count = 0;
		for (const auto vertex : CGAL::vertices_around_face(hull.halfedge(f), hull)) {
			const auto& p = hull.point(vertex);
			corners.at(count++) = numberOf.at({p.x(), p.y(), p.z()});
		}
		std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
		facets.push_back({corners, (points[corners[1]] - points[corners[0]]).cross(points[corners[2]] - points[corners[0]])});
	}
	std::sort(facets.begin(), facets.end(), [](const Facet& one, const Facet& other) { return one.corners < other.corners; });
	return facets;
}

std::map<std::pair<std::int32_t, std::int32_t>, int> facetsByEdge(const std::vector<Facet>& facets)
{
	std::map<std::pair<std::int32_t, std::int32_t>, int> byEdge;
	for (std::size_t f = 0; f < facets.size(); f++)
		for (int i = 0; i < 3; i++) byEdge[{facets[f].corners[i], facets[f].corners[(i + 1) % 3]}] = static_cast<int>(f);
	return byEdge;
}

/// Joins facets to faces, growing from the largest facets, whose planes are the best defined, over neighbours that lie within `close` of the plane.
std::vector<Vector3> joinCoplanar(std::vector<Facet>& facets, const std::vector<Vector3>& points, double close)
{
	const auto byEdge = facetsByEdge(facets);
	std::vector<int> order(facets.size());
	std::iota(order.begin(), order.end(), 0);
	std::stable_sort(order.begin(), order.end(),
					 [&](int a, int b) { return facets[a].areaNormal.squaredNorm() > facets[b].areaNormal.squaredNorm(); });
	std::vector<Vector3> normals;
	for (const int seed : order) {
		if (facets[seed].face >= 0) continue;
		const Vector3 normal = facets[seed].areaNormal.normalized();
		const Vector3& origin = points[facets[seed].corners[0]];
		const int face = static_cast<int>(normals.size());
		std::vector<int> front{seed};
		facets[seed].face = face;
		while (!front.empty()) {
			const Facet& facet = facets[front.back()];
			front.pop_back();
			for (int i = 0; i < 3; i++) {
				const int neighbour = byEdge.at({facet.corners[(i + 1) % 3], facet.corners[i]});
				Facet& other = facets[neighbour];
				if (other.face >= 0 || !(other.areaNormal.dot(normal) >= 0)) continue;
				if (std::any_of(other.corners.begin(), other.corners.end(),
								[&](std::int32_t corner) { return std::abs(normal.dot(points[corner] - origin)) > close; }))
					continue;
				other.face = face;
				front.push_back(neighbour);
			}
		}
		normals.push_back(normal);
	}
	return normals;
}

/// Boundary of a face, starting at its smallest corner.
std::vector<std::int32_t> boundary(const std::vector<Facet>& facets, int face)
{
	std::map<std::pair<std::int32_t, std::int32_t>, bool> own;
	for (const Facet& facet : facets)
		if (facet.face == face)
			for (int i = 0; i < 3; i++) own[{facet.corners[i], facet.corners[(i + 1) % 3]}] = true;
	std::map<std::int32_t, std::int32_t> next;
	for (const auto& half : own)
		if (!own.count({half.first.second, half.first.first}) && !next.emplace(half.first).second)
			throw std::invalid_argument("a face of the hull touches itself");
	std::vector<std::int32_t> loop{next.begin()->first};
	while (next.at(loop.back()) != loop.front()) loop.push_back(next.at(loop.back()));
	if (loop.size() != next.size()) throw std::invalid_argument("a face of the hull has a hole");
	return loop;
}
} // namespace

ConvexShape convexHull(const std::vector<Vector3>& given)
{
	if (given.size() < 4) throw std::invalid_argument("a polyhedron needs at least four vertices");
	Vector3 least = given[0], most = given[0];
	for (const Vector3& point : given) {
		if (!point.allFinite()) throw std::invalid_argument("a vertex of the polyhedron is not finite");
		least = least.cwiseMin(point);
		most = most.cwiseMax(point);
	}
	const double size = (most - least).norm();
	// Programs that work hulls out themselves, as YADE does, may hand the same vertices over in another order in every process.
	std::vector<Vector3> points = given;
	std::sort(points.begin(), points.end(),
			  [](const Vector3& a, const Vector3& b) { return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3); });
	std::vector<Facet> facets = facetsOfHull(points);
	const std::vector<Vector3> normals = joinCoplanar(facets, points, coplanar * size);
	if (normals.size() < 4) throw std::invalid_argument("the vertices of the polyhedron lie in one plane");

	ConvexShape shape;
	std::map<std::int32_t, std::int32_t> numberOf; // of the vertices that are corners of a face
	std::vector<std::vector<std::int32_t>> boundaries;
	for (std::size_t face = 0; face < normals.size(); face++) {
		boundaries.push_back(boundary(facets, static_cast<int>(face)));
		for (const std::int32_t corner : boundaries.back()) numberOf[corner] = 0;
	}
	for (auto& [point, number] : numberOf) {
		number = static_cast<std::int32_t>(shape.vertices.size());
		shape.vertices.push_back(points[point]);
	}
	for (std::size_t face = 0; face < normals.size(); face++) {
		const auto& loop = boundaries[face];
		shape.faces.push_back({normals[face], 0, static_cast<std::int32_t>(shape.loops.size()), static_cast<std::int32_t>(loop.size())});
		for (const std::int32_t corner : loop) shape.loops.push_back(numberOf.at(corner));
	}
	shape.complete();
	return shape;
}

} // namespace contactdynamics
