// SPDX-License-Identifier: GPL-2.0-or-later
// The central path: smoothed contacts, the equations and their derivatives, and the path followed to solutions.
#include "BlockScenes.hpp"
#include "pkg/solver/CentralPath.hpp"
#include "pkg/solver/SmoothedContact.hpp"

#include <gtest/gtest.h>

using namespace contactdynamics;

namespace {

template <int D> using VectorOf = Eigen::Matrix<double, D, 1>;

template <int D> VectorOf<D> drawn(std::mt19937_64& random)
{
	std::normal_distribution<double> normal;
	VectorOf<D> result;
	for (double& entry : result) entry = normal(random);
	return result;
}

constexpr double roundOff = 1e-15; // a few units in the last place

template <int D> void expectComplementary(unsigned seed)
{
	std::mt19937_64 random(seed);
	for (const double t : {1e-20, 1e-12, 1e-6, 1e-2, 1.0, 1e4})
		for (int k = 0; k < 200; ++k) {
			const VectorOf<D> z = std::pow(10, k % 7 - 3) * drawn<D>(random);
			const SmoothedContact<D> contact(z, t);
			const VectorOf<D>&r = contact.r, &u = contact.u;
			const double size = r.norm() + u.norm();
			EXPECT_LE((r - u - z).norm(), 4 * roundOff * size) << t;
			VectorOf<D> product;
			product << r.dot(u), r[0] * u.template tail<D - 1>() + u[0] * r.template tail<D - 1>();
			product[0] -= t;
			EXPECT_LE(product.norm(), 8 * roundOff * r.norm() * u.norm()) << t;
			EXPECT_GE(r[0] - r.template tail<D - 1>().norm(), -roundOff * r[0]);
			EXPECT_GE(u[0] - u.template tail<D - 1>().norm(), -roundOff * u[0]);
			EXPECT_GT(std::min(r[0], u[0]), 0);
		}
}

/// Central differences of r: with t of order one its third derivative is of order one, so that a step of 1e-5 leaves 1e-10 and as much round-off.
template <int D> void expectDerivatives(unsigned seed)
{
	std::mt19937_64 random(seed);
	const double h = 1e-5, t = 0.7, bound = 1e-9;
	for (int k = 0; k < 200; ++k) {
		const VectorOf<D> z = k ? drawn<D>(random) : VectorOf<D>(VectorOf<D>::Zero()), d = drawn<D>(random).normalized();
		const SmoothedContact<D> here(z, t), ahead(z + h * d, t), behind(z - h * d, t), later(z, t + h), before(z, t - h);
		EXPECT_LE((here.slope * d - (ahead.r - behind.r) / (2 * h)).norm(), bound);
		EXPECT_LE((here.rate - (later.r - before.r) / (2 * h)).norm(), bound);
		EXPECT_LE((here.rate - (later.u - before.u) / (2 * h)).norm(), bound);
		EXPECT_LE((here.slope - here.slope.transpose()).norm(), 4 * roundOff);
	}
}

/// A problem with friction, a contact without, and one that nothing moves.
BlockProblem mixed(int dimension, int contacts, unsigned seed)
{
	BlockProblem problem = scenes::randomProblem(dimension, contacts, dimension * contacts, 0.7, seed);
	problem.friction[1] = 0;
	const int size = dimension * dimension;
	for (int i = 0; i < contacts; ++i)
		for (int k = problem.rowStart[i]; k < problem.rowStart[i + 1]; ++k)
			if (i == 2 || problem.column[k] == 2) std::fill_n(&problem.blocks[size * k], size, 0.0);
	return problem;
}

/// dF/dz applied to a direction and dF/dtau against central differences, through the factors: dense and sparse.
template <int D> void expectJacobian(int contacts, unsigned seed)
{
	const BlockProblem problem = mixed(D, contacts, seed);
	CentralPathSystem<D> system(problem);
	std::mt19937_64 random(seed);
	std::normal_distribution<double> normal;
	const auto vector = [&] {
		Eigen::VectorXd v(system.unknowns());
		for (double& entry : v) entry = normal(random);
		return v;
	};
	const double logT = -0.3, h = 1e-5;
	system.startAt(vector(), 0.5);
	const Eigen::VectorXd z = vector(), d = vector().normalized();
	const auto F = [&](const Eigen::VectorXd& at, double tau) {
		system.evaluate(at, tau);
		return system.value();
	};
	const Eigen::VectorXd byZ = (F(z + h * d, logT) - F(z - h * d, logT)) / (2 * h), byT = (F(z, logT + h) - F(z, logT - h)) / (2 * h);
	system.evaluate(z, logT);
	// Truncation and round-off of a difference, 1e-10 of F each, a few of them; then times the inverse, whose norm here is 4 to 18.
	const double size = system.value().norm();
	EXPECT_LE((system.rate() - byT).norm(), 1e-9 * size);
	ASSERT_TRUE(system.jacobian().factorise());
	EXPECT_LE((system.jacobian().solve(byZ) - d).norm(), 2e-8 * size);
}

/// The sign of the determinant of a W that is no longer semi-definite, against the determinant of a matrix of differences.
template <int D> void expectSign(int contacts, unsigned seed)
{
	BlockProblem problem = scenes::randomProblem(D, contacts, D * contacts, 1, seed);
	std::mt19937_64 random(seed);
	std::normal_distribution<double> normal;
	for (double& entry : problem.blocks) entry = 3 * normal(random);
	for (int i = 0; i < contacts; ++i)
		for (int k = 0; k < D; ++k) problem.blocks[D * D * (problem.rowStart[i] + i) + (D + 1) * k] = 1 + std::abs(normal(random));
	CentralPathSystem<D> system(problem);
	system.startAt(Eigen::VectorXd::Zero(system.unknowns()), 0);
	double common = 0;
	int positive = 0;
	constexpr int trials = 12;
	for (int trial = 0; trial < trials; ++trial) {
		Eigen::VectorXd z(system.unknowns());
		for (double& entry : z) entry = normal(random);
		const double h = 1e-6;
		Eigen::MatrixXd differences(z.size(), z.size());
		for (int k = 0; k < z.size(); ++k) {
			Eigen::VectorXd step = Eigen::VectorXd::Zero(z.size());
			step[k] = h;
			system.evaluate(z + step, -1);
			const Eigen::VectorXd ahead = system.value();
			system.evaluate(z - step, -1);
			differences.col(k) = (ahead - system.value()) / (2 * h);
		}
		system.evaluate(z, -1);
		ASSERT_TRUE(system.jacobian().factorise());
		const double sign = differences.determinant() > 0 ? 1 : -1, product = sign * system.jacobian().signOfDeterminant();
		if (trial == 0) common = product;
		positive += sign > 0;
		EXPECT_EQ(product, common) << trial;
	}
	EXPECT_TRUE(positive > 0 && positive < trials) << positive << " of one sign: proves nothing";
}

/// Follows the path alone; the error of its last point by the independent formula, or -1 when it ends without.
template <int D> double errorByPath(BlockProblem problem, double tolerance, int most = 3000)
{
	CentralPath<D> path(problem);
	double error = -1;
	path.follow(most, [&](const std::vector<VectorOf<D>>& impulses) {
		for (std::size_t i = 0; i < impulses.size(); ++i)
			for (int k = 0; k < D; ++k) problem.impulse[D * i + k] = impulses[i][k];
		if (residualOf(problem, Measure::siconos) > tolerance) return false;
		error = scenes::siconosError(problem);
		return true;
	});
	return error;
}

} // namespace

TEST(SmoothedContact, IsComplementaryInsideTheCones)
{
	expectComplementary<2>(1);
	expectComplementary<3>(2);
}

TEST(SmoothedContact, HasTheDerivativesItSays)
{
	expectDerivatives<2>(3);
	expectDerivatives<3>(4);
}

TEST(CentralPathSystem, HasTheDerivativesItSays)
{
	for (const int contacts : {5, 50}) { // the dense and the sparse factorisation
		expectJacobian<2>(contacts, 5);
		expectJacobian<3>(contacts, 6);
	}
}

TEST(CentralPathSystem, KnowsTheSignOfItsDeterminant)
{
	expectSign<3>(4, 7);
	expectSign<3>(40, 8);
	expectSign<2>(60, 9);
}

// Friction up to 2 on W of half rank: the paths of some of these turn back several times; followed downwards only, they are lost.
TEST(CentralPath, LeadsToSolutionsThroughFolds)
{
	for (const double mu : {0.5, 1.0, 1.5, 2.0})
		for (unsigned seed = 1; seed <= 30; ++seed)
			for (const int contacts : {3, 6, 12}) {
				const double spatial = errorByPath<3>(scenes::randomProblem(3, contacts, 3 * contacts / 2, mu, seed), 1e-8);
				const double planar = errorByPath<2>(scenes::randomProblem(2, contacts, contacts, mu, seed), 1e-8);
				EXPECT_TRUE(spatial >= 0 && spatial <= 1e-8) << contacts << " contacts, mu " << mu << ", seed " << seed;
				EXPECT_TRUE(planar >= 0 && planar <= 1e-8) << contacts << " contacts, mu " << mu << ", seed " << seed;
			}
}

// Folds too sharp for corrections of 0.01: lost at first, found from the second or third start.
TEST(CentralPath, StartsAnewWithFinerCorrections)
{
	EXPECT_GE(errorByPath<3>(scenes::randomProblem(3, 3, 4, 2, 45), 1e-8), 0);
	EXPECT_GE(errorByPath<3>(scenes::randomProblem(3, 3, 4, 3, 6), 1e-8), 0);
	EXPECT_GE(errorByPath<3>(scenes::randomProblem(3, 12, 18, 1.5, 57), 1e-8), 0);
	EXPECT_GE(errorByPath<2>(scenes::randomProblem(2, 30, 30, 3, 47), 1e-8), 0);
}

TEST(CentralPath, LeadsToSolutionsOfWalls)
{
	for (const int dimension : {2, 3})
		for (const double decades : {0.0, 3.0}) {
			scenes::Wall wall;
			wall.dimension = dimension;
			wall.decades = decades;
			const BlockProblem problem = scenes::wall(wall);
			const double reached = dimension == 2 ? errorByPath<2>(problem, 1e-8) : errorByPath<3>(problem, 1e-8);
			EXPECT_TRUE(reached >= 0 && reached <= 1e-8) << dimension << "D, " << decades << " decades";
		}
}

// The path goes to infinity, and its following comes to an end.
TEST(CentralPath, EndsWhereThereIsNoSolution)
{
	CentralPath<2> path(scenes::squeezed());
	const int solved = path.follow(5000, [](const std::vector<VectorOf<2>>&) { return false; });
	EXPECT_LT(solved, 5000);
	EXPECT_EQ(path.follow(100, [](const std::vector<VectorOf<2>>&) { return true; }), 0);
}
