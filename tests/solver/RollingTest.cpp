// SPDX-License-Identifier: GPL-2.0-or-later
// Rolling and twisting friction: one ball against closed forms, heaps against the independent residual.
#include "IndependentResidual.hpp"
#include "Scenes.hpp"
#include "pkg/solver/GrainOperator.hpp"
#include "pkg/solver/SignoriniCoulombSolver.hpp"

#include <gtest/gtest.h>

using namespace contactdynamics;

namespace {

GrainProblem rollingHeap(int side, unsigned seed, double friction, double arm, bool general = false)
{
	GrainProblem problem = scenes::heap(side, seed, friction, false, general);
	scenes::addRollingFriction(problem, arm);
	return problem;
}

GrainProblem ballOnFloor(double friction, double rollingArm, double twistingArm, const Vector3& velocity, const Vector3& spin)
{
	GrainProblem problem;
	problem.bodies = {scenes::wall(), scenes::ball(2, 0.5, velocity, spin)};
	problem.contacts = {scenes::touch(0, 0, 1, 0.5, Vector3::UnitZ(), friction)};
	problem.rolling.resize(1);
	problem.rolling[0].rollingArm = rollingArm;
	problem.rolling[0].twistingArm = twistingArm;
	return problem;
}

SolveReport solve(GrainProblem& problem, double tolerance, Acceleration acceleration = Acceleration::momentum, int threads = 1)
{
	SignoriniCoulombSolver solver;
	SolverOptions options;
	options.tolerance = tolerance;
	options.maxIterations = 50000;
	options.acceleration = acceleration;
	options.threads = threads;
	return solver.solve(problem, options);
}

} // namespace

/// A ball that rolls without sliding at v has the momentum 7/5 m r v about the contact, of which the torque takes l R_N.
TEST(RollingFriction, TakesMomentumAboutTheContactAtItsLimit)
{
	const double m = 2, r = 0.5, v = 3, press = 0.1, arm = 0.02;
	GrainProblem problem = ballOnFloor(0.5, arm, 0, {v, 0, -press}, {0, v / r, 0});
	ASSERT_EQ(solve(problem, 1e-13).status, SolveStatus::converged);
	const double slower = arm * m * press / (1.4 * m * r);
	EXPECT_NEAR(problem.bodies[1].velocity[0], v - slower, 1e-12);
	EXPECT_NEAR(problem.bodies[1].angularVelocity[1], (v - slower) / r, 1e-12);
	EXPECT_NEAR(problem.rolling[0].torque[1], -arm * m * press, 1e-13);
}

TEST(RollingFriction, HoldsBelowItsLimit)
{
	const double m = 2, r = 0.5, v = 1e-3, press = 0.1, arm = 0.02;
	ASSERT_LT(1.4 * m * r * v, arm * m * press);
	GrainProblem problem = ballOnFloor(0.5, arm, 0, {v, 0, -press}, {0, v / r, 0});
	ASSERT_EQ(solve(problem, 1e-13).status, SolveStatus::converged);
	EXPECT_LT(problem.bodies[1].velocity.norm() + r * problem.bodies[1].angularVelocity.norm(), 1e-13);
	EXPECT_NEAR(problem.contacts[0].impulse[0], -m * v, 1e-13);
	EXPECT_NEAR(problem.rolling[0].torque[1], -1.4 * m * r * v, 1e-13); // the impulse alone would turn it backwards
}

/// Twist about the normal and rolling have limits of their own; a drive counts like the spin of body 2.
TEST(RollingFriction, TwistIsApartFromRolling)
{
	const double m = 2, r = 0.5, press = 0.1, arm = 0.03, J = 0.4 * m * r * r;
	GrainProblem problem = ballOnFloor(0, 0, arm, {0, 0, -press}, {0, 1, 5});
	problem.rolling[0].drive = {0, 0, -7};
	ASSERT_EQ(solve(problem, 1e-13).status, SolveStatus::converged);
	EXPECT_NEAR(problem.rolling[0].torque[2], arm * m * press, 1e-14);
	EXPECT_NEAR(problem.bodies[1].angularVelocity[2], 5 + arm * m * press / J, 1e-12);
	EXPECT_EQ(problem.bodies[1].angularVelocity[1], 1);
}

/// Nothing turns, as with driven rollers on a plate: the torque is at its limit against the rotation all the same, however slow that is.
TEST(RollingFriction, ReachesItsLimitWhereNothingTurns)
{
	const double m = 2, press = 0.1, arm = 0.02;
	for (const double spin : {300.0, 3.0, 1e-3, 1e-5}) {
		GrainProblem problem = ballOnFloor(0, arm, 0.5 * arm, {0, 0, -press}, {0, spin, -spin});
		problem.bodies[1].inverseInertia.setZero();
		const SolveReport report = solve(problem, 1e-8);
		ASSERT_EQ(report.status, SolveStatus::converged);
		EXPECT_LE(report.iterations, 3); // the first sweep finds the torque, the next one that nothing changes
		EXPECT_NEAR(problem.rolling[0].torque[1], -arm * m * press, 1e-9 * arm * m * press);
		EXPECT_NEAR(problem.rolling[0].torque[2], 0.5 * arm * m * press, 1e-9 * arm * m * press);
	}
}

/// Grains that meet in all directions: torques and impulses solved in turn mostly do not converge here.
TEST(RollingFriction, HeapsEndCertified)
{
	for (const double arm : {0.001, 0.01, 0.1, 0.3}) // radii 0.4 to 0.55
		for (const bool general : {false, true})
			for (const auto acceleration : {Acceleration::none, Acceleration::momentum})
				for (unsigned seed = 1; seed <= 5; ++seed) {
					if (arm > 0.1 && acceleration == Acceleration::none) continue; // takes 50,000 sweeps and more
					SCOPED_TRACE(testing::Message() << arm << ' ' << general << ' ' << seed);
					const GrainProblem free = rollingHeap(4, seed, 0.3, arm, general);
					GrainProblem problem = free;
					const SolveReport report = solve(problem, 1e-6, acceleration);
					EXPECT_EQ(report.status, SolveStatus::converged);
					EXPECT_NEAR(independent::residual(free, problem), report.residual, 1e-9 * report.residual); // as in CertificateTest
				}
}

/// Torques are a start like impulses: from a solution the first sweep changes nothing but round-off.
TEST(RollingFriction, WarmStartFromTheSolutionTakesOneSweep)
{
	for (const bool general : {false, true}) {
		const GrainProblem free = rollingHeap(6, 4, 0.3, 0.05, general);
		GrainProblem first = free;
		ASSERT_EQ(solve(first, 1e-8).status, SolveStatus::converged);
		GrainProblem second = free;
		for (std::size_t i = 0; i < free.contacts.size(); ++i) second.contacts[i].impulse = first.contacts[i].impulse;
		second.rolling = first.rolling;
		EXPECT_EQ(solve(second, 1.1e-8).iterations, 1); // the residual of before, and a sweep that makes it no larger
	}
}

/// Runs that are cut off hand back a point kept earlier, of either operator: impulses, torques, velocities and residual go together.
TEST(RollingFriction, WhatIsReturnedGoesTogether)
{
	for (const bool general : {false, true})
		for (const int most : {40, 600}) {
			const GrainProblem free = rollingHeap(5, 2, 1, 0.2, general);
			GrainProblem problem = free;
			SignoriniCoulombSolver solver;
			SolverOptions options;
			options.tolerance = 1e-10;
			options.maxIterations = most;
			const SolveReport report = solver.solve(problem, options);
			ASSERT_EQ(report.status, SolveStatus::maxIterations);
			EXPECT_NEAR(independent::residual(free, problem), report.residual, 1e-9 * report.residual);
			const independent::Velocities expected = independent::velocities(free, problem);
			for (std::size_t i = 0; i < expected.size(); ++i) // sums of some ten impulses of order 1
				EXPECT_LT((expected[i].tail<3>() - problem.bodies[i].angularVelocity).norm(), 1e-12) << i;
			for (const RollingFriction& one : problem.rolling) {
				const Contact& c = problem.contacts[one.contact];
				const double rn = c.impulse.dot(c.normal), along = one.torque.dot(c.normal);
				EXPECT_LE((one.torque - along * c.normal).norm(), one.rollingArm * rn + 1e-14);
				EXPECT_LE(std::abs(along), one.twistingArm * rn + 1e-14);
			}
		}
}

TEST(RollingFriction, SameBitsForAnyThreads)
{
	for (const int side : {12, 24}) { // 4 and 64 regions
		GrainProblem one = rollingHeap(side, 2, 0.3, 0.05, side == 12), two = one;
		const std::size_t count = one.contacts.size();
		ASSERT_TRUE(GrainOperator::isWorthThreads(count)) << count;
		solve(one, 1e-4, Acceleration::momentum, 1);
		solve(two, 1e-4, Acceleration::momentum, 3);
		for (std::size_t k = 0; k < one.rolling.size(); ++k) ASSERT_EQ(one.rolling[k].torque, two.rolling[k].torque) << k;
		for (std::size_t i = 0; i < one.contacts.size(); ++i) ASSERT_EQ(one.contacts[i].impulse, two.contacts[i].impulse) << i;
	}
}

TEST(RollingFriction, RefusesWhatCannotBe)
{
	GrainProblem problem = ballOnFloor(0.5, 0.02, 0, {1, 0, -0.1}, {0, 2, 0});
	problem.rolling[0].contact = 1;
	EXPECT_THROW(solve(problem, 1e-4), std::invalid_argument);
	problem.rolling[0].contact = 0;
	problem.rolling[0].twistingArm = -1;
	EXPECT_THROW(solve(problem, 1e-4), std::invalid_argument);
	problem.rolling[0].twistingArm = 0;
	problem.rolling.push_back(problem.rolling[0]); // twice
	EXPECT_THROW(solve(problem, 1e-4), std::invalid_argument);
	problem.rolling.pop_back();
	problem.rolling[0].torque[0] = std::numeric_limits<double>::quiet_NaN();
	EXPECT_EQ(solve(problem, 1e-4).status, SolveStatus::notFinite);
}
