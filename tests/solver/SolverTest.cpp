// SPDX-License-Identifier: GPL-2.0-or-later
// The collection: closed forms, laws of mechanics, and the certificate against a second implementation.
#include "IndependentResidual.hpp"
#include "Scenes.hpp"
#include "pkg/solver/SignoriniCoulombSolver.hpp"

#include <gtest/gtest.h>

using namespace contactdynamics;

namespace {

SolverOptions tight(double tolerance, int maxIterations = 100000, Acceleration acceleration = Acceleration::momentum)
{
	SolverOptions options;
	options.tolerance = tolerance;
	options.maxIterations = maxIterations;
	options.acceleration = acceleration;
	return options;
}

void expectInsideCones(const GrainProblem& problem)
{
	for (const Contact& c : problem.contacts) {
		const double rn = c.impulse.dot(c.normal);
		EXPECT_GE(rn, 0);
		EXPECT_LE((c.impulse - rn * c.normal).norm(), c.friction * rn + 1e-12 * c.impulse.norm());
		if (c.status == ContactStatus::none) { EXPECT_TRUE(c.impulse.isZero(0)); }
	}
}

struct HeapKind {
	double friction;
	bool heavy, general;
};

std::ostream& operator<<(std::ostream& out, const HeapKind& k)
{
	return out << "friction " << k.friction << (k.heavy ? " heavy" : "") << (k.general ? " general" : "");
}

class Heap : public testing::TestWithParam<HeapKind> {
protected:
	GrainProblem problem = scenes::heap(6, 7, GetParam().friction, GetParam().heavy, GetParam().general);
	GrainProblem free = problem;
	SignoriniCoulombSolver solver;
};

} // namespace

TEST(Column, EachContactCarriesTheWeightAboveIt)
{
	SignoriniCoulombSolver solver;
	for (const int n : {1, 2, 10, 100}) {
		GrainProblem problem = scenes::column(n, 9.81e-3);
		const SolveReport report = solver.solve(problem, tight(1e-12));
		ASSERT_EQ(report.status, SolveStatus::converged) << n;
		EXPECT_EQ(report.activeContacts, n);
		// Condition number of the column: (2 n / pi)^2, about 4e3 for 100 balls, on top of the tolerance.
		for (int k = 0; k < n; ++k) {
			EXPECT_NEAR(problem.contacts[k].impulse[2] / ((n - k) * 9.81e-3), 1, 1e-8) << n << " balls, contact " << k;
			EXPECT_EQ(problem.contacts[k].status, ContactStatus::sticking);
		}
	}
}

TEST(Column, AccelerationNeedsFarFewerSweepsThanGaussSeidel)
{
	SignoriniCoulombSolver solver;
	GrainProblem plain = scenes::column(30, 9.81e-3), accelerated = plain;
	const SolveReport slow = solver.solve(plain, tight(1e-10, 100000, Acceleration::none)), fast = solver.solve(accelerated, tight(1e-10));
	ASSERT_EQ(slow.status, SolveStatus::converged);
	ASSERT_EQ(fast.status, SolveStatus::converged);
	EXPECT_LT(10 * fast.iterations, slow.iterations);
}

TEST(TwoBalls, ObliqueImpactWithFriction)
{
	// Equal balls, centres on x, approach v_n = 2, tangential speed t: e = 0 gives J_n = m v_n / 2; the friction stops the slip,
	// J_t = m t / 7 (W_tt = 3.5 W_nn = 7 / m), unless that is above mu J_n.
	SignoriniCoulombSolver solver;
	for (const double t : {0.5, 10.0}) {
		GrainProblem problem;
		problem.bodies = {scenes::ball(1, 1, {1, 0, 0}), scenes::ball(1, 1, {-1, t, 0})};
		problem.contacts = {scenes::touch(0, 1, 1, 1, Vector3::UnitX(), 0.3)};
		const SolveReport report = solver.solve(problem, tight(1e-12));
		ASSERT_EQ(report.status, SolveStatus::converged);
		const double friction = std::min(t / 7, 0.3);
		EXPECT_NEAR(problem.contacts[0].impulse[0], 1, 1e-14);
		EXPECT_NEAR(problem.contacts[0].impulse[1], -friction, 1e-14);
		EXPECT_NEAR(problem.bodies[0].velocity[0], 0, 1e-14);
		EXPECT_NEAR(problem.bodies[1].velocity[1], t - friction, 1e-14);
		EXPECT_EQ(problem.contacts[0].status, t < 1 ? ContactStatus::sticking : ContactStatus::sliding);
		EXPECT_NEAR(problem.contacts[0].relativeVelocity[1], std::max(0.0, t - 7 * 0.3), 1e-13);
	}
}

TEST(TwoBalls, GapOpenContactAndPeriodicImage)
{
	SignoriniCoulombSolver solver;
	GrainProblem problem;
	problem.bodies = {scenes::ball(1, 1, {1, 0, 0}), scenes::ball(1, 1)};
	problem.contacts = {scenes::touch(0, 1, 1, 1, Vector3::UnitX(), 0, 0.25)};
	GrainProblem open = problem, image = problem;
	ASSERT_EQ(solver.solve(problem, tight(1e-12)).status, SolveStatus::converged);
	EXPECT_NEAR(problem.contacts[0].relativeVelocity[0], -0.25, 1e-15); // closes the gap exactly
	open.contacts[0].gapVelocity = 2;
	const SolveReport report = solver.solve(open, tight(1e-12));
	EXPECT_EQ(report.status, SolveStatus::converged);
	EXPECT_EQ(report.residual, 0);
	EXPECT_EQ(report.activeContacts, 0);
	image.contacts[0].imageVelocity = {-1, 0.5, 0};
	image.contacts[0].gapVelocity = 0;
	ASSERT_EQ(solver.solve(image, tight(1e-12)).status, SolveStatus::converged);
	EXPECT_NEAR(image.contacts[0].impulse[0], 1, 1e-14); // approach 2, reduced mass 1/2
	EXPECT_NEAR(image.contacts[0].relativeVelocity[0], 0, 1e-14);
}

TEST(Blocked, BodyWithoutRotationStopsAgainstFriction)
{
	// A block (no rotation) on a floor, all motion but x and z blocked: sliding impulse mu m g h, or less if that is enough to stop.
	SignoriniCoulombSolver solver;
	for (const double speed : {0.01, 1.0}) {
		GrainProblem problem;
		problem.bodies = {scenes::wall(), scenes::ball(2, 1, {speed, 0, -0.1})};
		problem.bodies[1].inverseInertia.setZero();
		problem.bodies[1].inverseMass[1] = 0;
		problem.contacts = {scenes::touch(0, 0, 1, 1, Vector3::UnitZ(), 0.5)};
		problem.contacts[0].ball = false;
		ASSERT_EQ(solver.solve(problem, tight(1e-12)).status, SolveStatus::converged);
		EXPECT_NEAR(problem.bodies[1].velocity[0], std::max(0.0, speed - 0.5 * 0.1), 1e-14);
		EXPECT_NEAR(problem.contacts[0].impulse[2], 0.2, 1e-14);
	}
}

TEST(Blocked, ContactBetweenBodiesThatCannotMoveIsLeftAlone)
{
	SignoriniCoulombSolver solver;
	GrainProblem problem;
	problem.bodies = {scenes::wall(), scenes::wall()};
	problem.bodies[1].velocity = {0, 0, -1};
	for (const bool ball : {true, false}) {
		problem.contacts = {scenes::touch(0, 0, 1, 1, Vector3::UnitZ(), 0.5)};
		problem.contacts[0].ball = ball;
		problem.contacts[0].impulse = {0, 0, 1};
		const SolveReport report = solver.solve(problem, tight(1e-12));
		EXPECT_EQ(report.status, SolveStatus::converged);
		EXPECT_EQ(report.maxApproachSpeed, 1);
		EXPECT_TRUE(problem.contacts[0].impulse.isZero(0));
	}
}

TEST(Flight, GrainsThatTouchAtTheSameSpeedAreNotIteratedForEver)
{
	// The free velocities agree to round-off only: an impulse of that size has no meaning.
	SignoriniCoulombSolver solver;
	GrainProblem problem;
	problem.bodies = {scenes::ball(1, 1, {0.1, 0.2, -12.3}), scenes::ball(3, 1, {0.1 * (1 + 4e-16), 0.2, -12.3 * (1 + 2e-16)})};
	problem.contacts = {scenes::touch(0, 1, 1, 1, Vector3(1, 2, -2) / 3, 0.3)};
	const SolveReport report = solver.solve(problem, tight(1e-10));
	EXPECT_EQ(report.status, SolveStatus::converged);
	EXPECT_LE(report.iterations, 2);
}

/// The same with an impulse above the round-off, but such a small one that the increments of the sweeps are round-off of the velocities and never
/// fall: a bit of 0.09 m/s is a thousandth of the speed of approach.
TEST(Flight, GrainsThatMeetBarelyAboveRoundOffAreSoonDone)
{
	std::mt19937_64 random(1);
	std::uniform_real_distribution<double> uniform(-1, 1);
	SignoriniCoulombSolver solver;
	int sweeps = 0;
	for (int k = 0; k < 1000; ++k) {
		SCOPED_TRACE(k);
		const Vector3 together(-0.0866, -0.0253, -0.0186), normal = Vector3(uniform(random), uniform(random), uniform(random)).normalized();
		GrainProblem problem;
		for (int i = 0; i < 2; ++i) problem.bodies.push_back(scenes::ball(7e-4 * (1 + 0.3 * uniform(random)), 5e-3, together));
		problem.contacts.push_back(scenes::touch(0, 5e-3, 1, 5e-3, normal, 0.5, -1.4e-14));
		const SolveReport report = solver.solve(problem, {});
		EXPECT_EQ(report.status, SolveStatus::converged);
		EXPECT_GT(problem.contacts[0].impulse.dot(normal), 0);
		sweeps += report.iterations;
	}
	EXPECT_LE(sweeps, 1000 * 33); // by chance the noise is less where it is looked at, at 32
}

TEST_P(Heap, CertificateAgreesWithTheIndependentOne)
{
	for (const int sweeps : {0, 1, 5, 50}) {
		problem = free;
		const SolveReport report = solver.solve(problem, tight(1e-14, sweeps));
		EXPECT_EQ(report.iterations, sweeps);
		EXPECT_NEAR(report.residual, independent::residual(free, problem), 1e-9 * report.residual) << sweeps << " sweeps";
		expectInsideCones(problem);
	}
}

TEST_P(Heap, EndsCertifiedWithMomentumAndEnergy)
{
	const double before = scenes::kineticEnergy(free);
	const SolveReport report = solver.solve(problem, tight(1e-6, 20000));
	ASSERT_EQ(report.status, SolveStatus::converged) << report.residual;
	EXPECT_LE(independent::residual(free, problem), 1.001e-6);
	EXPECT_GT(report.activeContacts, 100);
	expectInsideCones(problem);
	// Exact solutions never gain energy (gap velocities >= 0, fixed walls); an error of 1e-6 in the impulses gains at most that part.
	EXPECT_LE(scenes::kineticEnergy(problem), before * (1 + 1e-6));

	std::vector<Vector3> momentum(problem.bodies.size(), Vector3::Zero()), moment = momentum;
	for (const Contact& c : problem.contacts) {
		momentum[c.body1] -= c.impulse;
		momentum[c.body2] += c.impulse;
		moment[c.body1] -= c.arm1.cross(c.impulse);
		moment[c.body2] += c.arm2.cross(c.impulse);
	}
	// Round-off of a sum of some ten terms of the size of the velocities.
	for (std::size_t i = 0; i < problem.bodies.size(); ++i) {
		const Vector3 dv = problem.bodies[i].velocity - free.bodies[i].velocity, expected = free.bodies[i].inverseMass.cwiseProduct(momentum[i]);
		const Vector3 dw = problem.bodies[i].angularVelocity - free.bodies[i].angularVelocity, turn = free.bodies[i].inverseInertia * moment[i];
		EXPECT_LE((dv - expected).norm(), 1e-13 * (1 + free.bodies[i].velocity.norm() + expected.norm()));
		EXPECT_LE((dw - turn).norm(), 1e-13 * (1 + free.bodies[i].angularVelocity.norm() + turn.norm()));
	}
	for (const Contact& c : problem.contacts) {
		const Body &b1 = problem.bodies[c.body1], &b2 = problem.bodies[c.body2];
		const Vector3 U = b2.velocity + b2.angularVelocity.cross(c.arm2) - b1.velocity - b1.angularVelocity.cross(c.arm1);
		EXPECT_LE((U - c.relativeVelocity).norm(), 1e-14 * (1 + U.norm()) * 10);
	}
}

TEST_P(Heap, WarmStartFromTheSolutionTakesOneSweep)
{
	solver.solve(problem, tight(1e-7, 50000));
	GrainProblem again = free;
	for (std::size_t i = 0; i < again.contacts.size(); ++i) again.contacts[i].impulse = problem.contacts[i].impulse;
	const SolveReport report = solver.solve(again, tight(1e-6));
	EXPECT_EQ(report.status, SolveStatus::converged);
	EXPECT_LE(report.iterations, 1);
}

TEST_P(Heap, UnitsDoNotMatter)
{
	// Powers of two change no mantissa: the very same digits in other units.
	const double length = 1.0 / 1024, mass = 1.0 / 4096, time = 1.0 / 16;
	GrainProblem scaled = problem;
	for (Body& b : scaled.bodies) {
		b.velocity *= length / time;
		b.angularVelocity /= time;
		b.inverseMass /= mass;
		b.inverseInertia /= mass * length * length;
	}
	for (Contact& c : scaled.contacts) {
		c.arm1 *= length;
		c.arm2 *= length;
		c.gapVelocity *= length / time;
	}
	const SolveReport one = solver.solve(problem, tight(1e-4)), two = solver.solve(scaled, tight(1e-4));
	EXPECT_EQ(one.iterations, two.iterations);
	EXPECT_EQ(one.residual, two.residual);
	for (std::size_t i = 0; i < problem.contacts.size(); ++i)
		ASSERT_EQ(problem.contacts[i].impulse * (mass * length / time), scaled.contacts[i].impulse) << "contact " << i;
}

TEST_P(Heap, OrderOfContactsMattersWithinTheToleranceOnly)
{
	GrainProblem shuffled = problem;
	std::mt19937_64 random(3);
	std::shuffle(shuffled.contacts.begin(), shuffled.contacts.end(), random);
	ASSERT_EQ(solver.solve(problem, tight(1e-9, 20000)).status, SolveStatus::converged);
	ASSERT_EQ(solver.solve(shuffled, tight(1e-9, 20000)).status, SolveStatus::converged);
	// Impulses of such a collection need not be unique, velocities nearly are: their distance in the energy norm.
	const independent::Agreement found = independent::agreement(free, problem, shuffled, 1e-9);
	EXPECT_LE(found.energy, found.bound);
	EXPECT_LE(found.bound, 1e-5 * scenes::kineticEnergy(problem)); // or it would say little
}

INSTANTIATE_TEST_SUITE_P(Kinds, Heap,
						 testing::Values(HeapKind{0, false, false}, HeapKind{0.3, false, false}, HeapKind{0.3, true, false},
										 HeapKind{0.5, false, false}, HeapKind{0.3, false, true}, HeapKind{0, false, true}));
