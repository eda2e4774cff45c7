// SPDX-License-Identifier: GPL-2.0-or-later
#include "Bodies.hpp"

#include <gtest/gtest.h>
#include <algorithm>
#include <stdexcept>

using namespace bodies;
using contactdynamics::convexHull;
using contactdynamics::cuboid;

TEST(ConvexShape, CuboidHasSixOutwardFaces)
{
	const ConvexShape box = cuboid({1, 2, 3});
	EXPECT_EQ(box.vertices.size(), 8u);
	EXPECT_EQ(box.edges.size(), 12u);
	ASSERT_EQ(box.faces.size(), 6u);
	for (const ConvexShape::Face& face : box.faces) {
		EXPECT_EQ(face.offset, std::abs(face.normal.dot(Vector3(1, 2, 3))));
		const Vector3 &a = box.vertices[box.loops[face.first]], &b = box.vertices[box.loops[face.first + 1]],
					  &c = box.vertices[box.loops[face.first + 2]];
		EXPECT_GT((b - a).cross(c - b).dot(face.normal), 0);
	}
}

TEST(ConvexShape, HullOfATurnedCubeHasFacesOfFourCorners)
{
	// Turned, the corners of a face are coplanar to round-off only.
	Random random(3);
	for (int attempt = 0; attempt < 100; attempt++) {
		const PlacedShape turned = placed(cuboid({1, 1, 1}), {0, 0, 0}, random.rotation());
		const ConvexShape hull = convexHull(turned.vertices);
		ASSERT_EQ(hull.faces.size(), 6u);
		EXPECT_EQ(hull.vertices.size(), 8u);
		EXPECT_EQ(hull.edges.size(), 12u);
		for (const ConvexShape::Face& face : hull.faces) EXPECT_EQ(face.count, 4);
	}
}

TEST(ConvexShape, HullLeavesOutInnerPointsAndDoubles)
{
	std::vector<Vector3> points = cuboid({1, 1, 1}).vertices;
	points.insert(points.begin(), {Vector3(0, 0, 0), Vector3(0.5, 0, 1), points[3]});
	const ConvexShape hull = convexHull(points);
	EXPECT_EQ(hull.vertices.size(), 8u);
	EXPECT_EQ(hull.faces.size(), 6u);
}

TEST(ConvexShape, HullObeysEuler)
{
	Random random(5);
	for (int attempt = 0; attempt < 300; attempt++) {
		std::vector<Vector3> points(4 + random.below(40));
		for (Vector3& point : points) point = random.vector();
		const ConvexShape hull = convexHull(points);
		EXPECT_EQ(hull.vertices.size() + hull.faces.size(), hull.edges.size() + 2);
		for (const ConvexShape::Face& face : hull.faces)
			for (const Vector3& point : points) EXPECT_LE(face.normal.dot(point), face.offset + 1e-11);
	}
}

TEST(ConvexShape, RefusesWhatHasNoVolume)
{
	EXPECT_THROW(convexHull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), std::invalid_argument);
	EXPECT_THROW(convexHull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}), std::invalid_argument);
	EXPECT_THROW(convexHull({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}, {4, 4, 4}}), std::invalid_argument);
	EXPECT_THROW(convexHull({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}), std::invalid_argument);
	EXPECT_THROW(convexHull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, std::nan("")}}), std::invalid_argument);
	EXPECT_THROW(contactdynamics::plate({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}), std::invalid_argument);
}

TEST(ConvexShape, HullDoesNotDependOnTheOrderOfThePoints)
{
	Random random(8);
	for (int attempt = 0; attempt < 50; attempt++) {
		std::vector<Vector3> points(20);
		for (Vector3& point : points) point = random.vector();
		const ConvexShape before = convexHull(points);
		std::reverse(points.begin(), points.end());
		const ConvexShape after = convexHull(points);
		EXPECT_EQ(before.vertices, after.vertices);
		EXPECT_EQ(before.loops, after.loops);
	}
}

/// Nor where a corner rises above a face by just about what counts as coplanar.
TEST(ConvexShape, CoplanarDoesNotDependOnTheOrderOfThePoints)
{
	const double diagonal = std::sqrt(8 * 8 + 1 + 1);
	std::size_t joined = 0, apart = 0;
	for (double rise = 0.2; rise < 4; rise += 0.1) {
		std::vector<Vector3> points{{0.1, 0.2, 0.5 + rise * contactdynamics::coplanar * diagonal}};
		for (int i = 0; i < 8; ++i) points.emplace_back(i & 1 ? 4 : -4, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5);
		const std::size_t faces = convexHull(points).faces.size();
		(faces == 6 ? joined : apart) += 1;
		for (std::size_t turn = 1; turn < points.size(); ++turn) {
			std::rotate(points.begin(), points.begin() + 1, points.end());
			EXPECT_EQ(convexHull(points).faces.size(), faces) << rise;
		}
	}
	EXPECT_GT(joined, 0u);
	EXPECT_GT(apart, 0u);
}
