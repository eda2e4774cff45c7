// SPDX-License-Identifier: GPL-2.0-or-later
// A velocity gradient shared by all bodies: closed forms, the certificate against a second implementation, and convergence whatever its inertia.
#include "IndependentResidual.hpp"
#include "Scenes.hpp"
#include "pkg/solver/AssembledGrains.hpp"
#include "pkg/solver/SignoriniCoulombSolver.hpp"

#include <gtest/gtest.h>
#include <cstring>

using namespace contactdynamics;

namespace {

SolverOptions tight(double tolerance, int threads = 1)
{
	SolverOptions options;
	options.tolerance = tolerance;
	options.maxIterations = 200000;
	options.threads = threads;
	return options;
}

MeanField field(double inertia, const Matrix3& gradient)
{
	MeanField made;
	made.gradient = gradient;
	made.inverseMass.setConstant(1 / inertia);
	return made;
}

double meanMomentOfMass(const GrainProblem& problem) // sum of m d^2, d about 1 in a heap
{
	double sum = 0;
	for (const Body& body : problem.bodies)
		if (body.inverseMass[0] > 0) sum += 1 / body.inverseMass[0];
	return sum;
}

} // namespace

TEST(MeanField, OneContactIsAnImpactOfBallsAndField)
{
	// Two balls along x, compressed by the field alone: the impulse stops the approach, R = -U / (1/m1 + 1/m2 + b^2/M).
	const double m1 = 2, m2 = 5, M = 3, b = 1.7;
	GrainProblem problem;
	problem.bodies = {scenes::ball(m1, 0.8), scenes::ball(m2, 0.9)};
	problem.contacts = {scenes::touch(0, 0.8, 1, 0.9, Vector3::UnitX(), 0)};
	Matrix3 gradient = Matrix3::Zero();
	gradient(0, 0) = -0.4;
	gradient(0, 1) = 0.3; // prescribed: slides along, without friction of no effect
	problem.meanField = field(M, gradient);
	problem.meanField->inverseMass(0, 1) = problem.meanField->inverseMass(1, 0) = 0;
	SignoriniCoulombSolver solver;
	ASSERT_EQ(solver.solve(problem, tight(1e-14)).status, SolveStatus::converged);
	const double R = 0.4 * b / (1 / m1 + 1 / m2 + b * b / M);
	EXPECT_NEAR(problem.contacts[0].impulse[0], R, 1e-12 * R);
	EXPECT_NEAR(problem.meanField->gradient(0, 0), -0.4 + R * b / M, 1e-12);
	EXPECT_EQ(problem.meanField->gradient(0, 1), 0.3);
	EXPECT_NEAR(problem.bodies[0].velocity[0], -R / m1, 1e-12);
	EXPECT_NEAR(problem.contacts[0].relativeVelocity[0], 0, 1e-12);
}

TEST(MeanField, PrescribedCompressionOfTouchingBallsHasNoSolution)
{
	// A row that closes on itself across the period: the velocities of its contacts add up to 2 b L_xx, whatever the impulses. With L_xx < 0 no
	// solution exists; impulses carried over from step to step grow, and the residual relative to them falls. With inertia of its own L_xx gives way.
	const double b = 2;
	for (const bool prescribed : {true, false}) {
		GrainProblem problem;
		problem.bodies = {scenes::ball(1, 1), scenes::ball(1, 1)};
		problem.contacts = {scenes::touch(0, 1, 1, 1, Vector3::UnitX(), 0.3), scenes::touch(1, 1, 0, 1, Vector3::UnitX(), 0.3)};
		Matrix3 gradient = Matrix3::Zero();
		gradient(0, 0) = -0.1;
		problem.meanField = field(3, gradient);
		if (prescribed) problem.meanField->inverseMass.setZero();
		SignoriniCoulombSolver solver;
		SolverOptions options;
		for (int step = 0; step < 20; ++step) {
			for (Body& body : problem.bodies) body.velocity.setZero();
			problem.meanField->gradient = gradient;
			const SolveStatus status = solver.solve(problem, options).status;
			if (prescribed) {
				EXPECT_NE(status, SolveStatus::converged) << step;
				EXPECT_NEAR(problem.contacts[0].relativeVelocity[0] + problem.contacts[1].relativeVelocity[0], 2 * b * gradient(0, 0), 1e-12);
			} else
				EXPECT_EQ(status, SolveStatus::converged) << step;
		}
	}
}

TEST(MeanField, AnObliqueContactPushesTheSymmetricPart)
{
	// Normal (1, 1, 0)/sqrt 2: M dL = sym(R b^T), so dL_xy = dL_yx = R b / (2 M), and U = b n.L n.
	const double m = 1, M = 0.5, b = 2;
	const Vector3 n = Vector3(1, 1, 0) / std::sqrt(2.0);
	GrainProblem problem;
	problem.bodies = {scenes::ball(m, 1), scenes::ball(m, 1)};
	problem.contacts = {scenes::touch(0, 1, 1, 1, n, 0)};
	Matrix3 gradient = Matrix3::Zero();
	gradient(0, 1) = -1; // n.L n = -1/2
	problem.meanField = field(M, gradient);
	SignoriniCoulombSolver solver;
	ASSERT_EQ(solver.solve(problem, tight(1e-14)).status, SolveStatus::converged);
	const double R = 0.5 * b / (2 / m + b * b / M);
	Matrix3 expected = gradient;
	for (int i = 0; i < 2; ++i)
		for (int j = 0; j < 2; ++j) expected(i, j) += R * b / (2 * M);
	EXPECT_TRUE(problem.meanField->gradient.isApprox(expected, 1e-12)) << problem.meanField->gradient;
}

TEST(MeanField, ALimitIsHeldByForce)
{
	GrainProblem problem;
	problem.bodies = {scenes::ball(1, 1), scenes::ball(1, 1)};
	problem.contacts = {scenes::touch(0, 1, 1, 1, Vector3::UnitX(), 0)};
	problem.meanField = field(10, -Matrix3(Matrix3::Identity()));
	problem.meanField->limit = 0.25;
	SignoriniCoulombSolver solver;
	ASSERT_EQ(solver.solve(problem, tight(1e-14)).status, SolveStatus::converged);
	// The balls are closed at the limit, 2 R = 0.25 b, and R b / M = 0.05 leaves the stretch of -1 beyond it.
	EXPECT_NEAR(problem.contacts[0].impulse[0], 0.25, 1e-12);
	for (int i = 0; i < 3; ++i) EXPECT_EQ(problem.meanField->gradient(i, i), -0.25);
	EXPECT_EQ(problem.meanField->gradient(0, 1), 0);
}

TEST(MeanField, CertificateIsThatOfTheWholeProblem)
{
	for (const bool general : {false, true})
		for (const double friction : {0.0, 0.5})
			for (const double lightness : {0.1, 1.0, 100.0}) {
				GrainProblem problem = scenes::heap(5, 11, friction, false, general);
				Matrix3 gradient = -0.3 * Matrix3::Identity();
				gradient(0, 1) = 0.5;
				problem.meanField = field(meanMomentOfMass(problem) / lightness, gradient);
				const GrainProblem free = problem;
				SignoriniCoulombSolver solver;
				SolverOptions options = tight(1e-8);
				if (friction > 0) options.maxIterations = 2000; // what is returned then is as good for the comparison
				const SolveReport report = solver.solve(problem, options);
				SCOPED_TRACE(testing::Message() << "general " << general << " friction " << friction << " lightness " << lightness);
				ASSERT_TRUE(friction > 0 || report.status == SolveStatus::converged) << report.residual << " after " << report.iterations;
				// Two evaluations of the same sums: they differ by round-off of the velocities.
				EXPECT_NEAR(independent::residual(free, problem), report.residual, 1e-11);
				EXPECT_FALSE(problem.meanField->gradient.isApprox(gradient, 1e-3)); // the contacts did move it
			}
}

TEST(MeanField, VirtualWork)
{
	// Without friction and with all contacts closed or open at the end, the energy lost is half of sum r.(U_free + U_end) over bodies and field.
	GrainProblem problem = scenes::heap(4, 3, 0);
	const double M = meanMomentOfMass(problem);
	problem.meanField = field(M, -0.5 * Matrix3::Identity());
	const GrainProblem free = problem;
	SignoriniCoulombSolver solver;
	ASSERT_EQ(solver.solve(problem, tight(1e-10)).status, SolveStatus::converged);
	const auto energy = [&](const GrainProblem& p) { return scenes::kineticEnergy(p) + 0.5 * M * p.meanField->gradient.squaredNorm(); };
	double work = 0;
	for (const Contact& c : problem.contacts) {
		const Body &b1 = free.bodies[c.body1], &b2 = free.bodies[c.body2];
		const Vector3 start = b2.velocity - b1.velocity + b2.angularVelocity.cross(c.arm2) - b1.angularVelocity.cross(c.arm1) +
							  free.meanField->gradient * (c.arm1 - c.arm2);
		work += 0.5 * c.impulse.dot(start + c.relativeVelocity);
	}
	EXPECT_NEAR(energy(problem) - energy(free), work, 1e-12 * energy(free));
}

TEST(MeanField, ExplicitOperatorIsThatOfTheWholeProblem)
{
	// u = W r + q, q from the free velocities of bodies and field; with a component at its bound, which W leaves out, the others tell.
	for (const double limit : {std::numeric_limits<double>::infinity(), 0.02}) {
		GrainProblem problem = scenes::heap(4, 3, 0.4, false, true);
		problem.meanField = field(meanMomentOfMass(problem), -0.5 * Matrix3::Identity());
		problem.meanField->limit = limit;
		const GrainProblem free = problem;
		SignoriniCoulombSolver solver;
		SolverOptions options = tight(1e-8);
		options.maxIterations = 2000;
		solver.solve(problem, options);
		std::vector<Matrix3> frames;
		for (const Contact& c : problem.contacts) {
			Matrix3 frame;
			frame << c.normal.transpose(), c.normal.unitOrthogonal().transpose(), c.normal.cross(c.normal.unitOrthogonal()).transpose();
			frames.push_back(frame);
		}
		const BlockProblem blocks = assembled(problem, frames);
		Matrix3 gradient = free.meanField->gradient;
		int bounded = 0;
		for (int i = 0; i < 9; ++i)
			if (std::abs(problem.meanField->gradient(i / 3, i % 3)) >= limit) {
				gradient(i / 3, i % 3) = problem.meanField->gradient(i / 3, i % 3);
				++bounded;
			}
		EXPECT_EQ(bounded > 0, limit < 1);
		double largest = 0;
		for (std::size_t i = 0; i < problem.contacts.size(); ++i) {
			const Contact& c = problem.contacts[i];
			const Body &b1 = free.bodies[c.body1], &b2 = free.bodies[c.body2];
			const Vector3 start =
					b2.velocity - b1.velocity + b2.angularVelocity.cross(c.arm2) - b1.angularVelocity.cross(c.arm1) + gradient * (c.arm1 - c.arm2);
			const Vector3 q = frames[i] * start + Vector3(c.gapVelocity, 0, 0), found(blocks.q[3 * i], blocks.q[3 * i + 1], blocks.q[3 * i + 2]);
			largest = std::max(largest, (q - found).cwiseAbs().maxCoeff());
		}
		EXPECT_LT(largest, 1e-11); // round-off of sums over all contacts, of velocities of order 1
	}
}

TEST(MeanField, SameBitsForAnyNumberOfThreads)
{
	GrainProblem one = scenes::heap(12, 5, 0.4); // enough awake contacts for the crew to be used
	one.meanField = field(meanMomentOfMass(one), -0.3 * Matrix3::Identity());
	GrainProblem two = one, three = one;
	SignoriniCoulombSolver solver;
	solver.solve(one, tight(1e-4));
	solver.solve(two, tight(1e-4, 2));
	solver.solve(three, tight(1e-4, 3));
	ASSERT_GT(one.contacts.size(), 3000u);
	for (const GrainProblem* other : {&two, &three}) {
		EXPECT_EQ(one.meanField->gradient, other->meanField->gradient);
		for (std::size_t i = 0; i < one.contacts.size(); ++i) ASSERT_EQ(one.contacts[i].impulse, other->contacts[i].impulse) << i;
	}
}

TEST(MeanField, BadInputIsRefused)
{
	GrainProblem problem = scenes::column(1, 1);
	SignoriniCoulombSolver solver;
	const auto refused = [&](const MeanField& bad, const char* word) {
		problem.meanField = bad;
		try {
			solver.solve(problem, tight(1e-4));
			ADD_FAILURE() << word;
		} catch (const std::invalid_argument& error) {
			EXPECT_NE(std::strstr(error.what(), word), nullptr) << error.what();
		}
	};
	MeanField bad = field(1, Matrix3::Zero());
	bad.inverseMass(0, 1) = -1;
	refused(bad, "negative");
	bad.inverseMass(0, 1) = 2;
	refused(bad, "symmetric");
	bad = field(1, Matrix3::Zero());
	bad.limit = 0;
	refused(bad, "limit");
	problem.meanField = field(1, Matrix3::Constant(std::numeric_limits<double>::quiet_NaN()));
	EXPECT_EQ(solver.solve(problem, tight(1e-4)).status, SolveStatus::notFinite);
}
