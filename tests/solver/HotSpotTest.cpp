// SPDX-License-Identifier: GPL-2.0-or-later
// Contacts that sweeps cannot settle, taken out of the collection and solved on their own.
#include "IndependentResidual.hpp"
#include "Scenes.hpp"
#include "pkg/solver/HotSpotSolver.hpp"
#include "pkg/solver/SignoriniCoulombLoop.hpp"
#include "pkg/solver/SignoriniCoulombSolver.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>

using namespace contactdynamics;

namespace {

/// A ball of mass 1 on the floor, two of mass 100 that come down on it from the sides, mu = 0.5, three contacts. At the solution the sweep has a pair
/// of complex eigenvalues outside the unit circle: it goes round for ever, with momentum as without.
GrainProblem squashed(int ballsAfar = 0)
{
	GrainProblem problem;
	problem.bodies = {scenes::wall(), scenes::ball(1, 1, {0.05, -0.05, -1}), scenes::ball(100, 1, {-0.96, 0.81, -0.62}),
					  scenes::ball(100, 1, {-0.43, -0.76, -0.01})};
	const Vector3 first = Vector3(0.76, 0.19, 0.62).normalized(), second = Vector3(0.23, 0.9, 0.38).normalized();
	problem.contacts = {scenes::touch(0, 0, 1, 1, Vector3::UnitZ(), 0.5), scenes::touch(1, 1, 2, 1, first, 0.5),
						scenes::touch(1, 1, 3, 1, second, 0.5)};
	for (int i = 0; i < ballsAfar; ++i) { // each on the floor by itself
		problem.bodies.push_back(scenes::ball(1, 1, {0.3, 0, -1}));
		problem.contacts.push_back(scenes::touch(0, 0, int(problem.bodies.size()) - 1, 1, Vector3::UnitZ(), 0.5));
	}
	return problem;
}

SolverOptions fine(Acceleration acceleration)
{
	SolverOptions options;
	options.tolerance = 1e-8;
	options.maxIterations = 20000;
	options.acceleration = acceleration;
	return options;
}

} // namespace

TEST(HotSpot, SweepsGoRoundForEver)
{
	GrainProblem problem = squashed();
	SignoriniCoulombSolver solver;
	EXPECT_EQ(solver.solve(problem, fine(Acceleration::none)).status, SolveStatus::maxIterations);
	problem = squashed();
	Crew crew(1);
	GrainOperator op;
	op.start(problem, true, crew);
	EXPECT_GT(signoriniCoulombLoop(op, fine(Acceleration::momentum)).residual, 1e-4);
}

TEST(HotSpot, AreSolvedAllTheSame)
{
	for (const int ballsAfar : {0, 500}) {
		GrainProblem problem = squashed(ballsAfar), given = problem;
		SignoriniCoulombSolver solver;
		const SolveReport report = solver.solve(problem, fine(Acceleration::momentum));
		EXPECT_EQ(report.status, SolveStatus::converged);
		EXPECT_GT(report.newtonSteps, 0);
		EXPECT_LE(independent::residual(given, problem), 1e-8);
	}
}

/// Nothing is lost or moved by what a spot does not change: put back as they were taken, impulses and velocities are those of before.
TEST(HotSpot, PutBackAsTakenChangesNothing)
{
	for (const bool general : {false, true}) {
		GrainProblem problem = scenes::heap(6, 3, 0.5, true, general);
		Crew crew(1);
		GrainOperator op;
		op.start(problem, true, crew);
		for (int i = 0; i < 20; ++i) op.sweep({0.3, 0.2});
		const double before = op.certificate();
		HotSpot spot;
		ASSERT_TRUE(op.takeHotSpot(spot));
		EXPECT_GT(spot.problem.contacts.size(), 3u);
		std::size_t loaded = 0;
		for (const Contact& c : spot.problem.contacts) loaded += !c.impulse.isZero(0);
		EXPECT_LE(loaded, spot.room);
		op.putHotSpot(spot);
		const double eps = std::numeric_limits<double>::epsilon();
		EXPECT_NEAR(op.certificate(), before, 1e3 * eps); // the certificate rebuilds some thousand velocities from some thousand impulses
	}
}

/// A spot taken out stands for itself: its bodies with its impulses have the velocities that they have in the collection.
TEST(HotSpot, IsAProblemOfItsOwn)
{
	for (const bool general : {false, true}) {
		GrainProblem problem = scenes::heap(6, 3, 0.5, true, general);
		Crew crew(1);
		GrainOperator op;
		op.start(problem, true, crew);
		for (int i = 0; i < 20; ++i) op.sweep({});
		HotSpot spot;
		ASSERT_TRUE(op.takeHotSpot(spot));
		const GrainProblem part = spot.problem;
		const auto own = independent::velocities(part, part);
		SolveReport report;
		op.certificate();
		op.finish(report);
		// Found again by the velocity that no impulse of the spot changes: the centre of mass stays where it is.
		for (std::size_t i = 0; i < part.bodies.size(); ++i) {
			const auto same = std::find_if(problem.bodies.begin(), problem.bodies.end(), [&](const Body& b) {
				return b.centre == part.bodies[i].centre && b.inverseMass == part.bodies[i].inverseMass;
			});
			ASSERT_NE(same, problem.bodies.end());
			EXPECT_NEAR((own[i].head<3>() - same->velocity).norm(), 0, 1e-12) << i;
			EXPECT_NEAR((own[i].tail<3>() - same->angularVelocity).norm(), 0, 1e-11) << i;
		}
	}
}

TEST(HotSpot, LeavesAloneWhatItCannotHold)
{
	GrainProblem problem = scenes::heap(4, 3);
	scenes::addRollingFriction(problem, 0.05);
	Crew crew(1);
	GrainOperator op;
	op.start(problem, true, crew);
	op.sweep({});
	HotSpot spot;
	EXPECT_FALSE(op.takeHotSpot(spot));
}
