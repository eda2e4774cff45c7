// SPDX-License-Identifier: GPL-2.0-or-later
#include "IndependentDistance.hpp"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Cartesian.h>
#include <CGAL/Gmpzf.h>
#include <CGAL/Polytope_distance_d.h>
#include <CGAL/Polytope_distance_d_traits_3.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>

#include <cmath>
#include <limits>

namespace {
using contactdynamics::Vector3;
using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
using Plain = CGAL::Cartesian<double>;
using Distance = CGAL::Polytope_distance_d<CGAL::Polytope_distance_d_traits_3<Plain, CGAL::Gmpzf, double>>;

double depth(const std::vector<Vector3>& one, const std::vector<Vector3>& two)
{
	std::vector<Exact::Point_3> differences;
	for (const Vector3& a : one)
		for (const Vector3& b : two) // exact differences of doubles
			differences.emplace_back(Exact::FT(b[0]) - Exact::FT(a[0]), Exact::FT(b[1]) - Exact::FT(a[1]), Exact::FT(b[2]) - Exact::FT(a[2]));
	CGAL::Surface_mesh<Exact::Point_3> hull;
	CGAL::convex_hull_3(differences.begin(), differences.end(), hull);
	double nearest = std::numeric_limits<double>::infinity();
	for (const auto face : hull.faces()) {
		const auto half = hull.halfedge(face);
		const auto &a = hull.point(hull.source(half)), &b = hull.point(hull.target(half)), &c = hull.point(hull.target(hull.next(half)));
		const Exact::Vector_3 normal = CGAL::cross_product(b - a, c - a);
		const Exact::FT height = normal * (a - CGAL::ORIGIN), square = normal.squared_length();
		nearest = std::min(nearest, std::sqrt(CGAL::to_double(height * height / square)));
	}
	return nearest;
}
} // namespace

double independentDistance(const std::vector<Vector3>& one, const std::vector<Vector3>& two)
{
	std::vector<Plain::Point_3> points1, points2;
	for (const Vector3& a : one) points1.emplace_back(a[0], a[1], a[2]);
	for (const Vector3& b : two) points2.emplace_back(b[0], b[1], b[2]);
	const Distance distance(points1.begin(), points1.end(), points2.begin(), points2.end());
	const CGAL::Quotient<CGAL::Gmpzf> square(distance.squared_distance_numerator(), distance.squared_distance_denominator());
	return square.numerator() > 0 ? std::sqrt(CGAL::to_double(square)) : -depth(one, two);
}
