// SPDX-License-Identifier: GPL-2.0-or-later
// What cannot be solved is told from what is only hard: chains between driven walls, heaps around them, high columns at loose tolerances.
#include "BlockScenes.hpp"
#include "pkg/solver/CrushedContacts.hpp"

#include <gtest/gtest.h>

using namespace contactdynamics;

namespace {

/// Masses of 1 kg on a line that cannot turn, each touching the next; the first touches a floor, the last, if so, a lid. All fall with the speed
/// given, the lid comes down with its own [m/s].
BlockProblem column(int masses, bool lid, double lidSpeed, double fall = 1)
{
	scenes::DenseMatrix H = scenes::DenseMatrix::Zero(2 * masses, 2 * (masses + lid));
	Eigen::VectorXd v = Eigen::VectorXd::Zero(2 * masses);
	for (int i = 0; i < masses + lid; ++i)
		for (int k = 0; k < 2; ++k) {
			if (i < masses) H(2 * i + k, 2 * i + k) = 1;
			if (i > 0) H(2 * (i - 1) + k, 2 * i + k) = -1;
		}
	for (int i = 0; i < masses; ++i) v[2 * i] = -fall;
	BlockProblem problem = scenes::blockProblem(2, H, scenes::DenseMatrix::Identity(2 * masses, 2 * masses), v, 0.3);
	if (lid) problem.q[2 * masses] -= lidSpeed;
	return problem;
}

/// Both problems in one, with nothing in common.
BlockProblem together(const BlockProblem& a, const BlockProblem& b)
{
	BlockProblem both = a;
	const int blocks = int(a.column.size()), contacts = int(a.contacts());
	for (std::size_t i = 1; i < b.rowStart.size(); ++i) both.rowStart.push_back(b.rowStart[i] + blocks);
	for (const int j : b.column) both.column.push_back(j + contacts);
	const auto append = [](std::vector<double>& to, const std::vector<double>& from) { to.insert(to.end(), from.begin(), from.end()); };
	append(both.blocks, b.blocks);
	append(both.q, b.q);
	append(both.friction, b.friction);
	append(both.impulse, b.impulse);
	return both;
}

SolveStatus statusOf(BlockProblem problem, double tolerance, Measure measure, bool finish = true, int sweeps = 20000)
{
	SolverOptions options;
	options.tolerance = tolerance;
	options.maxIterations = sweeps;
	options.newtonFinish = finish;
	return solve(problem, options, measure).status;
}

} // namespace

TEST(CrushedContacts, BetweenDrivenWalls)
{
	for (const Measure measure : {Measure::naturalMap, Measure::siconos})
		for (const double tolerance : {1e-2, 1e-4, 1e-8})
			for (const bool finish : {false, true})
				for (const int masses : {1, 3})
					for (const double fall : {1.0, 0.0}) {
						const SolveStatus status = statusOf(column(masses, true, 2, fall), tolerance, measure, finish);
						// Impulses grow by at most the approach in each sweep of so many masses, so the tightest tolerance may be out of reach.
						// At rest the contact that is left closing has no approach of its own, and a loose tolerance is met before its impulse tells.
						if (tolerance == 1e-4 || (tolerance > 1e-4 && fall > 0)) {
							EXPECT_EQ(status, SolveStatus::unbounded) << tolerance << ' ' << masses << ' ' << fall;
						} else if (tolerance < 1e-4) {
							EXPECT_NE(status, SolveStatus::converged) << tolerance << ' ' << masses << ' ' << fall;
						}
					}
}

TEST(CrushedContacts, OneAmongManyOthers)
{
	scenes::Wall wall;
	wall.rows = 6;
	const BlockProblem heap = scenes::wall(wall);
	const BlockProblem flat = column(1, true, 2);
	BlockProblem crushed = flat;
	crushed.dimension = 2;
	scenes::Wall plane = wall;
	plane.dimension = 2;
	EXPECT_EQ(statusOf(together(scenes::wall(plane), crushed), 1e-4, Measure::naturalMap), SolveStatus::unbounded);
	EXPECT_EQ(statusOf(scenes::wall(plane), 1e-4, Measure::naturalMap), SolveStatus::converged);
	EXPECT_EQ(statusOf(heap, 1e-4, Measure::naturalMap), SolveStatus::converged);
}

// The lid that only follows, and columns whose impulses are hundreds of times what stops one mass: hard, but solvable.
TEST(CrushedContacts, NoFalseAlarm)
{
	for (const double tolerance : {1e-1, 1e-2, 1e-4})
		for (const int masses : {1, 10, 60, 200})
			for (const bool finish : {false, true})
				for (const Measure measure : {Measure::naturalMap, Measure::siconos}) {
					EXPECT_NE(statusOf(column(masses, false, 0), tolerance, measure, finish, 3000), SolveStatus::unbounded)
							<< tolerance << ' ' << masses;
					EXPECT_NE(statusOf(column(masses, true, -1), tolerance, measure, finish, 3000), SolveStatus::unbounded)
							<< tolerance << ' ' << masses;
				}
}

TEST(CrushedContacts, CountsOnlyWhatIsCrushed)
{
	const auto any = [](double qN, double uN, double rN) {
		CrushedContacts contacts(1e-4, 10);
		contacts.add(qN, uN, rN, 2);
		return contacts.any();
	};
	EXPECT_TRUE(any(-1, -0.5, 501));
	EXPECT_FALSE(any(-1, -0.5, 499));  // impulse below a thousand times q
	EXPECT_FALSE(any(-1, -0.09, 501)); // a tenth of the approach is left
	EXPECT_FALSE(any(0, -0.5, 501));
	EXPECT_FALSE(any(1, -0.5, 501));
	EXPECT_FALSE(any(-0.09, -0.05, 501));		// below a hundredth of the largest approach
	for (const double qN : {-0.09, 0.0, 1.0}) { // nothing, or little, closes it without impulses: against the largest approach
		EXPECT_TRUE(any(qN, -1, 5001));
		EXPECT_FALSE(any(qN, -1, 4999));
		EXPECT_FALSE(any(qN, -0.99, 5001));
	}
	CrushedContacts loose(1e-2, 10);
	loose.add(0, -1, 4999, 2);
	EXPECT_FALSE(loose.any());
	CrushedContacts atFloor(1e-4, 1), spread(1e-4, 1), stays(1e-4, 1); // a shock that spreads leaves the sum as it is, but each contact less of it
	atFloor.add(0, -0.5, 501, 2);
	for (int i = 0; i < 2; ++i) spread.add(0, -0.25, 1000, 2);
	stays.add(0, -0.49, 1000, 2);
	EXPECT_FALSE(atFloor.stay(spread));
	EXPECT_TRUE(atFloor.stay(stays));
	CrushedContacts before(1e-4, 1), same(1e-4, 1), less(1e-4, 1);
	before.add(-1, -0.5, 501, 2);
	same.add(-1, -0.49, 1000, 2);
	less.add(-1, -0.3, 1000, 2);
	EXPECT_TRUE(before.stay(same));
	EXPECT_FALSE(before.stay(less));
	EXPECT_FALSE(CrushedContacts(1e-4, 1).stay(same));
}
