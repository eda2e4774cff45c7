// SPDX-License-Identifier: GPL-2.0-or-later
// Sweeps and Newton finish on explicit W: rank-deficient walls, random semi-definite W, unsymmetric and badly scaled ones. The error is checked by
// its formula written a second time in BlockScenes.hpp.
#include "BlockScenes.hpp"
#include "pkg/solver/BlockProblem.hpp"
#include "pkg/solver/NewtonStep.hpp"
#include "pkg/solver/OneContact.hpp"
#include "pkg/solver/OneContact2D.hpp"

#include <gtest/gtest.h>

using namespace contactdynamics;

namespace {

SolverOptions upTo(double tolerance, int maxIterations = 50000)
{
	SolverOptions options;
	options.tolerance = tolerance;
	options.maxIterations = maxIterations;
	return options;
}

/// Solves to both tolerances and checks the point by the second implementation; round-off of the two sums apart.
void expectSolved(const BlockProblem& given, const std::string& name)
{
	for (const double tolerance : {1e-4, 1e-8}) {
		BlockProblem problem = given;
		const SolveReport report = solve(problem, upTo(tolerance), Measure::siconos);
		EXPECT_EQ(report.status, SolveStatus::converged) << name << ", residual " << report.residual << " after " << report.iterations << " sweeps";
		EXPECT_LE(scenes::siconosError(problem), 1.0001 * tolerance) << name;
		for (std::size_t i = 0; i < problem.contacts(); ++i) EXPECT_GE(problem.impulse[problem.dimension * i], 0) << name << ", contact " << i;
	}
}

/// The problem with a contact behind each of its own that acts on no other one, nor is acted upon.
/// @param skew  unsymmetric part of its block, relative
BlockProblem withContactsApart(const BlockProblem& given, double skew, unsigned seed)
{
	std::mt19937_64 random(seed);
	std::uniform_real_distribution<double> uniform(-1, 1);
	const int D = given.dimension, square = D * D;
	BlockProblem p;
	p.dimension = D;
	p.rowStart.push_back(0);
	for (std::size_t i = 0; i < given.contacts(); ++i) {
		for (int k = given.rowStart[i]; k < given.rowStart[i + 1]; ++k) p.column.push_back(2 * given.column[k]);
		const auto row = [&](int k) { return given.blocks.begin() + std::ptrdiff_t(square) * k; };
		p.blocks.insert(p.blocks.end(), row(given.rowStart[i]), row(given.rowStart[i + 1]));
		p.rowStart.push_back(int(p.column.size()));
		p.column.push_back(int(2 * i + 1));
		const scenes::DenseMatrix factor = scenes::DenseMatrix::NullaryExpr(D, D, [&] { return uniform(random); });
		scenes::DenseMatrix W = factor * factor.transpose() + 0.1 * scenes::DenseMatrix::Identity(D, D);
		W(0, 1) += skew * W(0, 0);
		for (int k = 0; k < square; ++k) p.blocks.push_back(W(k / D, k % D));
		p.rowStart.push_back(int(p.column.size()));
		for (int k = 0; k < D; ++k) p.q.push_back(given.q[D * i + k]);
		for (int k = 0; k < D; ++k) p.q.push_back(uniform(random));
		p.friction.push_back(given.friction[i]);
		p.friction.push_back(0.5 + 0.5 * uniform(random));
	}
	p.impulse.assign(p.q.size(), 0);
	return p;
}

} // namespace

TEST(BlockSolver, WallsOfBricks)
{
	for (const int dimension : {2, 3})
		for (const double friction : {0.0, 0.3, 1.0})
			for (const double decades : {0.0, 3.0})
				for (const unsigned seed : {1u, 2u}) {
					scenes::Wall wall;
					wall.dimension = dimension;
					wall.friction = friction;
					wall.decades = decades;
					wall.seed = seed;
					expectSolved(scenes::wall(wall), std::to_string(dimension) + "D wall, mu " + std::to_string(friction) + ", decades of mass " +
															 std::to_string(decades) + ", seed " + std::to_string(seed));
				}
}

// A contact on which no other one acts is solved as it is alone, wherever it stands among others and whatever it starts from. With an unsymmetric
// block of its own that is a step only, and the sweeps go on.
TEST(BlockSolver, ContactsApartBetweenOthers)
{
	for (const int dimension : {2, 3})
		for (const double skew : {0.0, 1e-3})
			for (const double start : {0.0, 1.0, 1e10}) {
				scenes::Wall wall;
				wall.dimension = dimension;
				BlockProblem given = withContactsApart(scenes::wall(wall), skew, 7);
				std::mt19937_64 random(3);
				for (std::size_t i = 1; i < given.contacts(); i += 2) // far from the solution, where a visit loses digits
					for (int k = 0; k < dimension; ++k)
						given.impulse[dimension * i + k] = start * std::uniform_real_distribution<double>(-1, 1)(random);
				const std::string name = std::to_string(dimension) + "D, skew " + std::to_string(skew) + ", from " + std::to_string(start);
				expectSolved(given, name);
				for (const Acceleration acceleration : {Acceleration::momentum, Acceleration::none}) {
					BlockProblem problem = given;
					SolverOptions options = upTo(1e-8);
					options.acceleration = acceleration;
					ASSERT_EQ(solve(problem, options).status, SolveStatus::converged) << name;
					EXPECT_LE(residualOf(problem, Measure::naturalMap), 1e-8) << name;
					if (skew > 0) continue;
					for (std::size_t i = 1; i < problem.contacts(); i += 2) {
						const double* block = &problem.blocks[std::size_t(dimension) * dimension * problem.rowStart[i]];
						const double *q = &problem.q[dimension * i], *r = &problem.impulse[dimension * i];
						// Forty roundings of a solution, times the condition of its block: eigenvalues from 0.1 to 0.1 + 3^2, so 91 at most.
						if (dimension == 2) {
							const Eigen::Vector2d alone =
									OneContact2D(Eigen::Map<const Eigen::Matrix2d>(block)).solve({q[0], q[1]}, problem.friction[i]);
							EXPECT_LE((Eigen::Map<const Eigen::Vector2d>(r) - alone).norm(), 1e-12 * alone.norm()) << name << ", contact " << i;
						} else {
							const Vector3 alone = OneContact(Eigen::Map<const Matrix3>(block)).solve({q[0], q[1], q[2]}, problem.friction[i]);
							EXPECT_LE((Eigen::Map<const Vector3>(r) - alone).norm(), 1e-12 * alone.norm()) << name << ", contact " << i;
						}
					}
				}
			}
}

TEST(BlockSolver, UnsymmetricAndInOtherUnits)
{
	for (const double gyroscopic : {1e-3, 1e-2})
		for (const double massUnit : {1e-6, 1.0, 1e6}) {
			scenes::Wall wall;
			wall.gyroscopic = gyroscopic;
			wall.massUnit = massUnit;
			BlockProblem problem = scenes::wall(wall);
			// In the measure that has no unit; Siconos's cannot tell 1e-8 from round-off where impulses are a million times smaller than velocities.
			const SolveReport report = solve(problem, upTo(1e-8), Measure::naturalMap);
			EXPECT_EQ(report.status, SolveStatus::converged) << gyroscopic << " " << massUnit << ", residual " << report.residual;
			EXPECT_LE(residualOf(problem, Measure::naturalMap), 1e-8);
		}
}

TEST(BlockSolver, RandomSemiDefinite)
{
	for (const int dimension : {2, 3})
		for (unsigned seed = 1; seed <= 100; ++seed) {
			const int contacts = 1 + int(seed * 7 % 30), full = dimension * contacts;
			for (const int rank : {full + 2, std::max(1, full / 2)})
				expectSolved(scenes::randomProblem(dimension, contacts, rank, 0.02 * (seed % 50), seed),
							 std::to_string(contacts) + " contacts, rank " + std::to_string(rank) + ", seed " + std::to_string(seed));
		}
}

// Masses over three decades: sweeps alone need several times as many (7000 against 1785 when this was written), the finish makes up for the rest.
TEST(BlockSolver, FinishSavesSweeps)
{
	scenes::Wall wall;
	wall.rows = 3;
	wall.friction = 1;
	wall.decades = 3;
	wall.push = 0;
	BlockProblem with = scenes::wall(wall), without = with;
	SolverOptions options = upTo(1e-8);
	const SolveReport finished = solve(with, options, Measure::siconos);
	EXPECT_EQ(finished.status, SolveStatus::converged);
	EXPECT_GT(finished.newtonSteps, 0);
	options.newtonFinish = false;
	const SolveReport swept = solve(without, options, Measure::siconos);
	EXPECT_EQ(swept.newtonSteps, 0);
	EXPECT_GT(swept.iterations, 2 * finished.iterations);
}

// High friction on W of half rank: sweeps stay at a residual of 1e-3 to 1e-2 for ever. On two of these Newton steps from there find the solution, on
// the others nothing, but the central path does.
TEST(BlockSolver, FinishAndPathSolveWhatSweepsDoNot)
{
	for (const unsigned seed : {2u, 11u, 19u, 28u, 40u}) {
		BlockProblem with = scenes::randomProblem(3, 12, 18, 2, seed), without = with;
		SolverOptions options = upTo(1e-8, 5000);
		const SolveReport report = solve(with, options, Measure::siconos);
		EXPECT_EQ(report.status, SolveStatus::converged) << seed;
		EXPECT_LE(scenes::siconosError(with), 1e-8) << seed;
		if (seed < 19)
			EXPECT_GT(report.newtonSteps, 0) << seed;
		else
			EXPECT_GT(report.newtonSteps, 15) << seed << ", more than the Newton finish does";
		options.newtonFinish = false;
		EXPECT_EQ(solve(without, options, Measure::siconos).status, SolveStatus::maxIterations) << seed;
		EXPECT_GT(scenes::siconosError(without), 1e-4) << seed;
	}
}

TEST(BlockSolver, PlainGaussSeidelStaysPlain)
{
	scenes::Wall wall;
	BlockProblem problem = scenes::wall(wall), other = problem;
	SolverOptions options = upTo(1e-14, 300);
	options.acceleration = Acceleration::none;
	const SolveReport report = solve(problem, options);
	EXPECT_EQ(report.iterations, 300);
	EXPECT_EQ(report.newtonSteps, 0);
	options.newtonFinish = false;
	solve(other, options);
	EXPECT_EQ(problem.impulse, other.impulse);
}

// W = 0 and a closing contact, and a wall driven against an immobile direction: there is no solution, and the report must not claim one.
TEST(BlockSolver, NoSolutionIsNotConverged)
{
	BlockProblem immobile;
	immobile.rowStart = {0, 1, 2};
	immobile.column = {0, 1};
	immobile.blocks = {1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
	immobile.q = {-1, 0, 0.1, -1, 0.5, 0}; // the first contact moves along t2, where it has no mobility, with friction that would hold it
	immobile.friction = {0.5, 0.5};
	immobile.impulse.assign(6, 0);
	BlockProblem squeezed = scenes::squeezed();
	for (const Measure measure : {Measure::naturalMap, Measure::siconos})
		for (const double tolerance : {1e-4, 1e-8}) {
			const SolveReport report = solve(squeezed, upTo(tolerance, 20000), measure);
			EXPECT_TRUE(report.status == SolveStatus::maxIterations || report.status == SolveStatus::unbounded);
			for (const double r : squeezed.impulse) EXPECT_TRUE(std::isfinite(r));
		}
	const SolveReport report = solve(immobile, upTo(1e-8, 2000));
	EXPECT_EQ(report.residual, residualOf(immobile, Measure::naturalMap));
	EXPECT_EQ(report.status == SolveStatus::converged, report.residual <= 1e-8);
	for (const double r : immobile.impulse) EXPECT_TRUE(std::isfinite(r));
}

TEST(BlockSolver, NeverWorseThanTheStart)
{
	scenes::Wall wall;
	wall.decades = 3;
	BlockProblem problem = scenes::wall(wall);
	ASSERT_EQ(solve(problem, upTo(1e-8), Measure::siconos).status, SolveStatus::converged);
	const double before = residualOf(problem, Measure::siconos);
	for (const int sweeps : {1, 7, 150}) {
		BlockProblem again = problem;
		const SolveReport report = solve(again, upTo(1e-15, sweeps), Measure::siconos);
		EXPECT_LE(report.residual, before);
		EXPECT_NEAR(scenes::siconosError(again), report.residual, 1e-14);
	}
}

// With a W that can be inverted and q = -W r0, r0 well inside the cones, every contact sticks and the step must lead to r0.
TEST(NewtonStep, StickingProblemInOneStep)
{
	for (const int contacts : {5, 50}) { // the dense and the sparse factorisation
		BlockProblem problem = scenes::randomProblem(3, contacts, 3 * contacts + 30, 0.5, 5);
		const Vector3 solution(1, 0.1, -0.2);
		const auto product = [&](int i, const std::vector<Vector3>& r) {
			Vector3 sum = Vector3::Zero();
			for (int k = problem.rowStart[i]; k < problem.rowStart[i + 1]; ++k)
				sum += Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(&problem.blocks[9 * k]) * r[problem.column[k]];
			return sum;
		};
		const std::vector<Vector3> start(contacts, solution + Vector3(0.01, 0.01, 0)), goal(contacts, solution);
		std::vector<Vector3> u(contacts), next;
		for (int i = 0; i < contacts; ++i) u[i] = product(i, start) - product(i, goal);
		NewtonStep<3> step(problem);
		ASSERT_TRUE(step.compute(start, u, 1e-14, next));
		// The damping and round-off, times the condition that 30 spare rows leave (below 1e4).
		for (int i = 0; i < contacts; ++i) EXPECT_LE((next[i] - solution).norm(), 1e-9) << i;
	}
}
