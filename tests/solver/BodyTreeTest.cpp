// SPDX-License-Identifier: GPL-2.0-or-later
// The tree of bodies by which problems are laid out: the partition, and that nothing but the order of the visits depends on it.
#include "IndependentResidual.hpp"
#include "Scenes.hpp"
#include "pkg/solver/BodyTree.hpp"
#include "pkg/solver/GrainOperator.hpp"
#include "pkg/solver/SignoriniCoulombSolver.hpp"

#include <gtest/gtest.h>
#include <map>
#include <numeric>
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

struct Built {
	GrainProblem problem;
	std::vector<std::uint8_t> movable;
	BodyTree tree;

	Built(GrainProblem given, int levels, int depth, int threads = 1) : problem(std::move(given)), movable(movableOf(problem))
	{
		Crew crew(threads);
		crew.resume();
		tree.build(problem, movable, levels, depth, crew);
	}
	/// Bodies that can move of each job.
	std::vector<std::set<std::int32_t>> bodiesOfJobs() const
	{
		std::vector<std::set<std::int32_t>> bodies(tree.jobs());
		for (const Contact& c : problem.contacts)
			for (const std::int32_t body : {c.body1, c.body2})
				if (movable[body]) bodies[jobOf(c)].insert(body);
		return bodies;
	}
	std::size_t jobOf(const Contact& c) const
	{
		std::size_t job = 0;
		while (tree.firstNode(job + 1) <= tree.of(c)) ++job;
		return job;
	}
	std::int32_t regionOf(std::int32_t body) const { return tree.block[body] / std::int32_t(tree.blocks() / tree.regions()); }
};

void expectApart(const std::vector<std::set<std::int32_t>>& bodies, std::size_t first, std::size_t last, const char* what)
{
	std::set<std::int32_t> together;
	std::size_t count = 0;
	for (std::size_t job = first; job < last; ++job) {
		together.insert(bodies[job].begin(), bodies[job].end());
		count += bodies[job].size();
	}
	EXPECT_EQ(together.size(), count) << what << ", jobs " << first << " to " << last;
}

const std::vector<std::pair<int, int>> shapes{{0, 0}, {0, 3}, {1, 1}, {2, 4}, {3, 3}, {4, 4}, {5, 6}, {6, 6}, {6, 11}}; // levels, depth

} // namespace

TEST(BodyTree, EachMovingBodyHasOneSeatInOneBlock)
{
	for (const auto& [levels, depth] : shapes) {
		const Built built(scenes::heap(8, 3), levels, depth);
		const BodyTree& tree = built.tree;
		ASSERT_EQ(tree.regions(), std::size_t(1) << levels);
		ASSERT_EQ(tree.blocks(), std::size_t(1) << depth);
		std::set<std::int32_t> seats;
		for (std::size_t i = 0; i < built.movable.size(); ++i) {
			seats.insert(tree.seat[i]);
			ASSERT_EQ(tree.block[i] >= 0, bool(built.movable[i]));
			if (!built.movable[i]) continue;
			EXPECT_GE(tree.seat[i], tree.firstSeat[tree.block[i]]);
			EXPECT_LT(tree.seat[i], tree.firstSeat[tree.block[i] + 1]);
		}
		EXPECT_EQ(seats.size(), built.movable.size());
		EXPECT_EQ(*seats.begin(), 0);
		EXPECT_EQ(*seats.rbegin(), std::int32_t(built.movable.size()) - 1);
	}
}

TEST(BodyTree, PartsOfAHalvingWeighTheSame)
{
	// A body weighs one more than its contacts; a cut is off by less than the body next to it, and the halvings below halve that: twice in all.
	for (const auto& [levels, depth] : shapes) {
		const Built built(scenes::heap(12, 3), levels, depth);
		std::vector<double> weight(built.movable.size(), 1), ofBlock(built.tree.blocks());
		for (const Contact& c : built.problem.contacts) {
			++weight[c.body1];
			++weight[c.body2];
		}
		weight[0] = 0; // the walls
		const double heaviest = *std::max_element(weight.begin(), weight.end());
		for (std::size_t i = 0; i < weight.size(); ++i)
			if (built.movable[i]) ofBlock[built.tree.block[i]] += weight[i];
		const double mean = std::accumulate(weight.begin(), weight.end(), 0.0) / double(ofBlock.size());
		for (const double one : ofBlock) EXPECT_NEAR(one, mean, 2 * heaviest) << levels << " of " << depth;
	}
}

TEST(BodyTree, ContactsGoWhereTheirBodiesHaveBeenMetBefore)
{
	for (const auto& [levels, depth] : shapes) {
		const Built built(scenes::heap(10, 5), levels, depth);
		const BodyTree& tree = built.tree;
		for (const Contact& c : built.problem.contacts) {
			const std::size_t node = tree.of(c);
			ASSERT_LT(node, tree.nodes());
			const std::int32_t later = std::max(tree.block[c.body1], tree.block[c.body2]);
			const bool within = c.body1 == 0 || c.body2 == 0 || built.regionOf(c.body1) == built.regionOf(c.body2);
			if (within)
				EXPECT_EQ(node, std::size_t(later));
			else
				EXPECT_GE(node, tree.blocks());
		}
	}
}

TEST(BodyTree, JobsOfOneStageHaveNoBodyInCommon)
{
	for (const auto& [levels, depth] : shapes) {
		const Built built(scenes::heap(12, 5), levels, depth);
		const BodyTree& tree = built.tree;
		const auto bodies = built.bodiesOfJobs();
		for (int level = 0; level <= tree.undivided(); ++level) expectApart(bodies, tree.joint(level, 0), tree.joint(level + 1, 0), "level");
		EXPECT_EQ(tree.jobs(), tree.firstPair() + tree.stages() * tree.pairsPerStage());
		for (std::size_t first = tree.firstPair(); first < tree.jobs(); first += tree.pairsPerStage())
			expectApart(bodies, first, first + tree.pairsPerStage(), "stage");
		// A joint meets none but the bodies of its two parts, which nobody else meets before it.
		for (int level = 1; level <= tree.undivided(); ++level)
			for (std::size_t job = tree.joint(level, 0); job < tree.joint(level + 1, 0); ++job)
				for (const std::int32_t body : bodies[job])
					EXPECT_EQ(built.regionOf(body) >> level, std::int32_t(job - tree.joint(level, 0))) << "level " << level;
	}
}

TEST(BodyTree, TheTopmostJointsAreWorkForMany)
{
	// Across a cut, most contacts are between parts that lie opposite each other: the fullest stage of a level has at least half of them.
	const Built built(scenes::heap(14, 5), 6, 6);
	const BodyTree& tree = built.tree;
	ASSERT_EQ(tree.pairsPerStage(), 4u);
	ASSERT_EQ(tree.stages(), 6u); // two of level 5, four of level 6
	std::vector<std::size_t> contacts(tree.jobs());
	for (const Contact& c : built.problem.contacts) ++contacts[built.jobOf(c)];
	const auto inStage = [&](std::size_t stage) {
		const auto first = contacts.begin() + std::ptrdiff_t(tree.firstPair() + stage * tree.pairsPerStage());
		return std::vector<std::size_t>(first, first + std::ptrdiff_t(tree.pairsPerStage()));
	};
	for (const auto& [first, last] : {std::pair<std::size_t, std::size_t>{0, 2}, {2, 6}}) {
		std::vector<std::size_t> fullest;
		std::size_t all = 0, most = 0;
		for (std::size_t stage = first; stage < last; ++stage) {
			const auto jobs = inStage(stage);
			const std::size_t sum = std::accumulate(jobs.begin(), jobs.end(), std::size_t(0));
			all += sum;
			if (sum <= most) continue;
			most = sum;
			fullest = jobs;
		}
		ASSERT_GT(all, 100u);
		EXPECT_GE(2 * most, all);
		EXPECT_LE(2 * *std::max_element(fullest.begin(), fullest.end()), most); // none of the four does more than half
	}
}

TEST(BodyTree, BlocksAreCompact)
{
	// 64 blocks of 43 bodies of a simple cubic lattice: a cube has three contacts a body, of which a share of 1 / 3.5 lies across its faces. Rods of
	// one body across would have two thirds there, bodies picked at random nearly all.
	const Built built(scenes::heap(14, 2), 6, 6);
	std::size_t across = 0, links = 0;
	for (const Contact& c : built.problem.contacts) {
		if (c.body1 == 0 || c.body2 == 0) continue;
		++links;
		across += built.tree.block[c.body1] != built.tree.block[c.body2];
	}
	EXPECT_LT(double(across), 0.4 * double(links));
}

TEST(BodyTree, AnyCentresGiveAPartition)
{
	// None, all on a line, half of them in one place, too far apart for their difference to be a number.
	for (int kind = 0; kind < 4; ++kind) {
		GrainProblem problem = scenes::heap(8, 3);
		for (std::size_t i = 0; i < problem.bodies.size(); ++i) {
			Vector3& centre = problem.bodies[i].centre;
			if (kind == 0) centre.setZero();
			if (kind == 1) centre = Vector3(0, 3e-310 * double(i % 7), 0);
			if (kind == 2 && i % 2) centre.setOnes();
			if (kind == 3 && i % 2) centre.setConstant(i % 3 ? 1.7e308 : -1.7e308);
		}
		const Built built(problem, 4, 5);
		std::vector<int> bodies(built.tree.blocks());
		for (const std::int32_t block : built.tree.block)
			if (block >= 0) ++bodies[block];
		EXPECT_GT(*std::min_element(bodies.begin(), bodies.end()), 0) << kind;
	}
}

TEST(BodyTree, RowsThatTurnBackAreHalvedAsFastAsOthers)
{
	// There and back again along a line: pivots from the ends and the middle of a range are its extremes, and took 47 s for as many bodies.
	constexpr int bodies = 262144;
	GrainProblem problem;
	for (int i = 0; i < bodies; ++i) {
		problem.bodies.push_back(scenes::ball(1, 1));
		problem.bodies.back().centre[0] = std::abs(i - bodies / 2);
	}
	const Built built(std::move(problem), 6, 8);
	for (std::size_t b = 0; b < built.tree.blocks(); ++b) EXPECT_EQ(built.tree.firstSeat[b + 1] - built.tree.firstSeat[b], bodies / 256);
}

TEST(BodyTree, SameForAnyNumberOfThreadsAndAnyOrderInMemory)
{
	const GrainProblem problem = scenes::heap(12, 5);
	const Built one(problem, 4, 6);
	const Built three(problem, 4, 6, 3);
	EXPECT_EQ(one.tree.seat, three.tree.seat);
	EXPECT_EQ(one.tree.block, three.tree.block);
	GrainProblem turned = problem; // all bodies, and with them the items, in the opposite order
	const auto last = std::int32_t(problem.bodies.size()) - 1;
	std::reverse(turned.bodies.begin(), turned.bodies.end());
	for (Contact& c : turned.contacts) {
		c.body1 = last - c.body1;
		c.body2 = last - c.body2;
	}
	const Built other(turned, 4, 6);
	for (std::int32_t i = 0; i <= last; ++i) ASSERT_EQ(one.tree.block[i], other.tree.block[last - i]) << i;
}

TEST(BodyTree, EveryContactOfALargeProblemIsVisited)
{
	// Pairs that meet head-on, far from each other: a single visit stops each with its own closed form, J = 2 m v / 2 for the pair number v.
	GrainProblem problem;
	const int pairs = 260000; // several blocks in a region
	for (int i = 0; i < pairs; ++i) {
		problem.bodies.push_back(scenes::ball(1, 1, {double(1 + i), 0, 0}));
		problem.bodies.push_back(scenes::ball(1, 1, {-double(1 + i), 0, 0}));
		const int column = i % 500, row = i / 500;
		problem.bodies[problem.bodies.size() - 2].centre = Vector3(0, column, row);
		problem.bodies.back().centre = Vector3(1, column, row);
		problem.contacts.push_back(scenes::touch(2 * i, 1, 2 * i + 1, 1, Vector3::UnitX(), 0.3));
	}
	const SolveReport report = SignoriniCoulombSolver().solve(problem, upTo(1e-12, 10, 2));
	EXPECT_EQ(report.status, SolveStatus::converged);
	EXPECT_LE(report.iterations, 2); // the first one solves, the second sees that nothing changes
	for (int i = 0; i < pairs; ++i) ASSERT_NEAR(problem.contacts[i].impulse[0], 1 + i, 1e-14 * (1 + i)) << i;
}

TEST(BodyTree, ContactsThatWakeTogetherAreVisited)
{
	// Two jaws close at speed v on light balls that they touch at 30 degrees, and squeeze them out at v cot(30) = 1.73 v, faster than anything closes
	// at first. Each reaches another ball within the step, which leaves at 1.73 v - s: gaps too wide to be looked at before the first has moved.
	constexpr int squeezed = 1800; // more than a region has, so that they are a pass for many threads
	constexpr double v = 0.7;
	const double cosine = std::cos(M_PI / 6), sine = std::sin(M_PI / 6);
	GrainProblem problem;
	problem.bodies = {scenes::wall(), scenes::wall()};
	problem.bodies[0].velocity = {v, 0, 0};
	problem.bodies[1].velocity = {-v, 0, 0};
	std::vector<double> gap;
	for (int i = 0; i < squeezed; ++i) {
		const int first = int(problem.bodies.size());
		for (int k = 0; k < 2; ++k) {
			problem.bodies.push_back(scenes::ball(1, 1));
			problem.bodies.back().centre = Vector3(i % 40, 2 * k, 3 * (i % 50));
		}
		problem.contacts.push_back(scenes::touch(0, 0, first, 1, {cosine, sine, 0}, 0));
		problem.contacts.push_back(scenes::touch(1, 0, first, 1, {-cosine, sine, 0}, 0));
		gap.push_back(v * (1 + 0.6 * i / squeezed));
		problem.contacts.push_back(scenes::touch(first, 1, first + 1, 1, Vector3::UnitY(), 0, gap.back()));
	}
	GrainProblem two = problem;
	SignoriniCoulombSolver solver;
	ASSERT_EQ(solver.solve(problem, upTo(1e-12, 1000)).status, SolveStatus::converged);
	for (int i = 0; i < squeezed; ++i) // the residual times the root of the sum of r W r, some hundred, times ten for two contacts in a row
		ASSERT_NEAR(problem.bodies[std::size_t(3 + 2 * i)].velocity[1], v * cosine / sine - gap[std::size_t(i)], 1e-9) << i;
	ASSERT_EQ(solver.solve(two, upTo(1e-12, 1000, 3)).status, SolveStatus::converged);
	for (std::size_t i = 0; i < problem.contacts.size(); ++i) ASSERT_EQ(problem.contacts[i].impulse, two.contacts[i].impulse) << i;
}

TEST(BodyTree, BodiesThatCannotMoveNeedNoTree)
{
	GrainProblem problem;
	problem.bodies = {scenes::wall(), scenes::wall()};
	problem.bodies[1].velocity = {-1, 0, 0};
	problem.contacts.assign(10000, scenes::touch(0, 0, 1, 0, Vector3::UnitX(), 0.3));
	const SolveReport report = SignoriniCoulombSolver().solve(problem, upTo(1e-8, 10));
	EXPECT_EQ(report.status, SolveStatus::converged);
	EXPECT_EQ(report.activeContacts, 0);
	EXPECT_EQ(report.maxApproachSpeed, 1);
}

TEST(BodyTree, AProblemHasTheSolutionOfItsParts)
{
	// The parts lie in one another, so the tree of both has nothing to do with those of each. Velocities agree as far as the tolerance determines
	// them.
	for (const double friction : {0.0, 0.3}) {
		GrainProblem one = scenes::heap(20, 3, friction), two = scenes::heap(20, 4, friction);
		GrainProblem both = joined(one, two);
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

TEST(BodyTree, SweepsKeepVelocitiesAndImpulsesTogether)
{
	// Two sheets far from each other, with contacts from one to the other only: all contacts are those of the last joint, no block has any.
	GrainProblem sheets;
	sheets.bodies.push_back(scenes::wall());
	for (int i = 0; i < 8000; ++i) {
		sheets.bodies.push_back(scenes::ball(1, 1, Vector3(0, 0.3 * (i % 3), i < 4000 ? 1 : -1)));
		const int column = i % 4000 % 63, row = i % 4000 / 63;
		sheets.bodies.back().centre = Vector3(column, row, i < 4000 ? 0 : 1000);
	}
	for (int i = 1; i <= 4000; ++i)
		for (const int j : {i, i % 4000 + 1}) sheets.contacts.push_back(scenes::touch(i, 1, 4000 + j, 1, Vector3::UnitZ(), 0.3));
	// A lattice so large that each region has two blocks.
	constexpr int side = 45;
	GrainProblem lattice;
	lattice.bodies.push_back(scenes::wall());
	for (int i = 0; i < side * side * side; ++i) {
		lattice.bodies.push_back(scenes::ball(1, 1, Vector3(0.1 * (i % 5), 0.1 * (i % 7), -1)));
		const int at[]{i % side, i / side % side, i / side / side}, before[]{i, i + 1 - side, i + 1 - side * side};
		lattice.bodies.back().centre = Vector3(at[0], at[1], at[2]);
		for (int axis = 0; axis < 3; ++axis)
			lattice.contacts.push_back(scenes::touch(at[axis] ? before[axis] : 0, at[axis] ? 1 : 0, i + 1, 1, Vector3::Unit(axis), 0.3));
	}
	for (const GrainProblem& given : {sheets, scenes::heap(14, 7, 0.3, true, true), lattice}) {
		GrainProblem once = given, often = given;
		GrainOperator one, other;
		Crew crew(1);
		crew.resume();
		one.start(once, true, crew);
		other.start(often, true, crew);
		for (int i = 0; i < 5; ++i) {
			one.sweep({0.4, 0.3});
			other.sweep({0.4, 0.3});
			other.certificate(); // velocities anew, from the impulses
		}
		SolveReport report;
		one.certificate();
		one.finish(report);
		other.finish(report);
		double largest = 0, difference = 0;
		for (std::size_t i = 0; i < given.contacts.size(); ++i) {
			largest = std::max(largest, once.contacts[i].impulse.norm());
			difference = std::max(difference, (once.contacts[i].impulse - often.contacts[i].impulse).norm());
		}
		EXPECT_GT(largest, 0);
		// Round-off of sums of a dozen terms, carried on through five sweeps that at most double it.
		EXPECT_LT(difference, 1e-12 * largest) << given.contacts.size() << " contacts";
	}
}

TEST(BodyTree, SameBitsForAnyNumberOfThreads)
{
	// Joints, divided joints, and more of them; contacts that wake later are laid out as passes of their own.
	for (const int side : {11, 14, 19, 26})
		for (const bool general : {false, true}) {
			GrainProblem given = scenes::heap(side, 11, 0.3, true, general);
			ASSERT_TRUE(GrainOperator::isWorthThreads(given.contacts.size()));
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
				for (std::size_t i = 0; i < given.bodies.size(); ++i)
					ASSERT_EQ(more.bodies[i].velocity, one.bodies[i].velocity) << threads << " threads";
			}
		}
}

TEST(BodyTree, ALargeProblemWithAMeanFieldEndsConsistent)
{
	GrainProblem problem = scenes::heap(25, 11, 0.3, true);
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
