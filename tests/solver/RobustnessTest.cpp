// SPDX-License-Identifier: GPL-2.0-or-later
// Whatever is thrown at it: a truthful status, never NaN, the same bits for any number of threads and whatever was solved before.
#include "IndependentResidual.hpp"
#include "Scenes.hpp"
#include "pkg/solver/SignoriniCoulombSolver.hpp"

#include <gtest/gtest.h>
#include <limits>

using namespace contactdynamics;

namespace {

bool sameBits(const GrainProblem& a, const GrainProblem& b)
{
	for (std::size_t i = 0; i < a.bodies.size(); ++i)
		if (a.bodies[i].velocity != b.bodies[i].velocity || a.bodies[i].angularVelocity != b.bodies[i].angularVelocity) return false;
	for (std::size_t i = 0; i < a.contacts.size(); ++i)
		if (a.contacts[i].impulse != b.contacts[i].impulse || a.contacts[i].relativeVelocity != b.contacts[i].relativeVelocity ||
			a.contacts[i].status != b.contacts[i].status)
			return false;
	return true;
}

/// Small problems that are degenerate on purpose: parallel and repeated contacts, blocked bodies, zero friction, huge ratios, wild starts.
/// A solution is known to exist when standing still violates nothing (walls at rest, no gap closed already); else walls may crush what is between.
GrainProblem degenerate(std::mt19937_64& random, bool solvable)
{
	std::uniform_real_distribution<double> uniform(0, 1);
	std::normal_distribution<double> normal;
	const auto vector = [&] { return Vector3(normal(random), normal(random), normal(random)); };
	GrainProblem problem;
	const int bodies = 2 + int(10 * uniform(random));
	for (int i = 0; i < bodies; ++i) {
		Body body = scenes::ball(std::pow(10, 6 * uniform(random) - 3), 0.1 + uniform(random), vector(),
								 uniform(random) < 0.5 ? Vector3(vector()) : Vector3(Vector3::Zero()));
		if (uniform(random) < 0.2) body = scenes::wall();
		if (uniform(random) < 0.2) body.inverseMass[int(3 * uniform(random))] = 0;
		if (uniform(random) < 0.2) body.inverseInertia.setZero();
		const bool blocked = (body.inverseMass.array() == 0).any() || body.inverseInertia.isZero(0);
		if (uniform(random) < 0.2 || (solvable && blocked)) {
			body.velocity.setZero();
			body.angularVelocity.setZero();
		}
		problem.bodies.push_back(body);
	}
	const int contacts = 1 + int(500 * std::pow(uniform(random), 12)); // most are small, one in eighteen has more than 250
	for (int k = 0; k < contacts; ++k) {
		if (k && uniform(random) < 0.2) {
			problem.contacts.push_back(problem.contacts[std::size_t(k * uniform(random))]);
			continue;
		}
		const int i = int(bodies * uniform(random)), j = (i + 1 + int((bodies - 1) * uniform(random))) % bodies;
		const Vector3 n = uniform(random) < 0.3 ? Vector3(Vector3::Unit(int(3 * uniform(random)))) : Vector3(vector().normalized());
		Contact c = scenes::touch(i, uniform(random), j, uniform(random), n, uniform(random) < 0.2 ? 0 : 2 * uniform(random));
		const auto isotropic = [](const Body& b) {
			return b.inverseMass.isConstant(b.inverseMass[0]) && b.inverseInertia.isApprox(b.inverseInertia(0, 0) * Matrix3::Identity());
		};
		c.ball = isotropic(problem.bodies[i]) && isotropic(problem.bodies[j]) && uniform(random) < 0.7;
		if (!c.ball && uniform(random) < 0.7) c.arm1 = vector(), c.arm2 = vector();
		if (uniform(random) < 0.3) c.gapVelocity = 2 * uniform(random) - (solvable ? 0 : 0.5);
		if (!solvable && uniform(random) < 0.1) c.imageVelocity = vector();
		if (uniform(random) < 0.3) c.impulse = vector() * std::pow(10, 6 * uniform(random) - 3);
		problem.contacts.push_back(c);
	}
	return problem;
}

} // namespace

/// Ten thousand problems in shards of a thousand, which run side by side: under a sanitizer each takes minutes.
class GrainRobustness : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(TenThousand, GrainRobustness, testing::Range(0, 10));

TEST_P(GrainRobustness, DegenerateProblemsEndWithATruthfulStatus)
{
	SignoriniCoulombSolver solver;
	std::mt19937_64 random(5 + unsigned(GetParam()));
	SolverOptions options;
	options.tolerance = 1e-6;
	options.maxIterations = 500;
	int converged = 0;
	for (int k = 0; k < 1000; ++k) {
		const bool solvable = k % 2;
		GrainProblem problem = degenerate(random, solvable);
		const GrainProblem free = problem;
		const SolveReport report = solver.solve(problem, options);
		ASSERT_NE(report.status, SolveStatus::notFinite) << k;
		// Impulses without bound meet any tolerance and are no solution; where there is one, nobody may claim that there is none.
		if (report.status == SolveStatus::unbounded)
			ASSERT_FALSE(solvable) << k;
		else
			ASSERT_EQ(report.status == SolveStatus::converged, report.residual <= options.tolerance) << k;
		const double independent = independent::residual(free, problem);
		ASSERT_TRUE(std::isfinite(independent)) << k;
		// The independent residual knows no round-off threshold: where all there is left is round-off, the approach itself must be.
		if (report.residual > 0) {
			ASSERT_NEAR(report.residual, independent, 1e-9 + 1e-6 * independent) << k;
		} else {
			for (const Contact& c : problem.contacts)
				if (c.normal.dot(independent::delassus(free, c) * c.normal) > 0) {
					ASSERT_GE(c.relativeVelocity.dot(c.normal) + c.gapVelocity, -1e-13) << k;
				}
		}
		for (const Contact& c : problem.contacts) {
			const double rn = c.impulse.dot(c.normal);
			ASSERT_LE((c.impulse - rn * c.normal).norm(), c.friction * rn + 1e-12 * c.impulse.norm()) << k;
		}
		converged += solvable && report.status == SolveStatus::converged;
	}
	EXPECT_GT(converged, 350); // of 500; most others have mass ratios of a million between repeated contacts
}

TEST(Robustness, HardFrictionEndsTruthfully)
{
	// Dense random heaps with mu = 1: every sweep-based method that was tried stalls on some of them. No bound on the residual follows from anything
	// then. That a thousand sweeps with momentum end better than a hundred plain ones is what users are promised, not a theorem.
	SignoriniCoulombSolver solver;
	SolverOptions options, tenth;
	options.tolerance = tenth.tolerance = 1e-8;
	tenth.maxIterations = options.maxIterations / 10;
	tenth.acceleration = Acceleration::none;
	for (unsigned seed = 0; seed < 10; ++seed) {
		GrainProblem problem = scenes::heap(5, seed, 1);
		const GrainProblem free = problem;
		const SolveReport report = solver.solve(problem, options);
		EXPECT_EQ(report.status == SolveStatus::converged, report.residual <= 1e-8);
		EXPECT_NEAR(report.residual, independent::residual(free, problem), 1e-6 * report.residual);
		GrainProblem plain = free;
		EXPECT_LE(report.residual, solver.solve(plain, tenth).residual) << seed;
	}
}

TEST(Robustness, AccelerationIsNeverTwiceAsSlowNorWorseThanGaussSeidel)
{
	// Cold heaps, among them such where momentum stalls (mu = 1, seed 7) and such where nothing converges. It takes some
	// 300 sweeps to see that momentum has stalled; for problems that plain sweeps solve in fewer, that is the price.
	for (const double friction : {0.3, 0.6, 1.0})
		for (unsigned seed = 1; seed < 8; ++seed) {
			const GrainProblem given = scenes::heap(5, seed, friction, seed % 3 == 0, seed % 4 == 0);
			SolverOptions plain, standard;
			plain.acceleration = Acceleration::none;
			plain.maxIterations = 2500;
			standard.maxIterations = 2 * plain.maxIterations;
			GrainProblem one = given, two = given;
			const SolveReport slow = SignoriniCoulombSolver().solve(one, plain), fast = SignoriniCoulombSolver().solve(two, standard);
			EXPECT_LE(fast.iterations, std::max(2 * slow.iterations, 350 + slow.iterations)) << friction << ' ' << seed;
			if (slow.status == SolveStatus::converged) { EXPECT_EQ(fast.status, SolveStatus::converged) << friction << ' ' << seed; }
		}
}

TEST(Robustness, AnImpulseThatDrownsTheVelocitiesIsNoSolution)
{
	// A ball slides between two walls that press it with 1e200 N s. The velocities drown in it, and the sums of the certificate overflow.
	GrainProblem problem;
	problem.bodies = {scenes::wall(), scenes::ball(1, 1, {-0.001, 0, 1})};
	problem.contacts = {scenes::touch(0, 0, 1, 1, Vector3::UnitX(), 0.5), scenes::touch(0, 0, 1, 1, -Vector3::UnitX(), 0.5)};
	for (Contact& c : problem.contacts) c.impulse = 1e200 * c.normal;
	SolverOptions options;
	options.maxIterations = 0;
	EXPECT_EQ(SignoriniCoulombSolver().solve(problem, options).status, SolveStatus::notFinite);
}

namespace {

/// A ball at rest between two walls, beside what is in the problem already: where they come closer no impulse stops both.
/// @param turns  the first wall reaches the grain at the end of an arm about which it turns, as fast
GrainProblem withSqueezedGrain(GrainProblem problem, double oneWall, double otherWall, bool turns = false)
{
	const int wall = int(problem.bodies.size());
	problem.bodies.push_back(scenes::wall());
	problem.bodies.push_back(scenes::ball(1, 1));
	problem.bodies.push_back(scenes::wall());
	problem.bodies[wall].velocity = {oneWall, 0, 0};
	problem.bodies[wall + 2].velocity = {otherWall, 0, 0};
	problem.contacts.push_back(scenes::touch(wall, 0, wall + 1, 1, Vector3::UnitX(), 0.3));
	problem.contacts.push_back(scenes::touch(wall + 1, 1, wall + 2, 0, Vector3::UnitX(), 0.3));
	if (turns) {
		Contact& atItsEnd = problem.contacts[problem.contacts.size() - 2];
		atItsEnd.arm1 = Vector3::UnitY();
		atItsEnd.ball = false;
		std::swap(problem.bodies[wall].velocity[0], problem.bodies[wall].angularVelocity[2]);
		problem.bodies[wall].angularVelocity *= -1;
	}
	return problem;
}

} // namespace

TEST(Robustness, ASqueezedGrainHasNoSolutionAndIsNotCalledConverged)
{
	SolverOptions options;
	options.maxIterations = 50000;
	for (const Acceleration acceleration : {Acceleration::none, Acceleration::momentum})
		for (const auto& [oneWall, otherWall] : {std::pair{1.0, -1.0}, {1.0, 0.0}, {0.0, -1.0}})
			for (const auto& [amongOthers, turns] : {std::pair{false, false}, {true, false}, {false, true}}) {
				options.acceleration = acceleration;
				GrainProblem problem = withSqueezedGrain(amongOthers ? scenes::heap(4, 3) : GrainProblem(), oneWall, otherWall, turns);
				const GrainProblem free = problem;
				const SolveReport report = SignoriniCoulombSolver().solve(problem, options);
				ASSERT_NE(report.status, SolveStatus::maxIterations) << oneWall << otherWall << amongOthers; // or the case says nothing
				EXPECT_EQ(report.status, SolveStatus::unbounded) << oneWall << otherWall << amongOthers << turns;
				EXPECT_NEAR(report.residual, independent::residual(free, problem), 1e-6 * report.residual);
				EXPECT_GE(report.maxApproachSpeed, 0.49 * (oneWall - otherWall));
				// Carried over to the next step, where the impulses of now meet the tolerance at once.
				GrainProblem next = free;
				for (std::size_t i = 0; i < next.contacts.size(); ++i) next.contacts[i].impulse = problem.contacts[i].impulse;
				EXPECT_EQ(SignoriniCoulombSolver().solve(next, options).status, SolveStatus::unbounded);
			}
	// A wall that only follows, and columns in which the lowest contact carries hundreds of times what one ball needs, have solutions.
	GrainProblem followed = withSqueezedGrain({}, 1, 1);
	EXPECT_EQ(SignoriniCoulombSolver().solve(followed, options).status, SolveStatus::converged);
	for (const double tolerance : {1e-1, 1e-3, 1e-5})
		for (const int balls : {1, 50, 400}) {
			GrainProblem column = scenes::column(balls, 1);
			options.tolerance = tolerance;
			EXPECT_NE(SignoriniCoulombSolver().solve(column, options).status, SolveStatus::unbounded) << tolerance << ' ' << balls;
		}
}

TEST(Reproducible, SameBitsForAnyNumberOfThreads)
{
	// More than three thousand awake contacts, so that the crew really is at work; balls and general contacts.
	for (const bool general : {false, true}) {
		const GrainProblem given = scenes::heap(general ? 12 : 14, 11, 0.3, true, general);
		SolverOptions options;
		options.maxIterations = 60;
		GrainProblem one = given;
		const SolveReport first = SignoriniCoulombSolver().solve(one, options);
		for (const int threads : {2, 3, 8}) {
			GrainProblem more = given;
			options.threads = threads;
			const SolveReport report = SignoriniCoulombSolver().solve(more, options);
			EXPECT_EQ(report.iterations, first.iterations);
			EXPECT_EQ(report.residual, first.residual);
			EXPECT_TRUE(sameBits(one, more)) << threads << " threads";
		}
	}
}

TEST(Reproducible, NoMemoryOfEarlierProblems)
{
	// Smaller and larger ones, so that packs that are not full lie where full ones have been, with torques where there are none.
	SignoriniCoulombSolver used;
	for (const bool general : {false, true})
		for (const bool rolling : {false, true}) {
			for (const int side : {3, 8, 7}) {
				GrainProblem other = scenes::heap(side, unsigned(side), 0.5, true, side % 2);
				scenes::addRollingFriction(other, 0.1);
				used.solve(other, {});
			}
			GrainProblem a = scenes::heap(6, 2, 0.3, false, general);
			if (rolling) {
				scenes::addRollingFriction(a, 0.05);
				for (std::size_t k = 0; 2 * k < a.rolling.size(); ++k) a.rolling[k] = a.rolling[2 * k];
				a.rolling.resize((a.rolling.size() + 1) / 2);
			}
			GrainProblem b = a;
			used.solve(a, {});
			SignoriniCoulombSolver().solve(b, {});
			EXPECT_TRUE(sameBits(a, b)) << general << rolling;
			for (std::size_t k = 0; k < a.rolling.size(); ++k) EXPECT_EQ(a.rolling[k].torque, b.rolling[k].torque) << k;
		}
}

TEST(Reproducible, BodyWithMoreContactsThanColours)
{
	// A big body in a cage of two hundred small ones: the overflow colour. Momentum of the whole is kept.
	for (const bool general : {false, true}) {
		std::mt19937_64 random(1);
		std::normal_distribution<double> normal;
		GrainProblem problem;
		problem.bodies.push_back(scenes::ball(10, 1, {0.3, -0.2, 0.1}));
		if (general) problem.bodies[0].inverseInertia.diagonal() << 0.2, 0.25, 0.4;
		for (int i = 1; i <= 200; ++i) {
			const Vector3 n = Vector3(normal(random), normal(random), normal(random)).normalized();
			problem.bodies.push_back(scenes::ball(0.1, 0.1, -n));
			problem.contacts.push_back(scenes::touch(0, 1, i, 0.1, n, 0.4));
			problem.contacts.back().ball = !general;
		}
		const GrainProblem free = problem;
		SolverOptions options;
		options.tolerance = 1e-10;
		const SolveReport report = SignoriniCoulombSolver().solve(problem, options);
		ASSERT_EQ(report.status, SolveStatus::converged);
		EXPECT_LE(independent::residual(free, problem), 1.01e-10);
		Vector3 before = Vector3::Zero(), after = before;
		for (std::size_t i = 0; i < problem.bodies.size(); ++i) {
			before += free.bodies[i].velocity / free.bodies[i].inverseMass[0];
			after += problem.bodies[i].velocity / problem.bodies[i].inverseMass[0];
		}
		EXPECT_LE((after - before).norm(), 1e-13 * 30); // total of the speeds times masses is 30
	}
}

TEST(BadInput, NotFiniteLeavesTheProblemAsGiven)
{
	const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
	for (const double bad : {nan, infinity, -infinity}) {
		for (int where = 0; where < 8; ++where) {
			GrainProblem problem = scenes::column(3, 0.1);
			switch (where) {
			case 0:
				problem.bodies[1].velocity[1] = bad;
				break;
			case 1:
				problem.bodies[1].angularVelocity[2] = bad;
				break;
			case 2:
				problem.bodies[1].inverseMass[0] = bad;
				break;
			case 3:
				problem.bodies[1].inverseInertia(1, 1) = bad;
				break;
			case 4:
				problem.contacts[1].gapVelocity = bad;
				break;
			case 5:
				problem.contacts[1].impulse[0] = bad;
				break;
			case 6:
				problem.contacts[1].arm1[0] = bad;
				break;
			case 7:
				problem.bodies[1].centre[2] = bad;
				break;
			}
			GrainProblem given = problem;
			EXPECT_EQ(SignoriniCoulombSolver().solve(problem, {}).status, SolveStatus::notFinite) << where;
			EXPECT_EQ(problem.bodies[2].velocity, given.bodies[2].velocity);
			EXPECT_EQ(problem.contacts[0].impulse, given.contacts[0].impulse);
		}
	}
}

TEST(BadInput, IsRefusedByName)
{
	const auto message = [](auto&& spoil, SolverOptions options = {}) -> std::string {
		GrainProblem problem = scenes::column(3, 0.1);
		spoil(problem);
		try {
			SignoriniCoulombSolver().solve(problem, options);
		} catch (const std::invalid_argument& error) {
			return error.what();
		}
		return "nothing thrown";
	};
	const auto keep = [](GrainProblem&) {};
	EXPECT_NE(message([](GrainProblem& p) { p.contacts[1].friction = -0.5; }).find("contact 1 between bodies 1 and 2: friction is -0.5"),
			  std::string::npos);
	EXPECT_NE(message([](GrainProblem& p) { p.contacts[1].body2 = 4; }).find("contact 1 between bodies 1 and 4"), std::string::npos);
	EXPECT_NE(message([](GrainProblem& p) { p.contacts[2].body1 = -1; }).find("contact 2"), std::string::npos);
	EXPECT_NE(message([](GrainProblem& p) { p.contacts[0].body2 = 0; }).find("cannot touch itself"), std::string::npos);
	EXPECT_NE(message([](GrainProblem& p) { p.contacts[0].normal *= 2; }).find("length 2"), std::string::npos);
	SolverOptions options;
	options.tolerance = 0;
	EXPECT_NE(message(keep, options).find("tolerance"), std::string::npos);
	options = {};
	options.maxIterations = -1;
	EXPECT_NE(message(keep, options).find("maxIterations"), std::string::npos);
	options = {};
	options.threads = 0;
	EXPECT_NE(message(keep, options).find("threads"), std::string::npos);
}

TEST(Empty, NothingToSolve)
{
	GrainProblem problem;
	SolveReport report = SignoriniCoulombSolver().solve(problem, {});
	EXPECT_EQ(report.status, SolveStatus::converged);
	EXPECT_EQ(report.residual, 0);
	problem.bodies.push_back(scenes::ball(1, 1, {1, 2, 3}));
	report = SignoriniCoulombSolver().solve(problem, {});
	EXPECT_EQ(report.status, SolveStatus::converged);
	EXPECT_EQ(report.iterations, 0);
	EXPECT_EQ(problem.bodies[0].velocity, Vector3(1, 2, 3));
}
