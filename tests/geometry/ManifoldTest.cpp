// SPDX-License-Identifier: GPL-2.0-or-later
#include "Bodies.hpp"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>

using namespace bodies;
using contactdynamics::cuboid;
using contactdynamics::plate;

namespace {
const ConvexShape cube = cuboid({0.5, 0.5, 0.5});

/// Area of the convex polygon of the points, seen along z.
double supportArea(std::vector<ManifoldPoint> points)
{
	Vector3 middle = Vector3::Zero();
	for (const auto& point : points) middle += point.place / static_cast<double>(points.size());
	std::sort(points.begin(), points.end(), [&](const ManifoldPoint& a, const ManifoldPoint& b) {
		const Vector3 from = a.place - middle, to = b.place - middle;
		return std::atan2(from[1], from[0]) < std::atan2(to[1], to[0]);
	});
	double twice = 0;
	for (std::size_t i = 0; i < points.size(); i++) {
		const Vector3 &a = points[i].place, &b = points[(i + 1) % points.size()].place;
		twice += a[0] * b[1] - a[1] * b[0];
	}
	return twice / 2;
}
Eigen::Matrix3d turn(double angle, const Vector3& axis) { return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix(); }
} // namespace

TEST(Manifold, CubeOnCubeTouchesAtFourCorners)
{
	const Found found = contact(placed(cube, {0, 0, 0}), placed(cube, {0.2, 0.1, 1.001}), 0.01);
	EXPECT_EQ(found.separation.normal, Vector3(0, 0, 1));
	ASSERT_EQ(found.points.size(), 4u);
	for (const auto& point : found.points) {
		EXPECT_NEAR(point.gap, 0.001, 1e-15);
		EXPECT_NEAR(point.place[2], 0.5005, 1e-15);
	}
	EXPECT_NEAR(supportArea(found.points), 0.8 * 0.9, 1e-14);
}

TEST(Manifold, FlushCubesTouchAtFourCorners)
{
	// Corners of both coincide: each is one point, not two or three.
	for (const double overlap : {0., 1e-9, 1e-3}) {
		const Found found = contact(placed(cube, {0, 0, 0}), placed(cube, {0, 0, 1 - overlap}), 0.01);
		EXPECT_EQ(found.points.size(), 4u);
		EXPECT_NEAR(supportArea(found.points), 1, 1e-14);
	}
}

TEST(Manifold, CubeTurnedOnCubeTouchesAtEightPoints)
{
	const Found found = contact(placed(cube, {0, 0, 0}), placed(cube, {0, 0, 1}, turn(M_PI / 4, {0, 0, 1})), 0.01);
	ASSERT_EQ(found.points.size(), 8u);
	EXPECT_NEAR(supportArea(found.points), 2 * (std::sqrt(2) - 1), 1e-14); // regular octagon around the unit circle of diameter 1
}

TEST(Manifold, EdgeOnFaceTouchesAtTwoPoints)
{
	const Found found = contact(placed(cuboid({5, 5, 0.5}), {0, 0, 0}), placed(cube, {0, 0, 0.5 + std::sqrt(0.5)}, turn(M_PI / 4, {1, 0, 0})), 1e-3);
	EXPECT_NEAR((found.separation.normal - Vector3(0, 0, 1)).norm(), 0, 1e-15);
	ASSERT_EQ(found.points.size(), 2u);
	EXPECT_NEAR(std::abs(found.points[0].place[0] - found.points[1].place[0]), 1, 1e-14);
	for (const auto& point : found.points) EXPECT_NEAR(point.gap, 0, 1e-15);
}

TEST(Manifold, VertexOnFaceTouchesAtOnePoint)
{
	const Eigen::Matrix3d onCorner = Eigen::Quaterniond::FromTwoVectors(Vector3(1, 1, 1), Vector3(0, 0, -1)).toRotationMatrix();
	const Found found = contact(placed(cuboid({5, 5, 0.5}), {0, 0, 0}), placed(cube, {0.3, 0, 0.5 + std::sqrt(0.75)}, onCorner), 1e-3);
	ASSERT_EQ(found.points.size(), 1u);
	EXPECT_NEAR((found.points[0].place - Vector3(0.3, 0, 0.5)).norm(), 0, 1e-14);
}

TEST(Manifold, CrossedEdgesTouchAtOnePoint)
{
	const double up = std::sqrt(0.5);
	const Found found =
			contact(placed(cube, {0, 0, 0}, turn(M_PI / 4, {1, 0, 0})), placed(cube, {0.1, 0.2, 2 * up - 1e-4}, turn(M_PI / 4, {0, 1, 0})), 1e-3);
	EXPECT_EQ(found.separation.feature.kind, DecidingFeature::edges);
	EXPECT_NEAR(found.separation.gap, -1e-4, 1e-15);
	ASSERT_EQ(found.points.size(), 1u);
	EXPECT_NEAR((found.points[0].place - Vector3(0.1, 0, up - 5e-5)).norm(), 0, 1e-14);
}

TEST(Manifold, ParallelEdgesTouchAtTwoPoints)
{
	// Two cubes balanced edge on edge, the upper one moved along the edge.
	const double up = std::sqrt(0.5);
	const Found found =
			contact(placed(cube, {0, 0, 0}, turn(M_PI / 4, {1, 0, 0})), placed(cube, {0.25, 0, 2 * up + 1e-4}, turn(M_PI / 4, {1, 0, 0})), 1e-3);
	EXPECT_NEAR(found.separation.gap, 1e-4, 1e-15);
	EXPECT_NEAR(found.separation.normal[2], 1, 1e-12);
	ASSERT_EQ(found.points.size(), 2u);
	EXPECT_NEAR(std::abs(found.points[0].place[0] - found.points[1].place[0]), 0.75, 1e-12);
}

TEST(Manifold, CornerBesideCornerHasTheLineBetweenThemAsNormal)
{
	const Found found = contact(placed(cube, {0, 0, 0}), placed(cube, {1.03, 1.04, 1.12}), 1);
	EXPECT_NEAR(found.separation.gap, 0.13, 1e-15);
	EXPECT_NEAR((found.separation.normal - Vector3(3, 4, 12) / 13).norm(), 0, 1e-13);
	ASSERT_FALSE(found.points.empty());
	EXPECT_NEAR(found.points[0].gap, 0.13, 1e-13);
}

TEST(Manifold, TiltedCubeKeepsItsCornersWithTheirOwnGaps)
{
	const double tilt = 1e-3;
	const Found found = contact(placed(cuboid({5, 5, 0.5}), {0, 0, 0}), placed(cube, {0, 0, 1 + 0.0006}, turn(tilt, {0, 1, 0})), 0.01);
	ASSERT_EQ(found.points.size(), 4u);
	for (const auto& point : found.points) {
		// corner (x, z) = (±1/2, −1/2) turned about y
		const double x = point.place[0] > 0 ? 0.5 : -0.5;
		EXPECT_NEAR(point.gap, 0.5006 - x * std::sin(tilt) - 0.5 * std::cos(tilt), 1e-15);
	}
}

TEST(Manifold, PointsBeyondReachAreLeftOut)
{
	const Found found = contact(placed(cuboid({5, 5, 0.5}), {0, 0, 0}), placed(cube, {0, 0, 1.01}, turn(0.02, {0, 1, 0})), 0.005);
	ASSERT_EQ(found.points.size(), 2u);
	EXPECT_TRUE(contact(placed(cube, {0, 0, 0}), placed(cube, {0, 0, 1.02}), 0.01).points.empty());
}

TEST(Manifold, FeatureOfTheLastStepStays)
{
	// Equal overlap along x and z: whichever came first is kept while the other one gains by less than the margin.
	const PlacedShape one = placed(cube, {0, 0, 0});
	DecidingFeature last = contact(one, placed(cube, {0.9, 0, 0.901}), 0.01).separation.feature;
	for (const double z : {0.9000001, 0.9, 0.8999999, 0.8999995}) {
		const Found found = contact(one, placed(cube, {0.9, 0, z}), 0.01, last);
		EXPECT_EQ(found.separation.normal, Vector3(0, 0, 1)) << z;
		last = found.separation.feature;
	}
	EXPECT_EQ(contact(one, placed(cube, {0.9, 0, 0.89}), 0.01, last).separation.normal, Vector3(1, 0, 0));
}

TEST(Manifold, FeaturesFollowASlidingCorner)
{
	// The corners of the upper cube that stay on the lower one keep their identity while it slides.
	const PlacedShape one = placed(cube, {0, 0, 0});
	const auto features = [&](double x) {
		std::vector<int> all;
		for (const auto& point : contact(one, placed(cube, {x, 0.1, 1}), 0.01).points) all.push_back(point.feature);
		std::sort(all.begin(), all.end());
		return all;
	};
	EXPECT_EQ(features(0.1), features(0.4));
}

TEST(Manifold, TriangleHasTwoSides)
{
	const ConvexShape facet = plate({{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}});
	for (const double side : {1., -1.}) {
		const Found found = contact(placed(facet, {0, 0, 0}), placed(cuboid({0.1, 0.1, 0.1}), {0, 0, side * 0.0999}), 0.01);
		EXPECT_EQ(found.separation.normal, Vector3(0, 0, side));
		EXPECT_NEAR(found.separation.gap, -1e-4, 1e-16);
		EXPECT_EQ(found.points.size(), 4u);
		EXPECT_NEAR(supportArea(found.points), 0.04, 1e-15);
	}
}

TEST(Manifold, TriangleSmallerThanTheFaceIsSupportedAtItsCorners)
{
	const ConvexShape facet = plate({{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}});
	const Found found = contact(placed(facet, {0, 0, 0}), placed(cuboid({10, 10, 1}), {1, 2, 1.0001}), 0.01);
	EXPECT_EQ(found.points.size(), 3u);
	EXPECT_NEAR(supportArea(found.points), 2, 1e-14);
}
