// SPDX-License-Identifier: GPL-2.0-or-later
// Random pairs of shapes of every awkward kind against CGAL. The quick run has 1,500 pairs; CONTACTDYNAMICS_ATTACKS=100000 makes the long one,
// CONTACTDYNAMICS_FIRST_ATTACK=50000 its second half.
#include "Bodies.hpp"
#include "IndependentDistance.hpp"

#include <gtest/gtest.h>
#include <cstdlib>

using namespace bodies;
using contactdynamics::convexHull;
using contactdynamics::cuboid;
using contactdynamics::plate;

namespace {
int attacks()
{
	const char* asked = std::getenv("CONTACTDYNAMICS_ATTACKS");
	return asked ? std::atoi(asked) : 1500;
}

/// Pairs before it are made, so that the others are the same, but not looked at.
int firstAttack()
{
	const char* asked = std::getenv("CONTACTDYNAMICS_FIRST_ATTACK");
	return asked ? std::atoi(asked) : 0;
}

ConvexShape anyShape(Random& random)
{
	switch (random.below(6)) {
	case 0:
		return cuboid(0.55 * Vector3::Ones() + 0.45 * random.vector());
	case 1: { // plate or needle
		Vector3 half = 0.55 * Vector3::Ones() + 0.45 * random.vector();
		half[random.below(3)] *= std::pow(10., -1 - random.below(5));
		return cuboid(half);
	}
	case 2: { // sliver: a tetrahedron almost without volume
		std::vector<Vector3> corners(4);
		do
			for (Vector3& corner : corners) corner = random.vector();
		while ((corners[1] - corners[0]).cross(corners[2] - corners[0]).norm() < 0.1);
		corners[3] = 0.4 * corners[0] + 0.35 * corners[1] + 0.25 * corners[2] +
					 std::pow(10., -2 - random.below(5)) * (corners[1] - corners[0]).cross(corners[2] - corners[0]);
		return convexHull(corners);
	}
	case 3: {
		Vector3 a, b, c;
		do {
			a = random.vector();
			b = random.vector();
			c = random.vector();
		} while ((b - a).cross(c - a).norm() < 0.01);
		return plate({a, b, c});
	}
	default: {
		std::vector<Vector3> points(4 + random.below(16));
		for (Vector3& point : points) point = random.vector();
		return convexHull(points);
	}
	}
}

struct Pair {
	ConvexShape shape1, shape2;
	Eigen::Matrix3d rotation1, rotation2;
	Vector3 position1, position2;
	double size;
};

Pair anyPair(Random& random)
{
	const double spread = random.below(2) ? 1 : 0.1; // close together they mostly overlap
	Pair pair{anyShape(random), anyShape(random), random.rotation(), random.rotation(), spread * random.vector(), spread * random.vector(), 1};
	if (random.below(3) == 0) pair.shape2 = pair.shape1;
	if (random.below(3) == 0) { // nearly parallel faces, or exactly
		const double tilt = random.below(2) ? std::pow(10., -2 - random.below(13)) : 0;
		pair.rotation2 = Eigen::AngleAxisd(tilt, random.vector().normalized()).toRotationMatrix() * pair.rotation1;
	}
	if (random.below(6) == 0) pair.rotation1 = pair.rotation2 = Eigen::Matrix3d::Identity();
	// Along a random direction, or a face normal of the first, at a chosen distance of the bodies: touching, deep, apart.
	PlacedShape one = placed(pair.shape1, pair.position1, pair.rotation1), two = placed(pair.shape2, pair.position2, pair.rotation2);
	const Vector3 direction = random.below(2) ? random.vector().normalized() : one.normals[random.below(static_cast<int>(one.normals.size()))];
	const double asked[] = {0, 0, 1e-12, -1e-12, 1e-9, -1e-9, 1e-6, -1e-6, 1e-3, -1e-3, 0.1, -0.1, -0.5, 0.4 * random()};
	if (random.below(4)) pair.position2 += (asked[random.below(14)] - (two.lowest(direction) - one.highest(direction))) * direction;
	const double scale = std::pow(10., random.below(13) - 6), scale2 = random.below(8) ? 1 : std::pow(10., -random.below(4));
	for (Vector3& vertex : pair.shape1.vertices) vertex *= scale;
	for (Vector3& vertex : pair.shape2.vertices) vertex *= scale * scale2;
	pair.shape1.complete();
	pair.shape2.complete();
	pair.position1 *= scale;
	pair.position2 *= scale;
	pair.size = scale;
	return pair;
}
} // namespace

TEST(UnderAttack, GapAgreesWithCgalAndFrameIsFinite)
{
	Random random(2024);
	double worst = 0;
	const int pairs = attacks();
	int touching = 0, apart = 0;
	for (int i = 0; i < pairs; i++) {
		const Pair pair = anyPair(random);
		if (i < firstAttack()) continue;
		const PlacedShape one = placed(pair.shape1, pair.position1, pair.rotation1), two = placed(pair.shape2, pair.position2, pair.rotation2);
		const Found found = contact(one, two, 10 * pair.size);
		const double truth = independentDistance(one.vertices, two.vertices);
		(truth > 0 ? apart : touching)++;
		worst = std::max(worst, std::abs(found.separation.gap - truth) / pair.size);
		ASSERT_NEAR(found.separation.gap, truth, 1e-9 * pair.size) << "pair " << i << " feature " << found.separation.feature.kind;
		ASSERT_NEAR(found.separation.normal.norm(), 1, 1e-14) << "pair " << i;
		ASSERT_FALSE(found.points.empty()) << "pair " << i;
		double least = found.points[0].gap;
		for (const auto& point : found.points) {
			ASSERT_TRUE(point.place.allFinite() && std::isfinite(point.gap)) << "pair " << i;
			least = std::min(least, point.gap);
		}
		// The nearest of the points is at the distance of the bodies, whatever pair of features it is; where two edges run one above the other,
		// parallel to less than that, its far end may stand for it.
		const double missed = contactdynamics::steady * std::min(one.shape->radius, two.shape->radius);
		ASSERT_NEAR(least, truth, missed + 1e-8 * pair.size)
				<< "pair " << i << " feature " << found.separation.feature.kind << " points " << found.points.size();
	}
	RecordProperty("worst", std::to_string(worst));
	std::printf("%d pairs, %d overlapping, %d apart: largest deviation %.2e of the size\n", pairs, touching, apart, worst);
}

TEST(UnderAttack, SymmetricUnderExchange)
{
	Random random(77);
	for (int i = 0; i < attacks(); i++) {
		const Pair pair = anyPair(random);
		if (i < firstAttack()) continue;
		const PlacedShape one = placed(pair.shape1, pair.position1, pair.rotation1), two = placed(pair.shape2, pair.position2, pair.rotation2);
		const double reach = 0.05 * pair.size;
		const Found there = contact(one, two, reach), back = contact(two, one, reach);
		ASSERT_EQ(there.points.empty(), back.points.empty()) << "pair " << i;
		if (there.points.empty()) continue;
		ASSERT_NEAR(there.separation.gap, back.separation.gap, 1e-12 * pair.size) << "pair " << i;
		// The same direction, or another one that parts the bodies as well.
		const Vector3 opposite = -back.separation.normal;
		ASSERT_NEAR(two.lowest(opposite) - one.highest(opposite), two.lowest(there.separation.normal) - one.highest(there.separation.normal),
					1e-9 * pair.size)
				<< "pair " << i;
	}
}

TEST(UnderAttack, SameAtEveryScale)
{
	// Powers of two change no digit: the result must be the same bits, scaled.
	Random random(5);
	for (int i = 0; i < 1000; i++) {
		Pair pair = anyPair(random);
		const auto found = [&] {
			return contact(placed(pair.shape1, pair.position1, pair.rotation1), placed(pair.shape2, pair.position2, pair.rotation2), 0.1 * pair.size);
		};
		const Found before = found();
		const double scale = std::ldexp(1, 20);
		for (ConvexShape* shape : {&pair.shape1, &pair.shape2}) {
			for (Vector3& vertex : shape->vertices) vertex *= scale;
			shape->complete();
		}
		pair.position1 *= scale;
		pair.position2 *= scale;
		pair.size *= scale;
		const Found after = found();
		ASSERT_EQ(before.points.size(), after.points.size()) << "pair " << i;
		ASSERT_EQ(before.separation.gap * scale, after.separation.gap) << "pair " << i;
		for (std::size_t k = 0; k < before.points.size(); k++) ASSERT_EQ(before.points[k].gap * scale, after.points[k].gap) << "pair " << i;
	}
}
