// SPDX-License-Identifier: GPL-2.0-or-later
// Contacts that sweeps cannot settle, taken out of the collection and solved on their own.
#include "IndependentResidual.hpp"
#include "Scenes.hpp"
#include "pkg/solver/HotSpotSolver.hpp"
#include "pkg/solver/SignoriniCoulombLoop.hpp"
#include "pkg/solver/SignoriniCoulombSolver.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>
#include <set>

using namespace contactdynamics;

namespace {

/// Each on the floor by itself, which is body 0.
void addBallsAfar(GrainProblem& problem, int balls)
{
	for (int i = 0; i < balls; ++i) {
		problem.bodies.push_back(scenes::ball(1, 1, {0.3, 0, -1}));
		problem.contacts.push_back(scenes::touch(0, 0, int(problem.bodies.size()) - 1, 1, Vector3::UnitZ(), 0.5));
	}
}

/// A ball of mass 1 on the floor, two of mass 100 that come down on it from the sides, mu = 0.5, three contacts. At the solution the sweep has a pair
/// of complex eigenvalues outside the unit circle: it goes round for ever, with momentum as without.
GrainProblem squashed(int ballsAfar = 0)
{
	GrainProblem problem;
	problem.bodies = {scenes::wall(), scenes::ball(1, 1, {0.05, -0.05, -1}), scenes::ball(100, 1, {-0.96, 0.81, -0.62}),
					  scenes::ball(100, 1, {-0.43, -0.76, -0.01})};
	const Vector3 first = Vector3(0.76, 0.19, 0.62).normalized(), second = Vector3(0.23, 0.9, 0.38).normalized();
	problem.contacts = {scenes::touch(0, 0, 1, 1, Vector3::UnitZ(), 0.5), scenes::touch(1, 1, 2, 1, first, 0.5),
						scenes::touch(1, 1, 3, 1, second, 0.5)};
	addBallsAfar(problem, ballsAfar);
	return problem;
}

/// So many such triples far from each other, and balls.
GrainProblem manySquashed(int triples, int ballsAfar = 0)
{
	GrainProblem problem = squashed(ballsAfar);
	for (int copy = 1; copy < triples; ++copy) {
		const GrainProblem one = squashed();
		const auto first = std::int32_t(problem.bodies.size()) - 1;
		problem.bodies.insert(problem.bodies.end(), one.bodies.begin() + 1, one.bodies.end());
		for (Contact c : one.contacts) {
			if (c.body1 > 0) c.body1 += first;
			if (c.body2 > 0) c.body2 += first;
			problem.contacts.push_back(c);
		}
	}
	return problem;
}

SolverOptions fine(Acceleration acceleration)
{
	SolverOptions options;
	options.tolerance = 1e-8;
	options.maxIterations = 20000;
	options.acceleration = acceleration;
	return options;
}

/// An operator after some sweeps.
struct Swept {
	Crew crew{1};
	GrainOperator op;

	Swept(GrainProblem& problem, int sweeps, Extrapolation by = {})
	{
		op.start(problem, true, crew);
		for (int i = 0; i < sweeps; ++i) op.sweep(by);
	}
};

bool hasHotSpot(GrainProblem problem)
{
	HotSpot spot;
	return Swept(problem, 1).op.chooseHotSpot(spot);
}

std::size_t loadedContacts(const GrainProblem& part)
{
	return std::size_t(std::count_if(part.contacts.begin(), part.contacts.end(), [](const Contact& c) { return !c.impulse.isZero(0); }));
}

} // namespace

TEST(HotSpot, SweepsGoRoundForEver)
{
	GrainProblem problem = squashed();
	SignoriniCoulombSolver solver;
	EXPECT_EQ(solver.solve(problem, fine(Acceleration::none)).status, SolveStatus::maxIterations);
	problem = squashed();
	Crew crew(1);
	GrainOperator op;
	op.start(problem, true, crew);
	EXPECT_GT(signoriniCoulombLoop(op, fine(Acceleration::momentum)).residual, 1e-4);
}

TEST(HotSpot, AreSolvedAllTheSame)
{
	for (const int ballsAfar : {0, 500}) {
		GrainProblem problem = squashed(ballsAfar), given = problem;
		SignoriniCoulombSolver solver;
		const SolveReport report = solver.solve(problem, fine(Acceleration::momentum));
		EXPECT_EQ(report.status, SolveStatus::converged);
		EXPECT_GT(report.newtonSteps, 0);
		EXPECT_LE(independent::residual(given, problem), 1e-8);
	}
}

/// Other impulses in the place of those taken: the velocities go with them, without being rebuilt, and later sweeps with momentum keep it so.
TEST(HotSpot, VelocitiesGoWithTheImpulsesPutBack)
{
	for (const bool general : {false, true}) {
		const GrainProblem given = scenes::heap(6, 3, 0.5, true, general);
		GrainProblem problem = given;
		Swept swept(problem, 20, {0.3, 0.2});
		GrainOperator& op = swept.op;
		HotSpot spot;
		ASSERT_TRUE(op.chooseHotSpot(spot));
		GrainProblem part;
		for (std::size_t k = 0; k < spot.parts; ++k) {
			op.takePart(spot, k, part);
			for (Contact& c : part.contacts) c.impulse *= 0.5;
			op.putPart(spot, k, part);
		}
		for (int round = 0; round < 2; ++round) {
			SolveReport report;
			op.finish(report); // velocities as the sweeps and the spot have left them
			const auto velocity = independent::velocities(given, problem);
			double fastest = 0;
			for (const Body& body : problem.bodies) fastest = std::max(fastest, body.velocity.norm() + body.angularVelocity.norm());
			// 22 sweeps over some ten contacts of a body, each adding round-off of the velocities to what it has.
			const double roundOff = 22 * 10 * std::numeric_limits<double>::epsilon() * fastest;
			for (std::size_t i = 0; i < problem.bodies.size(); ++i) {
				EXPECT_LE((velocity[i].head<3>() - problem.bodies[i].velocity).norm(), roundOff) << i;
				EXPECT_LE((velocity[i].tail<3>() - problem.bodies[i].angularVelocity).norm(), 10 * roundOff)
						<< i; // lever arms over radii of gyration
			}
			problem.bodies = given.bodies;
			op.sweep({});
			op.sweep({0.6, 0.4});
		}
	}
}

/// A part taken out stands for itself: its bodies with its impulses have the velocities that they have in the collection.
TEST(HotSpot, PartsAreProblemsOfTheirOwn)
{
	for (const bool general : {false, true}) {
		GrainProblem problem = scenes::heap(6, 3, 0.5, true, general);
		Swept swept(problem, 20);
		GrainOperator& op = swept.op;
		HotSpot spot;
		ASSERT_TRUE(op.chooseHotSpot(spot));
		std::vector<GrainProblem> parts(spot.parts);
		for (std::size_t k = 0; k < spot.parts; ++k) op.takePart(spot, k, parts[k]);
		SolveReport report;
		op.certificate();
		op.finish(report);
		for (const GrainProblem& part : parts) {
			const auto own = independent::velocities(part, part);
			for (std::size_t i = 0; i < part.bodies.size(); ++i) {
				const auto same = std::find_if(problem.bodies.begin(), problem.bodies.end(), [&](const Body& b) {
					return b.centre == part.bodies[i].centre && b.inverseMass == part.bodies[i].inverseMass;
				});
				ASSERT_NE(same, problem.bodies.end());
				// Speeds below ten, in some ten sums on either side: 1e2 eps of that; lever arms over radii of gyration below ten.
				EXPECT_LE((own[i].head<3>() - same->velocity).norm(), 1e3 * std::numeric_limits<double>::epsilon()) << i;
				EXPECT_LE((own[i].tail<3>() - same->angularVelocity).norm(), 1e4 * std::numeric_limits<double>::epsilon()) << i;
			}
		}
	}
}

TEST(HotSpot, PartsShareNoBodyAndHaveNoMoreContactsThanThereIsRoomFor)
{
	GrainProblem problem = scenes::heap(16, 3, 0.5, true);
	Swept swept(problem, 20);
	GrainOperator& op = swept.op;
	HotSpot spot;
	for (const std::size_t room : {HotSpot::mostContacts, HotSpot::fewestContacts}) {
		spot.room = room;
		ASSERT_TRUE(op.chooseHotSpot(spot));
		EXPECT_GT(spot.parts, 1U);
		std::size_t all = 0;
		std::set<double> centres; // of bodies that can move, by one coordinate of each
		GrainProblem part;
		for (std::size_t k = 0; k < spot.parts; ++k) {
			op.takePart(spot, k, part);
			all += loadedContacts(part);
			EXPECT_LE(loadedContacts(part), room);
			for (const Body& body : part.bodies) EXPECT_TRUE(!body.moves() || centres.insert(body.centre[0]).second) << k;
		}
		EXPECT_LE(all, room * (op.awakeContacts() / HotSpot::contactsPerSpot));
	}
}

/// Of changes that are spread evenly too little would lie in a spot.
TEST(HotSpot, IsNotThereWhereChangesAreSpread)
{
	const auto spread = [](int balls) {
		GrainProblem problem;
		problem.bodies = {scenes::wall()};
		addBallsAfar(problem, balls);
		return problem;
	};
	const int most = int(double(HotSpot::mostContacts) / HotSpot::leastShare); // all alike: the room over their number is the share
	EXPECT_TRUE(hasHotSpot(spread(most - 1)));
	EXPECT_FALSE(hasHotSpot(spread(most + 1)));
}

/// A lid on many balls has more contacts than there is room for: those that change most are solved all the same, the lid in the part but not with all
/// its contacts. So many that anything quadratic in them would take minutes.
TEST(HotSpot, BodiesWithTooManyContactsHoldNothingUp)
{
	constexpr int heavy = 100, balls = 20000;
	GrainProblem problem;
	problem.bodies = {scenes::wall(), scenes::ball(10, 1, {0, 0, -1})};
	for (int i = 0; i < balls; ++i) {
		problem.bodies.push_back(scenes::ball(i < heavy ? 1e6 : 1, 1, {0.1, 0, -1})); // the heavy ones have nearly all of the changes
		problem.contacts.push_back(scenes::touch(0, 0, i + 2, 1, Vector3::UnitZ(), 0.5));
		problem.contacts.push_back(scenes::touch(i + 2, 1, 1, 0, Vector3::UnitZ(), 0.5));
	}
	Swept swept(problem, 1);
	GrainOperator& op = swept.op;
	HotSpot spot;
	ASSERT_TRUE(op.chooseHotSpot(spot));
	ASSERT_EQ(spot.parts, 1U); // they share the lid
	GrainProblem part;
	op.takePart(spot, 0, part);
	EXPECT_LE(loadedContacts(part), HotSpot::mostContacts);
	EXPECT_GT(loadedContacts(part), HotSpot::mostContacts - 2);	 // two of one more ball would not fit
	EXPECT_EQ(part.bodies.size(), 2 + part.contacts.size() / 2); // of each ball both contacts
}

TEST(HotSpot, LeavesAloneMeanFieldsAndRollingFriction)
{
	GrainProblem problem = squashed();
	EXPECT_TRUE(hasHotSpot(problem));
	scenes::addRollingFriction(problem, 0.05);
	EXPECT_FALSE(hasHotSpot(problem));
	problem = squashed();
	problem.meanField.emplace();
	EXPECT_FALSE(hasHotSpot(problem));
}

/// Several such triples far from each other are parts of one spot.
TEST(HotSpot, PartsAreSolvedOneByOne)
{
	GrainProblem problem = manySquashed(5);
	const GrainProblem given = problem;
	const SolveReport report = SignoriniCoulombSolver().solve(problem, fine(Acceleration::momentum));
	EXPECT_EQ(report.status, SolveStatus::converged);
	EXPECT_GE(report.newtonSteps, 5);
	EXPECT_LE(independent::residual(given, problem), 1e-8);
}

TEST(HotSpot, CostNoMoreThanTheSweepsThatAreLeft)
{
	for (const int left : {0, 1, 7, 100}) {
		GrainProblem problem = manySquashed(5);
		Swept swept(problem, 150);
		HotSpotSolver spots;
		spots.start();
		const HotSpotSolver::Outcome outcome = spots.settle(swept.op, {1e-300, left, 150}, swept.crew); // never met: round-off
		EXPECT_LE(outcome.sweeps, left);
		EXPECT_GT(outcome.sweeps, 0.9 * left - 1); // and does what it may; shares of a sweep are rounded down
	}
}

/// A ball between the floor and a lid that is driven down has no solution. Its residual relative to the impulses becomes small all the same, but what
/// leaves the contacts closing is not taken.
TEST(HotSpot, ImpulsesThatLeaveContactsClosingAreNotTaken)
{
	for (const bool squeezed : {true, false}) {
		GrainProblem problem;
		problem.bodies = {scenes::wall(), scenes::wall(), scenes::ball(1, 1, {0.1, 0, -1})};
		problem.bodies[1].velocity = {0, 0, squeezed ? -0.5 : 0.5};
		problem.contacts = {scenes::touch(0, 0, 2, 1, Vector3::UnitZ(), 0.5), scenes::touch(2, 1, 1, 0, Vector3::UnitZ(), 0.5)};
		Swept swept(problem, 1);
		HotSpotSolver spots;
		spots.start();
		EXPECT_EQ(spots.settle(swept.op, {0.1, 1000, 1}, swept.crew).settled, !squeezed);
	}
}

TEST(HotSpot, SameBitsForAnyNumberOfThreadsAndAfterOtherProblems)
{
	const GrainProblem given = manySquashed(40, 4000); // several parts, and enough for two threads
	std::vector<Vector3> impulses;
	SignoriniCoulombSolver used;
	for (const int threads : {1, 2, 8}) {
		for (const bool afresh : {true, false}) {
			SignoriniCoulombSolver fresh;
			SolverOptions options = fine(Acceleration::momentum);
			options.threads = threads;
			GrainProblem problem = given, other = scenes::heap(6, 3, 1, true);
			if (!afresh) { // parts that are never solved leave little room, and Newton steps have spent what they may
				options.tolerance = 1e-300;
				options.maxIterations = 1000;
				used.solve(other, options);
				options = fine(Acceleration::momentum);
				options.threads = threads;
			}
			const SolveReport report = (afresh ? fresh : used).solve(problem, options);
			EXPECT_GT(report.newtonSteps, 0);
			std::vector<Vector3> found;
			for (const Contact& c : problem.contacts) found.push_back(c.impulse);
			if (impulses.empty()) impulses = found;
			EXPECT_TRUE(impulses == found) << threads << " threads" << (afresh ? "" : ", solver used before");
		}
	}
}
