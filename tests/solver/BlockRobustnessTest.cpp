// SPDX-License-Identifier: GPL-2.0-or-later
// Ten thousand block problems that are degenerate on purpose: whatever is thrown at it, a truthful status, never NaN, never without end.
#include "BlockScenes.hpp"
#include "pkg/solver/BlockProblem.hpp"

#include <gtest/gtest.h>

using namespace contactdynamics;

namespace {

/// W = H^T B H with few rows in H, repeated contacts, contacts between immobile bodies, masses over six decades, slightly unsymmetric, in any unit. q
/// lies in the range of H^T, or not: then walls are driven and there may be no solution.
BlockProblem degenerate(std::mt19937_64& random)
{
	std::normal_distribution<double> normal;
	std::uniform_real_distribution<double> uniform(0, 1);
	const auto chance = [&](double p) { return uniform(random) < p; };
	const int dimension = chance(0.5) ? 2 : 3;
	const int contacts = chance(0.005) ? 100 + int(400 * uniform(random)) : 1 + int(40 * std::pow(uniform(random), 4));
	const int bodies = 1 + int(contacts * uniform(random)), size = chance(0.5) ? dimension : 3 * (dimension - 1);
	scenes::DenseMatrix H = scenes::DenseMatrix::Zero(size * bodies, dimension * contacts);
	scenes::DenseMatrix inverseMass = scenes::DenseMatrix::Zero(size * bodies, size * bodies);
	const bool ratios = chance(0.3);
	const double unit = chance(0.2) ? std::pow(10, 12 * uniform(random) - 6) : 1;
	for (int i = 0; i < size * bodies; ++i) inverseMass(i, i) = unit * (ratios ? std::pow(10, -6 * uniform(random)) : 1);
	for (int c = 0; c < contacts; ++c) {
		const int column = dimension * c;
		if (c && chance(0.15)) {
			H.middleCols(column, dimension) = H.middleCols(dimension * int(c * uniform(random)), dimension);
			continue;
		}
		if (chance(0.03)) continue; // cannot move at all
		for (const int side : {1, -1}) {
			const int body = int(bodies * uniform(random));
			if (side < 0 && chance(0.3)) break; // against the ground
			for (int row = 0; row < size; ++row)
				for (int k = 0; k < dimension; ++k)
					H(size * body + row, column + k) += row < dimension ? side * (row == k) : (chance(0.2) ? 0 : normal(random));
		}
	}
	Eigen::VectorXd v(size * bodies);
	for (double& entry : v) entry = normal(random);
	BlockProblem problem = scenes::blockProblem(dimension, H, inverseMass, v, chance(0.2) ? 0 : 1.5 * uniform(random));
	if (chance(0.3))
		for (double& q : problem.q) q += chance(0.2) ? normal(random) : 0;
	if (chance(0.2))
		for (double& entry : problem.blocks) entry *= 1 + 1e-10 * normal(random);
	if (chance(0.2))
		for (double& mu : problem.friction) mu = uniform(random);
	if (chance(0.2))
		for (double& r : problem.impulse) r = normal(random) * std::pow(10, 6 * uniform(random) - 3);
	return problem;
}

} // namespace

/// Ten thousand problems in shards of a thousand, which run side by side: under a sanitizer each takes minutes.
class BlockRobustness : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(TenThousand, BlockRobustness, testing::Range(0, 10));

TEST_P(BlockRobustness, DegenerateProblemsEndWithATruthfulStatus)
{
	std::mt19937_64 random(11 + unsigned(GetParam()));
	int converged = 0, unbounded = 0;
	for (int k = 0; k < 1000; ++k) {
		const BlockProblem given = degenerate(random);
		BlockProblem problem = given;
		SolverOptions options;
		options.tolerance = k % 2 ? 1e-4 : 1e-8;
		options.maxIterations = given.contacts() > 100 ? 50 : 400;
		const Measure measure = k % 4 < 2 ? Measure::siconos : Measure::naturalMap;
		const SolveReport report = solve(problem, options, measure);
		ASSERT_NE(report.status, SolveStatus::notFinite) << k;
		ASSERT_TRUE(std::isfinite(report.residual)) << k;
		ASSERT_LE(report.iterations, options.maxIterations) << k;
		ASSERT_EQ(report.status == SolveStatus::maxIterations, report.residual > options.tolerance) << k;
		converged += report.status == SolveStatus::converged;
		unbounded += report.status == SolveStatus::unbounded;
		const int d = problem.dimension;
		double size = 0;
		for (std::size_t i = 0; i < problem.contacts(); ++i) {
			const Eigen::Map<const Eigen::VectorXd> r(&problem.impulse[d * i], d), u(&problem.velocity[d * i], d);
			ASSERT_TRUE(r.allFinite() && u.allFinite()) << k;
			ASSERT_GE(r[0], 0) << k;
			ASSERT_LE(r.tail(d - 1).norm(), problem.friction[i] * r[0] * (1 + 1e-12)) << k << ", contact " << i;
			size = std::max(size, r.norm());
		}
		// The velocities and the residual belong to the impulses: round-off of W r apart, which counts where impulses are huge.
		double W = 0;
		for (const double entry : given.blocks) W = std::max(W, std::abs(entry));
		if (measure == Measure::siconos) {
			ASSERT_NEAR(report.residual, scenes::siconosError(problem), 1e-12 * (1 + W) + 1e-9 * report.residual) << k;
		}
		const double start = residualOf(given, measure);
		// The start is brought into the cones first; where it lies in them, the end is no worse.
		bool inside = true;
		for (std::size_t i = 0; i < given.contacts(); ++i) {
			const Eigen::Map<const Eigen::VectorXd> r(&given.impulse[d * i], d);
			inside = inside && r.tail(d - 1).norm() <= given.friction[i] * r[0];
		}
		if (inside) { ASSERT_LE(report.residual, start * (1 + 1e-12)) << k; }
	}
	// What fails has driven walls, or is cut short on purpose.
	EXPECT_GT(converged, 800);
	EXPECT_GT(unbounded, 0);
}
