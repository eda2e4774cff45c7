// SPDX-License-Identifier: GPL-2.0-or-later
// The certificate of the grains against the independent evaluation, wherever the sweeps happen to be.
#include "IndependentResidual.hpp"
#include "Scenes.hpp"
#include "pkg/solver/GrainOperator.hpp"
#include "pkg/solver/SignoriniCoulombSolver.hpp"

#include <gtest/gtest.h>

using namespace contactdynamics;

namespace {

/// After so many sweeps; mended first, as the loop does.
void expectIndependentResidual(const GrainProblem& free, int sweeps)
{
	GrainProblem problem = free;
	Crew crew(1);
	GrainOperator grains;
	grains.start(problem, true, crew);
	for (int i = 0; i < sweeps; ++i) grains.sweep(i % 3 ? Extrapolation{0.3, 0.2} : Extrapolation{});
	while (grains.mend()) grains.sweep({});
	const double residual = grains.certificate();
	SolveReport report;
	grains.finish(report);
	const double expected = independent::residual(free, problem);
	// Both are sums of some thousand terms; each F is a difference of impulses, so that round-off counts relative to these: with residuals above
	// 1e-6, 1e-16 times the condition of a velocity (masses to 1e2, some ten contacts a body) leaves nine digits.
	ASSERT_GT(expected, 1e-6);
	EXPECT_NEAR(residual, expected, 1e-9 * expected) << sweeps;
	double approach = 0;
	for (const Contact& c : problem.contacts) approach = std::max(approach, -(c.relativeVelocity.dot(c.normal) + c.gapVelocity));
	EXPECT_NEAR(report.maxApproachSpeed, approach, 1e-9 * approach) << sweeps;
}

} // namespace

TEST(Certificate, IsTheIndependentResidualWhereverTheSweepsAre)
{
	for (const double friction : {0.0, 0.4, 2.0})
		for (const bool heavy : {false, true})
			for (const bool general : {false, true})
				for (const int sweeps : {0, 1, 2, 5, 20}) {
					SCOPED_TRACE(testing::Message() << friction << heavy << general);
					expectIndependentResidual(scenes::heap(5, 3, friction, heavy, general), sweeps);
				}
}

TEST(Certificate, KnowsMeanFieldImmobileBodiesAndImages)
{
	GrainProblem problem = scenes::heap(5, 8, 0.4);
	std::mt19937_64 random(2);
	std::normal_distribution<double> normal;
	const auto vector = [&] { return Vector3(normal(random), normal(random), normal(random)); };
	for (std::size_t i = 3; i < problem.bodies.size(); i += 7) { // moving, but not to be moved
		problem.bodies[i].inverseMass.setZero();
		problem.bodies[i].inverseInertia.setZero();
	}
	problem.contacts.push_back(scenes::touch(3, 0.5, 10, 0.5, Vector3::UnitX(), 0.4, -1)); // neither can: no part in the residual
	for (std::size_t i = 0; i < problem.contacts.size(); i += 11) problem.contacts[i].imageVelocity = 0.3 * vector();
	for (const int sweeps : {0, 1, 5}) expectIndependentResidual(problem, sweeps);

	problem = scenes::heap(5, 9, 0.4, true);
	problem.meanField.emplace();
	problem.meanField->inverseMass.setConstant(1e-3);
	for (int k = 0; k < 9; ++k) problem.meanField->gradient(k / 3, k % 3) = 0.1 * normal(random);
	for (const int sweeps : {0, 1, 5}) expectIndependentResidual(problem, sweeps);
}

TEST(Certificate, OfGeneralContactsKnowsMeanFieldsHoweverLight)
{
	for (const double inverseMass : {1e-3, 1e6, 1e14, 1e18}) {
		GrainProblem problem = scenes::heap(4, 3, 0.3, false, true);
		problem.meanField.emplace();
		problem.meanField->inverseMass.setConstant(inverseMass);
		problem.meanField->gradient = -0.3 * Matrix3::Identity();
		for (const int sweeps : {0, 3}) expectIndependentResidual(problem, sweeps);
	}
	// A pair as heavy as that is next to a wall.
	for (const double mass : {1.0, 1e9, 1e18}) {
		GrainProblem problem;
		problem.bodies = {scenes::ball(mass, 1), scenes::ball(mass, 1, {0, 0, -1}), scenes::ball(1, 1), scenes::ball(1, 1, {0, 0, -1})};
		problem.contacts = {scenes::touch(0, 1, 1, 1, Vector3::UnitZ(), 0.3), scenes::touch(2, 1, 3, 1, Vector3::UnitZ(), 0.3)};
		for (Contact& c : problem.contacts) c.ball = false;
		problem.meanField.emplace();
		problem.meanField->inverseMass.setConstant(1);
		expectIndependentResidual(problem, 3);
	}
}

// Sleepers are seen again when they close, by a formula of their own.
TEST(Certificate, KnowsSleepersWithImagesAndMeanFields)
{
	std::mt19937_64 random(2);
	std::normal_distribution<double> normal;
	for (int kind = 0; kind < 32; ++kind) {
		SCOPED_TRACE(kind);
		const bool general = kind & 1, images = kind & 2, heavy = kind & 4; // what a heavy grain hits becomes faster than any at the start
		GrainProblem problem = scenes::heap(8, unsigned(kind / 8), 0.4, heavy, general);
		for (Contact& c : problem.contacts) c.gapVelocity *= 20; // far from closing, until the heap is on its way
		for (std::size_t i = 0; images && i < problem.contacts.size(); i += 5)
			problem.contacts[i].imageVelocity = 4 * Vector3(normal(random), normal(random), normal(random));
		if (!images) {
			problem.meanField.emplace();
			problem.meanField->inverseMass.setConstant(1e-3);
			for (int k = 0; k < 9; ++k) problem.meanField->gradient(k / 3, k % 3) = 3 * normal(random);
		}
		const GrainProblem free = problem;
		SolverOptions options;
		options.tolerance = 1e-5;
		const SolveReport report = SignoriniCoulombSolver().solve(problem, options);
		EXPECT_NEAR(report.residual, independent::residual(free, problem), 1e-8);
	}
}

TEST(Certificate, KnowsRollingFriction)
{
	for (const double friction : {0.0, 0.4})
		for (const bool general : {false, true})
			for (const int sweeps : {0, 1, 2, 5, 20}) {
				SCOPED_TRACE(testing::Message() << friction << general);
				GrainProblem problem = scenes::heap(5, 3, friction, false, general);
				scenes::addRollingFriction(problem, 0.05);
				expectIndependentResidual(problem, sweeps);
				for (std::size_t i = 3; i < problem.bodies.size(); i += 7) { // blocked rotations, all or one
					problem.bodies[i].inverseInertia.row(Eigen::Index(i % 2)).setZero();
					problem.bodies[i].inverseInertia.col(Eigen::Index(i % 2)).setZero();
					problem.bodies[i - 1].inverseInertia.setZero();
				}
				for (Contact& c : problem.contacts) c.ball = false;
				problem.meanField.emplace();
				problem.meanField->inverseMass.setConstant(1e-3);
				expectIndependentResidual(problem, sweeps);
			}
}

TEST(Certificate, KnowsRollingFrictionBeyondOneRunOfPacks)
{
	GrainProblem problem = scenes::heap(13, 3, 0.4, false, true);
	ASSERT_GT(problem.contacts.size(), 2 * 256U * packLanes); // runs of the certificate have 256 packs
	scenes::addRollingFriction(problem, 0.05);
	expectIndependentResidual(problem, 5);
}

TEST(Certificate, IsTheSameInAnyUnits)
{
	for (const double mass : {1e-60, 1.0, 1e60})
		for (const double speed : {1e-60, 1.0, 1e60})
			for (const int sweeps : {0, 1, 10}) {
				SCOPED_TRACE(testing::Message() << mass << ' ' << speed);
				GrainProblem problem = scenes::heap(4, 4, 0.4, true);
				for (Body& body : problem.bodies) {
					body.velocity *= speed;
					body.angularVelocity *= speed;
					body.inverseMass /= mass;
					body.inverseInertia /= mass;
				}
				for (Contact& c : problem.contacts) c.gapVelocity *= speed;
				expectIndependentResidual(problem, sweeps);
			}
}

/// Also where contacts that carried something at the point kept sleep at the other one: letIdleSleep() comes in between, at 8, 16 and 32 sweeps.
TEST(Certificate, IsThatOfThePointKept)
{
	for (const bool field : {false, true})
		for (const bool general : {false, true}) {
			GrainProblem problem = scenes::heap(6, 5, 0.6, true, general);
			if (field) {
				problem.meanField.emplace();
				problem.meanField->inverseMass.setConstant(1e-3);
			}
			const GrainProblem free = problem;
			Crew crew(1);
			GrainOperator grains;
			grains.start(problem, true, crew);
			const auto sweepAndMend = [&](int times) {
				for (int i = 0; i < times; ++i) {
					grains.sweep(i % 3 ? Extrapolation{0.3, 0.2} : Extrapolation{});
					grains.mend();
				}
			};
			sweepAndMend(3);
			const double early = grains.certificate();
			grains.keep();
			sweepAndMend(40);
			const double late = grains.certificate();
			ASSERT_LT(late, 0.5 * early);
			// The velocities are sums in another order: as above.
			grains.exchangeKept();
			EXPECT_NEAR(grains.certificate(), early, 1e-9 * early);
			grains.exchangeKept();
			EXPECT_NEAR(grains.certificate(), late, 1e-9 * late);
			// It goes on from there as from any other point.
			grains.exchangeKept();
			sweepAndMend(40);
			EXPECT_LT(grains.certificate(), 0.5 * early);
			grains.exchangeKept();
			EXPECT_NEAR(grains.certificate(), late, 1e-9 * late);
			SolveReport report;
			grains.finish(report);
			EXPECT_NEAR(independent::residual(free, problem), late, 1e-9 * late);
		}
}
