// SPDX-License-Identifier: GPL-2.0-or-later
// What cannot be solved is told from what is only hard: chains between driven walls, heaps around them, high columns, heavy loads, loose tolerances.
#include "BlockScenes.hpp"
#include "Scenes.hpp"
#include "pkg/solver/BlockOperator.hpp"
#include "pkg/solver/GrainSqueeze.hpp"
#include "pkg/solver/SignoriniCoulombSolver.hpp"

#include <cmath>
#include <gtest/gtest.h>

using namespace contactdynamics;

namespace {

/// Masses of 1 kg, the last one of its own, on a line that cannot turn, each touching the next; the first touches a floor, the last, if so, a lid.
/// All fall with the speed given, the lid comes down with its own [m/s].
BlockProblem column(int masses, bool lid, double lidSpeed, double fall = 1, double last = 1)
{
	scenes::DenseMatrix H = scenes::DenseMatrix::Zero(2 * masses, 2 * (masses + lid));
	Eigen::VectorXd v = Eigen::VectorXd::Zero(2 * masses);
	for (int i = 0; i < masses + lid; ++i)
		for (int k = 0; k < 2; ++k) {
			if (i < masses) H(2 * i + k, 2 * i + k) = 1;
			if (i > 0) H(2 * (i - 1) + k, 2 * i + k) = -1;
		}
	for (int i = 0; i < masses; ++i) v[2 * i] = -fall;
	scenes::DenseMatrix inverseMass = scenes::DenseMatrix::Identity(2 * masses, 2 * masses);
	inverseMass.bottomRightCorner(2, 2) /= last;
	BlockProblem problem = scenes::blockProblem(2, H, inverseMass, v, 0.3);
	if (lid) problem.q[2 * masses] -= lidSpeed;
	return problem;
}

/// Both problems in one, with nothing in common.
BlockProblem together(const BlockProblem& a, const BlockProblem& b)
{
	BlockProblem both = a;
	const int blocks = int(a.column.size()), contacts = int(a.contacts());
	for (std::size_t i = 1; i < b.rowStart.size(); ++i) both.rowStart.push_back(b.rowStart[i] + blocks);
	for (const int j : b.column) both.column.push_back(j + contacts);
	const auto append = [](std::vector<double>& to, const std::vector<double>& from) { to.insert(to.end(), from.begin(), from.end()); };
	append(both.blocks, b.blocks);
	append(both.q, b.q);
	append(both.friction, b.friction);
	append(both.impulse, b.impulse);
	return both;
}

SolveStatus statusOf(BlockProblem problem, double tolerance, Measure measure, bool finish = true, int sweeps = 20000)
{
	SolverOptions options;
	options.tolerance = tolerance;
	options.maxIterations = sweeps;
	options.newtonFinish = finish;
	return solve(problem, options, measure).status;
}

} // namespace

TEST(Squeeze, BetweenDrivenWalls)
{
	for (const Measure measure : {Measure::naturalMap, Measure::siconos})
		for (const double tolerance : {1e-2, 1e-4, 1e-8})
			for (const bool finish : {false, true})
				for (const int masses : {1, 3, 10})
					for (const double fall : {1.0, 0.0}) {
						const SolveStatus status = statusOf(column(masses, true, 2, fall), tolerance, measure, finish);
						// Impulses grow by at most the approach in each sweep of so many masses, so the tightest tolerance may be out of reach.
						// At rest the contact that is left closing has no approach of its own, and a loose tolerance is met before its impulse tells.
						if (tolerance == 1e-4 || (tolerance > 1e-4 && fall > 0)) {
							EXPECT_EQ(status, SolveStatus::unbounded) << tolerance << ' ' << masses << ' ' << fall;
						} else if (tolerance < 1e-4) {
							EXPECT_NE(status, SolveStatus::converged) << tolerance << ' ' << masses << ' ' << fall;
						}
					}
}

TEST(Squeeze, OneAmongManyOthers)
{
	scenes::Wall wall;
	wall.rows = 6;
	const BlockProblem heap = scenes::wall(wall);
	const BlockProblem flat = column(1, true, 2);
	BlockProblem crushed = flat;
	crushed.dimension = 2;
	scenes::Wall plane = wall;
	plane.dimension = 2;
	EXPECT_EQ(statusOf(together(scenes::wall(plane), crushed), 1e-4, Measure::naturalMap), SolveStatus::unbounded);
	EXPECT_EQ(statusOf(scenes::wall(plane), 1e-4, Measure::naturalMap), SolveStatus::converged);
	EXPECT_EQ(statusOf(heap, 1e-4, Measure::naturalMap), SolveStatus::converged);
}

// The lid that only follows, and columns whose impulses are hundreds of times what stops one mass: hard, but solvable.
TEST(Squeeze, NoFalseAlarm)
{
	for (const double tolerance : {1e-1, 1e-2, 1e-4})
		for (const int masses : {1, 10, 60, 200})
			for (const bool finish : {false, true})
				for (const Measure measure : {Measure::naturalMap, Measure::siconos}) {
					EXPECT_NE(statusOf(column(masses, false, 0), tolerance, measure, finish, 3000), SolveStatus::unbounded)
							<< tolerance << ' ' << masses;
					EXPECT_NE(statusOf(column(masses, true, -1), tolerance, measure, finish, 3000), SolveStatus::unbounded)
							<< tolerance << ' ' << masses;
				}
}

namespace {

/// So many balls of 1 kg in a row along x between two walls that come with the speeds given; the balls fly with theirs [m/s].
GrainProblem rowOfBalls(int balls, double leftWall, double rightWall, double flight)
{
	GrainProblem problem;
	problem.bodies.push_back(scenes::wall());
	for (int i = 0; i < balls; ++i) problem.bodies.push_back(scenes::ball(1, 1, {flight, 0, 0}));
	problem.bodies.push_back(scenes::wall());
	problem.bodies.front().velocity[0] = leftWall;
	problem.bodies.back().velocity[0] = rightWall;
	for (int i = 0; i <= balls; ++i) problem.contacts.push_back(scenes::touch(i, i > 0, i + 1, i < balls, Vector3::UnitX(), 0.3));
	for (std::size_t i = 0; i < problem.bodies.size(); ++i) problem.bodies[i].centre = {2.0 * double(i), 0, 0};
	return problem;
}

/// A point of a problem: normal impulses, and the velocities of the contacts as they are to be [N s], [m/s].
GrainProblem at(GrainProblem problem, const std::vector<double>& impulses, const std::vector<double>& uN)
{
	for (std::size_t i = 0; i < problem.contacts.size(); ++i) {
		problem.contacts[i].impulse = impulses[i] * problem.contacts[i].normal;
		problem.contacts[i].relativeVelocity = uN[i] * problem.contacts[i].normal;
	}
	return problem;
}

/// Of all impulses, or of what they have that others lack.
double factorOf(const GrainProblem& free, const GrainProblem& point, const GrainProblem* others = nullptr)
{
	ImpulseSet impulses;
	impulses.take(point);
	if (others) impulses.subtract(*others);
	GrainSqueeze squeeze;
	squeeze.keepFree(free);
	return squeeze.factor(point, impulses);
}

} // namespace

TEST(Squeeze, WorkOverWhatIsNotInBalance)
{
	// Free approaches 1.5 (left) and 0.5; loads of 10 and 7 N s: work 10 x 0.5 + 7 x 1 = 12, 3 not in balance.
	const GrainProblem free = rowOfBalls(1, 1, -1, -0.5);
	GrainProblem point = at(free, {10, 7}, {-0.5, -1});
	EXPECT_DOUBLE_EQ(factorOf(free, point), 12 / (1.5 * 3));
	EXPECT_DOUBLE_EQ(factorOf(free, at(free, {10, 7}, {0.5, 0})), 0); // nothing closes
	EXPECT_DOUBLE_EQ(factorOf(free, at(free, {10, 1}, {-3, 5})), 1);  // best without the smaller load: 10 x 3 over 3 (its own approach) x 10
	const GrainProblem others = at(free, {4, 3}, {0, 0});
	EXPECT_DOUBLE_EQ(factorOf(free, point, &others), (6 * 0.5 + 4 * 1) / (1.5 * 2));
	for (Contact& c : point.contacts) c.gapVelocity = 0.25; // what closes is U + s
	EXPECT_DOUBLE_EQ(factorOf(free, point), (10 * 0.25 + 7 * 0.75) / (1.25 * 3));
	point.contacts[1].normalCompliance = 1e-6; // gives way, so the other contact has nothing to press against
	EXPECT_DOUBLE_EQ(factorOf(free, point), 10 * 0.25 / (1.25 * 10));
}

TEST(Squeeze, BlockedDirectionsAndTorquesCount)
{
	GrainProblem free = rowOfBalls(1, 1, -1, 0);
	GrainProblem point = at(free, {10, 10}, {-1, -1});
	point.contacts[0].impulse[1] = 3; // friction turns the ball of radius 1: 3 N s and 3 N m s
	EXPECT_DOUBLE_EQ(factorOf(free, point), 20.0 / 6);
	free.bodies[1].inverseMass[1] = 0;
	EXPECT_DOUBLE_EQ(factorOf(free, point), 20.0 / 3);
	point.rolling = {{0, 1, 1, Vector3::Zero(), {0, 0, 2}}}; // arm2 x r is -3 about z
	EXPECT_DOUBLE_EQ(factorOf(free, point), 20.0 / 1);
	point.rolling.push_back({1, 1, 1, Vector3::Zero(), {0, 0, -1}}); // on the wall; the ball, body 1, gets the opposite
	EXPECT_GT(factorOf(free, point), 1e10);
	point.rolling.pop_back();
	free.bodies[1].inverseInertia.setZero();
	EXPECT_GT(factorOf(free, point), 1e10); // in balance but for round-off
}

TEST(Squeeze, AMeanFieldIsOneMoreBody)
{
	// Two balls of radius 1 in a cell 4 m wide, each touching the other and its image; the cell is compressed at 1 per second.
	GrainProblem free;
	free.bodies = {scenes::ball(1, 1), scenes::ball(1, 1)};
	free.contacts = {scenes::touch(0, 1, 1, 1, Vector3::UnitX(), 0), scenes::touch(1, 1, 0, 1, Vector3::UnitX(), 0)};
	for (Contact& c : free.contacts) c.gapVelocity = -0.5; // and they overlap
	free.meanField.emplace();
	free.meanField->gradient(0, 0) = -1;
	GrainProblem point = at(free, {10, 10}, {-1, -1});
	EXPECT_GT(factorOf(free, point), 1e10); // its motion is given
	EXPECT_TRUE(std::isfinite(factorOf(free, point)));
	free.meanField->inverseMass(0, 0) = 1; // branches of 2 m: free approaches of 2.5 m/s each, and a moment of 40 N m s
	EXPECT_DOUBLE_EQ(factorOf(free, point), 20 * 1.5 / (5 * (40 / 2.0)));
	point.meanField->gradient(0, 0) = free.meanField->limit = 0.5; // it has no room left
	EXPECT_GT(factorOf(free, point), 1e10);
	point.meanField->gradient(0, 0) = -0.5; // on that side it has
	EXPECT_LT(factorOf(free, point), 1);
	free.meanField->inverseMass(0, 0) = 0;
	free.meanField->inverseMass(1, 1) = 1; // across
	EXPECT_GT(factorOf(free, point), 1e10);
	for (Contact& c : point.contacts) c.gapVelocity = 0; // with a cell at rest nothing closes any more
	free.meanField->gradient(0, 0) = 0;
	EXPECT_EQ(factorOf(free, point), 0);
}

TEST(Squeeze, GroupsAreApart)
{
	// A squeezed row beside one in which nothing closes, with loads that are larger and not in balance.
	const GrainProblem squeezed = rowOfBalls(2, 1, -1, 0);
	GrainProblem free = rowOfBalls(2, 0, 0, -1), point = free;
	const int first = int(free.bodies.size());
	free.bodies.insert(free.bodies.end(), squeezed.bodies.begin(), squeezed.bodies.end());
	for (Contact c : squeezed.contacts) {
		c.body1 += first;
		c.body2 += first;
		free.contacts.push_back(c);
	}
	point = at(free, {900, 500, 200, 50, 49, 50}, {0, 0, 0, -0.5, -0.5, -1});
	EXPECT_DOUBLE_EQ(factorOf(free, point), (50 * 0.5 + 49 * 0.5 + 50 * 1) / (1.5 * 2)); // approaches 1 and 0.5, a newton second on either ball
	// Moving bodies alone can part, however they press on each other, but not a ring of them.
	GrainProblem pair = rowOfBalls(2, 0, 0, 0);
	pair.contacts = {pair.contacts[1]};
	EXPECT_EQ(factorOf(pair, at(pair, {50}, {-5})), 0);
	pair.contacts.push_back(scenes::touch(2, 1, 1, 1, Vector3::UnitX(), 0)); // with its image
	pair.contacts[1].imageVelocity[0] = -1;
	EXPECT_GT(factorOf(pair, at(pair, {50, 50}, {0, -1})), 1e10);
	pair.contacts[1].imageVelocity[0] = 1;
	EXPECT_EQ(factorOf(pair, at(pair, {50, 50}, {0, -1})), 0);
}

// By virtual work the factor of any impulses at any point is at most the change of velocity that leads to an admissible one, over the approach.
TEST(Squeeze, NeverMoreThanTheWayToAnAdmissibleMotion)
{
	std::mt19937_64 random(3);
	std::normal_distribution<double> normal;
	std::uniform_real_distribution<double> uniform;
	const auto vector = [&] { return Vector3(normal(random), normal(random), normal(random)); };
	const auto velocityAt = [](const GrainProblem& p, const Contact& c) -> Vector3 {
		const Body &a = p.bodies[c.body1], &b = p.bodies[c.body2];
		return b.velocity + b.angularVelocity.cross(c.arm2) - a.velocity - a.angularVelocity.cross(c.arm1);
	};
	int telling = 0;
	for (int k = 0; k < 2000; ++k) {
		const int bodies = 2 + int(6 * uniform(random));
		GrainProblem admissible;
		for (int i = 0; i < bodies; ++i) admissible.bodies.push_back(i < 2 ? scenes::wall() : scenes::ball(1, 1));
		for (Body& b : admissible.bodies) b.velocity = vector(), b.angularVelocity = vector();
		GrainProblem point = admissible, free = admissible;
		double way = 0;
		for (int i = 2; i < bodies; ++i) {
			point.bodies[i].velocity += vector();
			point.bodies[i].angularVelocity += vector();
			free.bodies[i].velocity += vector();
		}
		for (int i = 0; i < 3 * bodies; ++i) {
			const int body1 = int(bodies * uniform(random)), body2 = int(bodies * uniform(random));
			if (body1 == body2) continue;
			Contact c = scenes::touch(body1, 1, body2, 1, vector().normalized(), 0);
			c.ball = false;
			c.arm1 = vector();
			c.arm2 = vector();
			c.gapVelocity = uniform(random) - velocityAt(admissible, c).dot(c.normal); // so admissible it is
			c.impulse = std::exp(2 * normal(random)) * c.normal;
			c.relativeVelocity = velocityAt(point, c);
			point.contacts.push_back(c);
		}
		std::vector<double> longestArm(bodies, 0);
		double largestApproach = 0;
		for (const Contact& c : point.contacts) {
			longestArm[c.body1] = std::max(longestArm[c.body1], c.arm1.norm());
			longestArm[c.body2] = std::max(longestArm[c.body2], c.arm2.norm());
			largestApproach = std::max(largestApproach, -velocityAt(free, c).dot(c.normal) - c.gapVelocity);
		}
		for (int i = 2; i < bodies; ++i) {
			const Body &from = point.bodies[i], &to = admissible.bodies[i];
			way = std::max({way, (to.velocity - from.velocity).norm(), longestArm[i] * (to.angularVelocity - from.angularVelocity).norm()});
		}
		if (largestApproach == 0) continue;
		const double factor = factorOf(free, point);
		ASSERT_LE(factor, 100 * way / largestApproach * (1 + 1e-9)) << k; // A is at least a hundredth of the largest
		telling += factor > 0.01 * way / largestApproach;
	}
	EXPECT_GT(telling, 500); // or the bound would say little
}

TEST(Squeeze, FactorOfBlocks)
{
	// Two masses of 1 kg between floor and lid, whose velocities change by 1 and 1: r.W r = 2 J.
	const BlockProblem problem = column(2, true, 2);
	using Vectors = std::vector<Eigen::Vector2d>;
	const Vectors r{{12, 0}, {11, 0}, {10, 0}}, u{{-0.5, 0}, {-0.5, 0}, {-1, 0}}, others{{2, 0}, {3, 0}, {4, 0}};
	EXPECT_DOUBLE_EQ(squeezeFactor<2>(problem, r, u), (12 * 0.5 + 11 * 0.5 + 10) / 2.0);
	EXPECT_DOUBLE_EQ(squeezeFactor<2>(problem, r, u, &others), (10 * 0.5 + 8 * 0.5 + 6) / 8.0); // by 2 and 2
	EXPECT_EQ(squeezeFactor<2>(problem, r, {{-0.002, 0}, {0, 0}, {0, 0}}), 0);					// too slow, against 1 m/s
}

TEST(Squeeze, PointsOfBlocksThatAreLost)
{
	// One mass of 1 kg between floor and lid, each with a free approach of 1 m/s: u = r_floor - r_lid - 1 and r_lid - r_floor - 1.
	const auto isLost = [](double floor, double lid) {
		BlockProblem problem = column(1, true, 2);
		problem.impulse = {floor, 0, lid, 0};
		return BlockOperator<2>(problem, Measure::naturalMap).isLost();
	};
	EXPECT_TRUE(isLost(1001, 1001));
	EXPECT_FALSE(isLost(999, 999));
	EXPECT_TRUE(isLost(1000.5, 1000.5 - 0.89)); // the floor keeps 0.11 m/s, and the lid is below a thousand
	EXPECT_FALSE(isLost(1000.5, 1000.5 - 0.91));
	EXPECT_TRUE(isLost(1e12, 1e12 + 1e6)); // velocities of any size
	EXPECT_FALSE(isLost(0, 0));
}

// Chains of which each contact keeps a part of the approach, and lids slower than a fall in a step: not noticed before.
TEST(Squeeze, ChainsAndPackings)
{
	SolverOptions options;
	options.maxIterations = 20000;
	for (const auto& [balls, lid, flight, tolerance] :
		 {std::tuple{10, 1.0, 0.0, 1e-2}, {10, 1.0, 0.0, 1e-4}, {20, 1.0, 0.0, 1e-4}, {10, 0.05, -1.0, 1e-4}, {1, 0.01, -1.0, 1e-4}})
		for (const Acceleration acceleration : {Acceleration::none, Acceleration::momentum}) {
			options.tolerance = tolerance;
			options.acceleration = acceleration;
			GrainProblem problem = rowOfBalls(balls, 0, -lid, flight);
			const SolveReport report = SignoriniCoulombSolver().solve(problem, options);
			ASSERT_LE(report.residual, tolerance);
			EXPECT_EQ(report.status, SolveStatus::unbounded) << balls << ' ' << lid << ' ' << flight << ' ' << tolerance;
		}
}

// All go up with the floor; as the impulses of a step start the next one, slow modes of the last one are still there.
TEST(Squeeze, NoFalseAlarmUnderAHeavyLoad)
{
	for (const double tolerance : {1e-2, 1e-3, 1e-4})
		for (const double load : {1.0, 1e3, 1e4})
			for (const int balls : {5, 20, 60}) {
				GrainProblem problem = scenes::column(balls, 1);
				problem.bodies[0].velocity[2] = 0.1;
				problem.bodies.back().inverseMass /= load;
				problem.bodies.back().inverseInertia /= load;
				SignoriniCoulombSolver solver;
				SolverOptions options;
				options.tolerance = tolerance;
				options.maxIterations = 5000;
				for (int step = 0; step < 20; ++step) {
					EXPECT_NE(solver.solve(problem, options).status, SolveStatus::unbounded)
							<< tolerance << ' ' << load << ' ' << balls << ' ' << step;
					for (std::size_t i = 1; i < problem.bodies.size(); ++i) problem.bodies[i].velocity[2] -= 1;
				}
			}
	for (const double tolerance : {1e-2, 1e-3, 1e-4})
		for (const double load : {1e3, 1e4})
			for (const int masses : {5, 30})
				for (const Measure measure : {Measure::naturalMap, Measure::siconos})
					EXPECT_NE(statusOf(column(masses, false, 0, 1, load), tolerance, measure, false), SolveStatus::unbounded)
							<< tolerance << ' ' << load << ' ' << masses;
}

namespace {

SolveStatus statusOf(GrainProblem problem, double tolerance, Acceleration acceleration)
{
	SolverOptions options;
	options.tolerance = tolerance;
	options.maxIterations = 20000;
	options.acceleration = acceleration;
	return SignoriniCoulombSolver().solve(problem, options).status;
}

/// A ball between two walls at this angle to the y axis, which come with 1 m/s each: it escapes along y unless friction locks it, mu >= tan(angle).
GrainProblem wedge(double angle, double friction)
{
	GrainProblem problem = rowOfBalls(1, 1, -1, 0);
	problem.contacts[0].normal = {std::cos(angle), std::sin(angle), 0};
	problem.contacts[1].normal = {std::cos(angle), -std::sin(angle), 0};
	for (Contact& c : problem.contacts) {
		c.arm1 = c.body1 == 1 ? c.normal : Vector3(Vector3::Zero());
		c.arm2 = c.body2 == 1 ? Vector3(-c.normal) : Vector3(Vector3::Zero());
		c.friction = friction;
	}
	return problem;
}

} // namespace

TEST(Squeeze, WhatCanAndWhatCannotGiveWay)
{
	const GrainProblem row = rowOfBalls(1, 1, -1, 0);
	GrainProblem tangential = row, normal = row, platens = row, follower = row, ring = rowOfBalls(3, 0, 0, 0);
	for (Contact& c : tangential.contacts) c.tangentialCompliance = 1e-3;
	for (Contact& c : normal.contacts) c.normalCompliance = 1e-3; // an impulse of 1000 N s stops them
	for (const int platen : {0, 2}) platens.bodies[platen] = scenes::ball(1, 1, platens.bodies[platen].velocity);
	for (const int platen : {0, 2}) platens.bodies[platen].inverseMass[0] = 0; // along the row only
	follower.bodies[2].velocity = follower.bodies[0].velocity;
	ring.contacts = {ring.contacts[1], ring.contacts[2], scenes::touch(3, 1, 1, 1, Vector3::UnitX(), 0.3)}; // the last with the image of the first
	GrainProblem wide = ring, limited = ring;
	for (GrainProblem* one : {&ring, &limited, &wide})
		for (Contact& c : one->contacts) c.gapVelocity = -2;
	for (GrainProblem* one : {&limited, &wide}) { // a cell 6 m wide has to stretch by 1 per second
		one->meanField.emplace();
		one->meanField->inverseMass(0, 0) = 1;
		one->meanField->limit = one == &wide ? 2 : 0.5;
	}
	for (const double tolerance : {1e-2, 1e-3})
		for (const Acceleration acceleration : {Acceleration::none, Acceleration::momentum}) {
			const auto verdict = [&](const GrainProblem& problem) { return statusOf(problem, tolerance, acceleration); };
			EXPECT_EQ(verdict(row), SolveStatus::unbounded);
			EXPECT_EQ(verdict(tangential), SolveStatus::unbounded);
			EXPECT_EQ(verdict(normal), SolveStatus::converged);
			EXPECT_EQ(verdict(platens), SolveStatus::unbounded);
			EXPECT_EQ(verdict(follower), SolveStatus::converged);
			EXPECT_EQ(verdict(ring), SolveStatus::unbounded);
			EXPECT_EQ(verdict(limited), SolveStatus::unbounded);
			EXPECT_EQ(verdict(wide), SolveStatus::converged);
			for (const double angle : {0.3, 0.1}) {
				EXPECT_EQ(verdict(wedge(angle, 0)), SolveStatus::converged) << angle;
				EXPECT_EQ(verdict(wedge(angle, 0.5 * std::tan(angle))), SolveStatus::converged) << angle;
				EXPECT_EQ(verdict(wedge(angle, 2 * std::tan(angle))), SolveStatus::unbounded) << angle;
			}
		}
}

TEST(Squeeze, ImpulsesOfEarlierSteps)
{
	// Huge ones that are in balance meet the tolerance after a sweep, whose increments say nothing yet.
	for (const double balls : {1, 3}) {
		GrainProblem squeezed = rowOfBalls(int(balls), 1, -1, 0), follower = rowOfBalls(int(balls), 1, 1, 0);
		for (GrainProblem* one : {&squeezed, &follower})
			for (Contact& c : one->contacts) c.impulse = 1e6 * c.normal;
		for (const Acceleration acceleration : {Acceleration::none, Acceleration::momentum}) {
			EXPECT_EQ(statusOf(squeezed, 1e-2, acceleration), SolveStatus::unbounded) << balls;
			EXPECT_NE(statusOf(follower, 1e-2, acceleration), SolveStatus::unbounded) << balls;
		}
	}
	// Heaps that fall on a floor which rises, from loads that are far too large.
	for (const unsigned seed : {1U, 2U, 3U})
		for (const double tolerance : {1e-1, 1e-3}) {
			GrainProblem heap = scenes::heap(3, seed, 0);
			heap.bodies[0].velocity[2] = 0.3;
			for (Contact& c : heap.contacts) c.impulse = 1000 * c.normal;
			EXPECT_NE(statusOf(heap, tolerance, Acceleration::momentum), SolveStatus::unbounded) << seed << ' ' << tolerance;
		}
}

// Newton's method and the central path go to infinity at once where one of several bodies is held in a vice that closes, and leave any velocities.
TEST(Squeeze, VicesAreNeverSolved)
{
	for (unsigned seed = 0; seed < 40; ++seed) {
		std::mt19937_64 random(seed);
		std::normal_distribution<double> normal;
		std::uniform_real_distribution<double> uniform;
		const int bodies = 3 + int(seed % 6);
		scenes::DenseMatrix H = scenes::DenseMatrix::Zero(3 * bodies, 6 * bodies);
		scenes::DenseMatrix inverseMass = scenes::DenseMatrix::Identity(3 * bodies, 3 * bodies);
		for (int body = 0; body < bodies; ++body) { // two walls each, or a wall and one of the bodies before
			inverseMass.block<3, 3>(3 * body, 3 * body) *= std::pow(10, 2 * uniform(random) - 1);
			const Vector3 n = Vector3(normal(random), normal(random), normal(random)).normalized(), t = n.unitOrthogonal(), s = n.cross(t);
			for (int side = 0; side < 2; ++side) {
				Matrix3 frame;
				frame << (side ? -n : n), t, s;
				const int column = 3 * (2 * body + side);
				H.block<3, 3>(3 * body, column) = frame;
				if (body > 0 && side == 0 && uniform(random) < 0.5) H.block<3, 3>(3 * int(body * uniform(random)), column) -= frame;
			}
		}
		Eigen::VectorXd v(3 * bodies);
		for (double& each : v) each = normal(random);
		BlockProblem problem = scenes::blockProblem(3, H, inverseMass, v, 0.1 + 0.5 * uniform(random));
		problem.q[0] -= 2; // both walls of the first body come
		problem.q[3] -= 2;
		for (const double tolerance : {1e-4, 1e-8})
			for (const Measure measure : {Measure::naturalMap, Measure::siconos})
				EXPECT_NE(statusOf(problem, tolerance, measure, true, 1000), SolveStatus::converged) << seed << ' ' << tolerance;
	}
}
