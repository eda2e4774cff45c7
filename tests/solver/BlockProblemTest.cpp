// SPDX-License-Identifier: GPL-2.0-or-later
// Explicit W: the same loop as for grains, the 2D closed form, and Siconos's measure.
#include "BlockScenes.hpp"
#include "Scenes.hpp"
#include "pkg/solver/BlockProblem.hpp"
#include "pkg/solver/OneContact.hpp"
#include "pkg/solver/OneContact2D.hpp"
#include "pkg/solver/SignoriniCoulombSolver.hpp"

#include <gtest/gtest.h>

using namespace contactdynamics;

namespace {

/// W = H^T M^-1 H and q of a grain problem, in frames that are right-handed and otherwise arbitrary.
BlockProblem assembled(const GrainProblem& grains, std::vector<Matrix3>& frames)
{
	BlockProblem problem;
	const std::size_t count = grains.contacts.size();
	frames.clear();
	for (const Contact& c : grains.contacts) frames.push_back(Eigen::Quaterniond::FromTwoVectors(c.normal, Vector3::UnitX()).toRotationMatrix());
	problem.rowStart.push_back(0);
	for (std::size_t i = 0; i < count; ++i) {
		const Contact& a = grains.contacts[i];
		for (std::size_t j = 0; j < count; ++j) {
			const Contact& b = grains.contacts[j];
			Matrix3 W = Matrix3::Zero();
			for (const int side : {0, 1})
				for (const int other : {0, 1}) {
					const int body = side ? a.body2 : a.body1;
					if (body != (other ? b.body2 : b.body1)) continue;
					W += (side == other ? 1 : -1) * independent::lever(side ? a.arm2 : a.arm1).transpose() *
						 independent::inverseMassMatrix(grains.bodies[body]) * independent::lever(other ? b.arm2 : b.arm1);
				}
			if (i != j && W.isZero(0)) continue;
			const Matrix3 local = frames[i] * W * frames[j].transpose();
			problem.column.push_back(int(j));
			for (int k = 0; k < 9; ++k) problem.blocks.push_back(local(k / 3, k % 3));
		}
		problem.rowStart.push_back(int(problem.column.size()));
		const Body &b1 = grains.bodies[a.body1], &b2 = grains.bodies[a.body2];
		Vector3 u = frames[i] * (b2.velocity + b2.angularVelocity.cross(a.arm2) - b1.velocity - b1.angularVelocity.cross(a.arm1));
		u[0] += a.gapVelocity;
		for (int k = 0; k < 3; ++k) problem.q.push_back(u[k]);
		problem.friction.push_back(a.friction);
	}
	problem.impulse.assign(3 * count, 0);
	return problem;
}

SolverOptions upTo(double tolerance)
{
	SolverOptions options;
	options.tolerance = tolerance;
	options.maxIterations = 20000;
	return options;
}

} // namespace

TEST(Blocks, SameSolutionAsMatrixFree)
{
	for (const bool general : {false, true}) {
		GrainProblem grains = scenes::heap(4, 5, 0.3, true, general);
		std::vector<Matrix3> frames;
		BlockProblem blocks = assembled(grains, frames);
		const GrainProblem free = grains;
		ASSERT_EQ(SignoriniCoulombSolver().solve(grains, upTo(1e-9)).status, SolveStatus::converged);
		const SolveReport report = solve(blocks, upTo(1e-9));
		ASSERT_EQ(report.status, SolveStatus::converged);
		GrainProblem viaBlocks = free;
		for (std::size_t i = 0; i < free.contacts.size(); ++i)
			viaBlocks.contacts[i].impulse = frames[i].transpose() * Eigen::Map<const Vector3>(&blocks.impulse[3 * i]);
		EXPECT_NEAR(independent::residual(free, viaBlocks), report.residual, 1e-3 * report.residual + 1e-13);
		// Velocities are the unique part; the tolerance times the condition of the heap, with room.
		for (std::size_t i = 0; i < free.contacts.size(); ++i) {
			Vector3 u = frames[i] * grains.contacts[i].relativeVelocity;
			u[0] += free.contacts[i].gapVelocity;
			EXPECT_LE((u - Eigen::Map<const Vector3>(&blocks.velocity[3 * i])).norm(), 1e-5) << i;
		}
	}
}

TEST(Blocks, SiconosMeasureIsItsFormula)
{
	std::vector<Matrix3> frames;
	BlockProblem problem = assembled(scenes::heap(4, 5, 0.5), frames);
	for (const int sweeps : {0, 1, 10}) {
		BlockProblem solved = problem;
		SolverOptions options = upTo(1e-14);
		options.maxIterations = sweeps;
		const SolveReport report = solve(solved, options, Measure::siconos);
		EXPECT_NEAR(report.residual, scenes::siconosError(solved), 1e-10 * report.residual);
		EXPECT_DOUBLE_EQ(residualOf(solved, Measure::siconos), report.residual);
	}
	const SolveReport report = solve(problem, upTo(1e-8), Measure::siconos);
	ASSERT_EQ(report.status, SolveStatus::converged);
	EXPECT_LE(scenes::siconosError(problem), 1.0001e-8);
}

TEST(Blocks, ClosedFormInTwoDimensionsAgreesWithTheGeneralSolution)
{
	std::mt19937_64 random(3);
	std::normal_distribution<double> normal;
	std::uniform_real_distribution<double> uniform(0, 1);
	int unique = 0;
	for (int i = 0; i < 100000; ++i) {
		Eigen::Matrix2d root;
		root << normal(random), normal(random), normal(random), normal(random);
		const Eigen::Matrix2d W = root * root.transpose() + 1e-3 * Eigen::Matrix2d::Identity();
		const Eigen::Vector2d b(normal(random), normal(random));
		const double mu = uniform(random) < 0.1 ? 0 : 2 * uniform(random);
		const OneContact2D contact(W);
		const Eigen::Vector2d r = contact.solve(b, mu), u = W * r + b;
		EXPECT_EQ(contact.isUnique(mu), std::abs(mu * W(0, 1)) < W(0, 0));
		// The laws, relative to the terms of u, which round-off is measured by.
		const double size = b.norm() + W.norm() * r.norm(), eps = 1e-13 * size;
		ASSERT_GE(r[0], 0);
		ASSERT_GE(u[0], -eps);
		ASSERT_TRUE(r[0] == 0 || std::abs(u[0]) <= eps);
		ASSERT_LE(std::abs(r[1]), mu * r[0] * (1 + 1e-15));
		if (std::abs(r[1]) < mu * r[0] * (1 - 1e-12)) { ASSERT_LE(std::abs(u[1]), eps); }
		ASSERT_LE(u[1] * r[1], eps * std::abs(r[1]));
		if (!contact.isUnique(mu)) continue;
		++unique;
		Matrix3 embedded = Matrix3::Zero(); // immobile and at rest in the third direction
		embedded.topLeftCorner<2, 2>() = W;
		const Vector3 r3 = OneContact(embedded).solve({b[0], b[1], 0}, mu);
		ASSERT_LE((W * (r3.head<2>() - r)).norm(), 1e-11 * size) << "W\n" << W << "\nb " << b.transpose() << " mu " << mu;
		ASSERT_EQ(r3[2], 0);
	}
	EXPECT_GT(unique, 50000);
}

TEST(Blocks, PainleveIsReported)
{
	BlockProblem problem;
	problem.dimension = 2;
	problem.rowStart = {0, 1};
	problem.column = {0};
	problem.blocks = {1, 2, 2, 5};
	problem.q = {-1, 0.3};
	problem.impulse = {0, 0};
	for (const double mu : {0.4, 0.6}) { // (33): mu |W_TN| < W_NN, that is mu < 0.5
		problem.friction = {mu};
		problem.impulse = {0, 0};
		const SolveReport report = solve(problem, upTo(1e-12));
		EXPECT_EQ(report.status, SolveStatus::converged);
		EXPECT_EQ(report.ambiguousContacts, mu > 0.5);
	}
}

TEST(Blocks, BadInputIsRefusedByName)
{
	BlockProblem good;
	good.dimension = 2;
	good.rowStart = {0, 1};
	good.column = {0};
	good.blocks = {1, 0, 0, 1};
	good.q = {-1, 0};
	good.impulse = {0, 0};
	good.friction = {0.5};
	const auto message = [&](auto&& spoil) -> std::string {
		BlockProblem problem = good;
		spoil(problem);
		try {
			solve(problem, {});
		} catch (const std::invalid_argument& error) {
			return error.what();
		}
		return "nothing thrown";
	};
	EXPECT_EQ(message([](BlockProblem&) {}), "nothing thrown");
	EXPECT_NE(message([](BlockProblem& p) { p.dimension = 4; }).find("dimension is 4"), std::string::npos);
	EXPECT_NE(message([](BlockProblem& p) { p.friction[0] = -1; }).find("contact 0: friction is -1"), std::string::npos);
	EXPECT_NE(message([](BlockProblem& p) { p.column[0] = 1; }).find("column 1"), std::string::npos);
	EXPECT_NE(message([](BlockProblem& p) { p.q.pop_back(); }).find("q has 1"), std::string::npos);
	EXPECT_NE(message([](BlockProblem& p) { p.rowStart = {0, 0}, p.column.clear(), p.blocks.clear(); }).find("no diagonal"), std::string::npos);
	BlockProblem problem = good;
	problem.q[0] = std::nan("");
	EXPECT_EQ(solve(problem, {}).status, SolveStatus::notFinite);
}
