// SPDX-License-Identifier: GPL-2.0-or-later
// Large problems, which are laid out block by block of neighbouring bodies: the partition, and that nothing but the order of the visits changes.
#include "IndependentResidual.hpp"
#include "Scenes.hpp"
#include "pkg/solver/BodyBlocks.hpp"
#include "pkg/solver/GrainOperator.hpp"
#include "pkg/solver/SignoriniCoulombSolver.hpp"

#include <gtest/gtest.h>
#include <set>

using namespace contactdynamics;

namespace {

std::vector<std::uint8_t> movableOf(const GrainProblem& problem)
{
	std::vector<std::uint8_t> movable;
	for (const Body& body : problem.bodies) movable.push_back(!body.inverseMass.isZero(0));
	return movable;
}

/// Two problems side by side, without a contact between them.
GrainProblem joined(const GrainProblem& one, const GrainProblem& two)
{
	GrainProblem both = one;
	both.bodies.insert(both.bodies.end(), two.bodies.begin(), two.bodies.end());
	for (Contact c : two.contacts) {
		c.body1 += std::int32_t(one.bodies.size());
		c.body2 += std::int32_t(one.bodies.size());
		both.contacts.push_back(c);
	}
	return both;
}

SolverOptions upTo(double tolerance, int sweeps, int threads = 1)
{
	SolverOptions options;
	options.tolerance = tolerance;
	options.maxIterations = sweeps;
	options.threads = threads;
	return options;
}

GrainProblem large(bool general, double friction = 0.3) { return scenes::heap(25, 11, friction, true, general); }

} // namespace

TEST(BodyBlocks, EachMovingBodyHasOneSeatInOneBlock)
{
	BodyBlocks blocks;
	for (const std::size_t perBlock : {1, 7, 50, 5000}) {
		const GrainProblem problem = scenes::heap(8, 3);
		const std::vector<std::uint8_t> movable = movableOf(problem);
		blocks.build(problem, movable, perBlock);
		std::set<std::int32_t> seats;
		for (std::size_t i = 0; i < movable.size(); ++i) {
			seats.insert(blocks.seat[i]);
			ASSERT_EQ(blocks.block[i] >= 0, bool(movable[i]));
			if (!movable[i]) continue;
			EXPECT_GE(blocks.seat[i], blocks.firstSeat[blocks.block[i]]);
			EXPECT_LT(blocks.seat[i], blocks.firstSeat[blocks.block[i] + 1]);
		}
		EXPECT_EQ(seats.size(), movable.size());
		EXPECT_EQ(*seats.begin(), 0);
		EXPECT_EQ(*seats.rbegin(), std::int32_t(movable.size()) - 1);
		for (std::size_t b = 0; b < blocks.count(); ++b) EXPECT_LE(blocks.firstSeat[b + 1] - blocks.firstSeat[b], std::int32_t(perBlock));
		// Only the last block to grow may be smaller than asked for.
		EXPECT_EQ(blocks.count(), (512 + perBlock - 1) / perBlock);
	}
}

TEST(BodyBlocks, BlocksOfOneColourMeetNoBodyInCommonAndOthersOnlyAfterTheirOwnBlock)
{
	for (const std::size_t perBlock : {5, 40}) {
		const GrainProblem problem = scenes::heap(10, 5);
		const std::vector<std::uint8_t> movable = movableOf(problem);
		BodyBlocks blocks;
		blocks.build(problem, movable, perBlock);
		ASSERT_EQ(blocks.firstBlock.back(), std::int32_t(blocks.count()));
		std::vector<std::set<std::int32_t>> met(blocks.count());
		for (const Contact& c : problem.contacts)
			for (const std::int32_t body : {c.body1, c.body2}) {
				if (!movable[body]) continue;
				met[blocks.of(c)].insert(body);
				EXPECT_LE(blocks.block[body], blocks.of(c));
			}
		for (std::size_t colour = 0; colour + 1 < blocks.firstBlock.size(); ++colour) {
			std::set<std::int32_t> together;
			std::size_t count = 0;
			for (std::int32_t b = blocks.firstBlock[colour]; b < blocks.firstBlock[colour + 1]; ++b) {
				together.insert(met[b].begin(), met[b].end());
				count += met[b].size();
			}
			EXPECT_EQ(together.size(), count) << "colour " << colour;
		}
	}
}

TEST(BodyBlocks, BlocksAreCompact)
{
	// Blocks of 50 bodies of a simple cubic lattice: a cube has about three contacts a body, of which a share of 1 / 3.7 lies across its faces. Rods
	// of one body across would have two thirds there, bodies picked at random nearly all.
	const GrainProblem problem = scenes::heap(14, 2);
	BodyBlocks blocks;
	blocks.build(problem, movableOf(problem), 50);
	std::size_t across = 0, links = 0;
	for (const Contact& c : problem.contacts) {
		if (c.body1 == 0 || c.body2 == 0) continue;
		++links;
		across += blocks.block[c.body1] != blocks.block[c.body2];
	}
	EXPECT_LT(double(across), 0.5 * double(links));
}

TEST(BodyBlocks, EveryContactOfALargeProblemIsVisited)
{
	// Pairs that meet head-on, far from each other: a single visit stops each with its own closed form, J = 2 m v / 2 for the pair number v.
	GrainProblem problem;
	const int pairs = int(GrainOperator::blockwiseFrom) + 3;
	for (int i = 0; i < pairs; ++i) {
		problem.bodies.push_back(scenes::ball(1, 1, {double(1 + i), 0, 0}));
		problem.bodies.push_back(scenes::ball(1, 1, {-double(1 + i), 0, 0}));
		problem.contacts.push_back(scenes::touch(2 * i, 1, 2 * i + 1, 1, Vector3::UnitX(), 0.3));
	}
	const SolveReport report = SignoriniCoulombSolver().solve(problem, upTo(1e-12, 10, 2));
	EXPECT_EQ(report.status, SolveStatus::converged);
	EXPECT_LE(report.iterations, 2); // the first one solves, the second sees that nothing changes
	for (int i = 0; i < pairs; ++i) ASSERT_NEAR(problem.contacts[i].impulse[0], 1 + i, 1e-14 * (1 + i)) << i;
}

TEST(BodyBlocks, BodiesThatCannotMoveNeedNoBlock)
{
	GrainProblem problem;
	problem.bodies = {scenes::wall(), scenes::wall()};
	problem.bodies[1].velocity = {-1, 0, 0};
	problem.contacts.assign(GrainOperator::blockwiseFrom, scenes::touch(0, 0, 1, 0, Vector3::UnitX(), 0.3));
	const SolveReport report = SignoriniCoulombSolver().solve(problem, upTo(1e-8, 10));
	EXPECT_EQ(report.status, SolveStatus::converged);
	EXPECT_EQ(report.activeContacts, 0);
	EXPECT_EQ(report.maxApproachSpeed, 1);
}

TEST(BodyBlocks, ALargeProblemHasTheSolutionOfItsSmallParts)
{
	// Each part alone is laid out by colour, both together by block. Velocities agree as far as the tolerance determines them.
	for (const double friction : {0.0, 0.3}) {
		GrainProblem one = scenes::heap(20, 3, friction), two = scenes::heap(20, 4, friction);
		GrainProblem both = joined(one, two);
		ASSERT_LT(one.contacts.size(), GrainOperator::blockwiseFrom);
		ASSERT_LT(two.contacts.size(), GrainOperator::blockwiseFrom);
		ASSERT_GE(both.contacts.size(), GrainOperator::blockwiseFrom);
		const GrainProblem free = both;
		const double tolerance = 1e-6;
		SignoriniCoulombSolver solver;
		ASSERT_EQ(solver.solve(one, upTo(tolerance, 5000)).status, SolveStatus::converged);
		ASSERT_EQ(solver.solve(two, upTo(tolerance, 5000)).status, SolveStatus::converged);
		const SolveReport report = solver.solve(both, upTo(tolerance, 5000, 2));
		ASSERT_EQ(report.status, SolveStatus::converged);
		EXPECT_NEAR(report.residual, independent::residual(free, both), 1e-6 * report.residual);
		// Both residuals together are no larger than the larger one of the parts: sums over the contacts.
		const independent::Agreement found = independent::agreement(free, both, joined(one, two), tolerance);
		EXPECT_LE(found.energy, found.bound);
		EXPECT_LE(found.bound, 1e-4 * scenes::kineticEnergy(both)); // or it would say little
	}
}

TEST(BodyBlocks, LargeProblemsHaveTheSameBitsForAnyNumberOfThreads)
{
	for (const bool general : {false, true}) {
		GrainProblem given = large(general);
		ASSERT_GE(given.contacts.size(), GrainOperator::blockwiseFrom);
		if (!general) {
			given.meanField.emplace();
			given.meanField->inverseMass.setConstant(1e-4);
		}
		const SolverOptions options = upTo(1e-12, general ? 10 : 30);
		GrainProblem one = given;
		SignoriniCoulombSolver solver;
		const SolveReport first = solver.solve(one, options);
		for (const int threads : {2, 3, 8}) {
			GrainProblem more = given;
			SolverOptions together = options;
			together.threads = threads;
			const SolveReport report = solver.solve(more, together);
			EXPECT_EQ(report.residual, first.residual) << threads << " threads";
			for (std::size_t i = 0; i < given.contacts.size(); ++i)
				ASSERT_EQ(more.contacts[i].impulse, one.contacts[i].impulse) << threads << " threads";
			for (std::size_t i = 0; i < given.bodies.size(); ++i) ASSERT_EQ(more.bodies[i].velocity, one.bodies[i].velocity) << threads << " threads";
		}
	}
}

TEST(BodyBlocks, ALargeProblemWithAMeanFieldEndsConsistent)
{
	GrainProblem problem = large(false);
	problem.meanField.emplace();
	problem.meanField->inverseMass.setConstant(1e-6);
	const GrainProblem free = problem;
	const SolveReport report = SignoriniCoulombSolver().solve(problem, upTo(1e-4, 3000, 2));
	ASSERT_EQ(report.status, SolveStatus::converged) << report.residual;
	Matrix3 moment = Matrix3::Zero();
	for (const Contact& c : problem.contacts) moment += c.impulse * (c.arm1 - c.arm2).transpose();
	const Matrix3 expected = free.meanField->gradientWith(moment);
	ASSERT_GT(expected.norm(), 1e-3);
	// Round-off of a sum of 40,000 terms.
	EXPECT_LE((problem.meanField->gradient - expected).norm(), 1e-10 * expected.norm());
}
