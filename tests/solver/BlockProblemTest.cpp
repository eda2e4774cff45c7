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

/// Balls whose centres and velocities lie in the plane y = 0 and that turn about y: a heap in two dimensions.
GrainProblem diskHeap(int side, unsigned seed, double friction)
{
	std::mt19937_64 random(seed);
	std::uniform_real_distribution<double> uniform(0, 1);
	std::normal_distribution<double> normal;
	GrainProblem problem;
	problem.bodies.push_back(scenes::wall());
	std::vector<Vector3> centre(1);
	std::vector<double> radius(1);
	for (int i = 0; i < side * side; ++i) {
		const int column = i % side, row = i / side;
		centre.push_back(Vector3(column + 0.1 * normal(random), 0, row + 0.1 * normal(random)));
		radius.push_back(0.4 + 0.15 * uniform(random));
		problem.bodies.push_back(scenes::ball(4 * std::pow(radius.back(), 3), radius.back(), {0.2 * normal(random), 0, 0.2 * normal(random) - 1},
											  {0, normal(random), 0}));
	}
	for (int i = 1; i <= side * side; ++i) {
		if (i <= side) problem.contacts.push_back(scenes::touch(0, 0, i, radius[i], Vector3::UnitZ(), friction));
		for (int j = i + 1; j <= side * side; ++j) {
			const Vector3 d = centre[j] - centre[i];
			const double gap = d.norm() - radius[i] - radius[j];
			if (gap < 0.3) problem.contacts.push_back(scenes::touch(i, radius[i], j, radius[j], d.normalized(), friction, std::max(0.0, gap)));
		}
	}
	return problem;
}

/// W = H^T M^-1 H and q of a grain problem, in frames that are right-handed and otherwise arbitrary; in two dimensions the third axis is y.
BlockProblem assembled(const GrainProblem& grains, std::vector<Matrix3>& frames, int dimension = 3)
{
	BlockProblem problem;
	problem.dimension = dimension;
	const std::size_t count = grains.contacts.size();
	frames.clear();
	for (const Contact& c : grains.contacts) {
		frames.push_back(Eigen::Quaterniond::FromTwoVectors(c.normal, Vector3::UnitX()).toRotationMatrix());
		if (dimension == 2) frames.back() << c.normal.transpose(), Vector3::UnitY().cross(c.normal).transpose(), Vector3::UnitY().transpose();
	}
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
			for (int k = 0; k < dimension * dimension; ++k) problem.blocks.push_back(local(k / dimension, k % dimension));
		}
		problem.rowStart.push_back(int(problem.column.size()));
		const Body &b1 = grains.bodies[a.body1], &b2 = grains.bodies[a.body2];
		Vector3 u = frames[i] * (b2.velocity + b2.angularVelocity.cross(a.arm2) - b1.velocity - b1.angularVelocity.cross(a.arm1));
		u[0] += a.gapVelocity;
		for (int k = 0; k < dimension; ++k) problem.q.push_back(u[k]);
		problem.friction.push_back(a.friction);
	}
	problem.impulse.assign(dimension * count, 0);
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

/// In two and in three dimensions.
class Blocks : public testing::TestWithParam<int> {
protected:
	const int dimension = GetParam();

	GrainProblem grains(double friction) const { return dimension == 2 ? diskHeap(8, 5, friction) : scenes::heap(4, 5, friction, true, false); }
	Vector3 inSpace(const std::vector<double>& numbers, std::size_t contact) const // third component zero in two dimensions
	{
		Vector3 vector = Vector3::Zero();
		for (int k = 0; k < dimension; ++k) vector[k] = numbers[dimension * contact + k];
		return vector;
	}
	void expectSolutionOf(GrainProblem grains) const
	{
		std::vector<Matrix3> frames;
		BlockProblem blocks = assembled(grains, frames, dimension);
		const GrainProblem free = grains;
		const double tolerance = 1e-12;
		ASSERT_EQ(SignoriniCoulombSolver().solve(grains, upTo(tolerance)).status, SolveStatus::converged);
		const SolveReport report = solve(blocks, upTo(tolerance));
		ASSERT_EQ(report.status, SolveStatus::converged);
		GrainProblem viaBlocks = free;
		for (std::size_t i = 0; i < free.contacts.size(); ++i) viaBlocks.contacts[i].impulse = frames[i].transpose() * inSpace(blocks.impulse, i);
		EXPECT_NEAR(independent::residual(free, viaBlocks), report.residual, 1e-3 * report.residual + 1e-13);
		// Velocities are the unique part. That of a contact is H^T v, so its square is at most the largest eigenvalue of its W times twice the
		// energy.
		const independent::Agreement found = independent::agreement(free, grains, viaBlocks, tolerance);
		EXPECT_LE(found.energy, found.bound);
		for (std::size_t i = 0; i < free.contacts.size(); ++i) {
			Vector3 u = frames[i] * grains.contacts[i].relativeVelocity;
			u[0] += free.contacts[i].gapVelocity;
			const double mobility = independent::delassus(free, free.contacts[i]).selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff();
			EXPECT_LE((u - inSpace(blocks.velocity, i)).squaredNorm(), mobility * 2 * found.bound) << i;
		}
		EXPECT_LE(found.bound, 1e-8 * scenes::kineticEnergy(free)); // or it would say little
	}
};

INSTANTIATE_TEST_SUITE_P(Dimensions, Blocks, testing::Values(2, 3), [](const auto& its) { return its.param == 2 ? "two" : "three"; });

TEST_P(Blocks, SameSolutionAsMatrixFree)
{
	expectSolutionOf(grains(0.3));
	if (dimension == 3) expectSolutionOf(scenes::heap(4, 5, 0.3, true, true)); // contacts of no ball
}

TEST_P(Blocks, SiconosMeasureIsItsFormula)
{
	std::vector<Matrix3> frames;
	BlockProblem problem = assembled(grains(0.5), frames, dimension);
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

TEST(OneContactIn2D, ClosedFormInTwoDimensionsAgreesWithTheGeneralSolution)
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

TEST(OneContactIn2D, PainleveIsReported)
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

TEST_P(Blocks, BadInputIsRefusedByName)
{
	BlockProblem good;
	good.dimension = dimension;
	good.rowStart = {0, 1};
	good.column = {0};
	good.blocks.assign(dimension * dimension, 0);
	for (int k = 0; k < dimension; ++k) good.blocks[(dimension + 1) * k] = 1;
	good.q.assign(dimension, 0);
	good.q[0] = -1;
	good.impulse.assign(dimension, 0);
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
	EXPECT_NE(message([](BlockProblem& p) { p.q.pop_back(); }).find("q has " + std::to_string(dimension - 1)), std::string::npos);
	EXPECT_NE(message([](BlockProblem& p) { p.rowStart = {0, 0}, p.column.clear(), p.blocks.clear(); }).find("no diagonal"), std::string::npos);
	BlockProblem problem = good;
	problem.q[0] = std::nan("");
	EXPECT_EQ(solve(problem, {}).status, SolveStatus::notFinite);
}
