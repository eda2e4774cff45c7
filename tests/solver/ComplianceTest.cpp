// SPDX-License-Identifier: GPL-2.0-or-later
// Contacts with an extra diagonal term on W: closed forms, and collections against the certificate written a second time.
#include "IndependentResidual.hpp"
#include "Scenes.hpp"
#include "pkg/solver/SignoriniCoulombSolver.hpp"

#include <gtest/gtest.h>

using namespace contactdynamics;

namespace {

SolverOptions tight(double tolerance)
{
	SolverOptions options;
	options.tolerance = tolerance;
	options.maxIterations = 100000;
	return options;
}

} // namespace

TEST(Compliance, OneBallMeetsTheClosedForm)
{
	// Unit ball: W = diag(1, 3.5, 3.5). r = -b / (W + c) on the normal, on the tangents likewise inside the cone.
	for (const bool ball : {true, false}) {
		GrainProblem problem;
		problem.bodies = {scenes::wall(), scenes::ball(1, 1, {0.1, 0, -2})};
		problem.contacts = {scenes::touch(0, 0, 1, 1, Vector3::UnitZ(), 0.4, 0.5)};
		Contact& c = problem.contacts[0];
		c.ball = ball;
		c.normalCompliance = 0.25;
		c.tangentialCompliance = 0.5;
		SignoriniCoulombSolver solver;
		const SolveReport report = solver.solve(problem, tight(1e-13));
		ASSERT_EQ(report.status, SolveStatus::converged);
		EXPECT_NEAR(c.impulse[2], 1.5 / 1.25, 1e-14);
		EXPECT_NEAR(c.impulse[0], -0.1 / 4, 1e-14);
		EXPECT_NEAR(c.relativeVelocity[2], -2 + 1.2, 1e-14); // of the bodies: the mortar takes the rest
		EXPECT_EQ(c.status, ContactStatus::sticking);
	}
}

TEST(Compliance, HeapIsCertifiedAndTendsToTheRigidOne)
{
	SignoriniCoulombSolver solver;
	GrainProblem rigid = scenes::heap(5, 3), nearly = rigid, soft = rigid, free = rigid;
	for (Contact& c : nearly.contacts) c.normalCompliance = c.tangentialCompliance = 1e-9;
	for (Contact& c : soft.contacts) c.normalCompliance = c.tangentialCompliance = 0.3;
	ASSERT_EQ(solver.solve(rigid, tight(1e-8)).status, SolveStatus::converged);
	ASSERT_EQ(solver.solve(nearly, tight(1e-8)).status, SolveStatus::converged);
	const SolveReport report = solver.solve(soft, tight(1e-8));
	ASSERT_EQ(report.status, SolveStatus::converged);
	double difference = 0, speed = 0;
	for (std::size_t i = 0; i < rigid.bodies.size(); ++i) {
		difference = std::max(difference, (rigid.bodies[i].velocity - nearly.bodies[i].velocity).norm());
		speed = std::max(speed, rigid.bodies[i].velocity.norm());
	}
	// Two solves to 1e-8 in the W-norm; a few hundred contacts share it.
	EXPECT_LT(difference, 1e-5 * speed);

	// The residual once more: a compliant contact is a rigid one whose image velocity and W have the mortar in them.
	double above = 0, below = 0;
	for (const Contact& c : soft.contacts) {
		const Matrix3 W = independent::delassus(free, c) + 0.3 * Matrix3::Identity();
		const Vector3 u = c.relativeVelocity + c.gapVelocity * c.normal + 0.3 * c.impulse, ut = u - u.dot(c.normal) * c.normal;
		const Vector3 F = c.impulse - independent::nearestInCone(c.impulse - (u + c.friction * ut.norm() * c.normal) / c.normal.dot(W * c.normal),
																 c.normal, c.friction);
		above += F.dot(W * F);
		below += c.impulse.dot(W * c.impulse);
	}
	EXPECT_NEAR(std::sqrt(above / below), report.residual, 1e-6 * report.residual + 1e-13);
}

TEST(Compliance, NegativeValuesAreRefused)
{
	GrainProblem problem = scenes::column(2, 1e-2);
	problem.contacts[1].normalCompliance = -1;
	SignoriniCoulombSolver solver;
	EXPECT_THROW(solver.solve(problem, tight(1e-6)), std::invalid_argument);
}
