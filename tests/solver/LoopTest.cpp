// SPDX-License-Identifier: GPL-2.0-or-later
// When the loop begins a rival, what that costs at most, how it ends, and when the accelerator stalls: on operators whose increments are written out.
#include "pkg/solver/SignoriniCoulombLoop.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <vector>

using namespace contactdynamics;

namespace {

constexpr int never = std::numeric_limits<int>::max();
constexpr int firstStall = 122; // the sweep that sets the mark, 120 that do not pass it, and the one that notices

/// Sweeps whose increments stay as they are until one of them meets the tolerance.
struct Scripted {
	static constexpr bool startsPlainly = false;
	static constexpr int plainEnd = 32;
	int firstCheck = 0;
	int solvedAfter = never; // sweeps
	double impulse2 = 1;	 // beside increments of 1: cold below 4, warm above
	double unsolved = 1;	 // residual as long as it is not solved
	bool awake = true;
	int sweeps = 0;
	std::vector<Extrapolation> starts = {};

	bool anyAwake() const { return awake; }
	bool mend() const { return false; }
	double certificate() const { return sweeps >= solvedAfter ? 0 : unsolved; }
	SweepNorms sweep(Extrapolation from)
	{
		starts.push_back(from);
		return {++sweeps >= solvedAfter ? 0 : 1.0, impulse2};
	}
};

Scripted cold(int solvedAfter = never)
{
	Scripted op;
	op.solvedAfter = solvedAfter;
	return op;
}

Scripted warm(int solvedAfter = never)
{
	Scripted op = cold(solvedAfter);
	op.impulse2 = 4.01;
	return op;
}

struct Solve {
	LoopResult result;
	int begun; // sweeps of the operator when the rival began; never: it did not
};

Solve solve(Scripted op, Scripted rival, int maxIterations = 100000)
{
	SolverOptions options;
	options.maxIterations = maxIterations;
	Solve made{{}, never};
	made.result = signoriniCoulombLoop(op, options, [&] {
		EXPECT_EQ(made.begun, never) << "a second rival";
		made.begun = op.sweeps;
		return &rival;
	});
	return made;
}

bool isPlain(const Extrapolation& from) { return from.relax == 0 && from.momentum == 0; }

} // namespace

TEST(Loop, RivalBeginsAtTheFirstStallOfAColdStart) { EXPECT_EQ(solve(cold(), cold(1)).begun, firstStall); }

TEST(Loop, RivalOfAWarmStartBeginsLater)
{
	EXPECT_EQ(solve(warm(), warm(1)).begun, 1000);
	Scripted justCold = warm();
	justCold.impulse2 = 3.99; // increments of half the impulses part them
	EXPECT_EQ(solve(justCold, cold(1)).begun, firstStall);
}

TEST(Loop, NoRivalWithoutAStallNorWithoutAcceleration)
{
	EXPECT_EQ(solve(cold(firstStall), cold(1)).begun, never);
	Scripted op = cold(), rival = cold(1);
	SolverOptions plain;
	plain.acceleration = Acceleration::none;
	bool begun = false;
	signoriniCoulombLoop(op, plain, [&] {
		begun = true;
		return &rival;
	});
	EXPECT_FALSE(begun);
	for (const Extrapolation& from : op.starts) EXPECT_TRUE(isPlain(from));
}

/// Turns of 64: where plain sweeps alone take P, more than what the operator did before they began, all take 2 P and a turn at most; where they
/// take less, P beside what it did.
TEST(Loop, CostsTwiceThePlainSweepsAtMost)
{
	for (const int needed : {123, 150, 186, 187, 250, 251, 1000, 5000}) {
		const Solve fromCold = solve(cold(), cold(needed));
		EXPECT_TRUE(fromCold.result.byRival);
		EXPECT_LE(fromCold.result.iterations, 2 * needed + 64) << needed;
		const Solve fromWarm = solve(warm(), warm(needed));
		EXPECT_TRUE(fromWarm.result.byRival);
		EXPECT_LE(fromWarm.result.iterations, needed + std::max(needed, 1000) + 64) << needed;
	}
	EXPECT_EQ(solve(cold(), cold(50)).result.iterations, firstStall + 50);
}

TEST(Loop, MomentumGoesOnBesideTheRival)
{
	const Solve both = solve(cold(400), cold(5000));
	EXPECT_FALSE(both.result.byRival);
	EXPECT_EQ(both.result.residual, 0);
	EXPECT_LE(both.result.iterations, 2 * 400 + 64);
}

TEST(Loop, EndsPlainly)
{
	for (const int most : {1000, 100}) {
		Scripted op = warm();
		SolverOptions options;
		options.maxIterations = most;
		EXPECT_EQ(signoriniCoulombLoop(op, options).iterations, most);
		const int plain = std::min(32, most / 8);
		ASSERT_EQ(op.starts.size(), std::size_t(most));
		for (int i = most - plain; i < most; ++i) EXPECT_TRUE(isPlain(op.starts[i])) << i;
		EXPECT_FALSE(isPlain(op.starts[most - plain - 1]));
	}
}

TEST(Loop, ReturnsTheBetterPoint)
{
	Scripted good = cold(), bad = cold();
	good.unsolved = 2e-4;
	bad.unsolved = 3e-4;
	const LoopResult byRival = solve(bad, good, 500).result, byOwn = solve(good, bad, 500).result;
	EXPECT_TRUE(byRival.byRival);
	EXPECT_FALSE(byOwn.byRival);
	EXPECT_EQ(byRival.residual, 2e-4);
	EXPECT_EQ(byOwn.residual, 2e-4);
	EXPECT_EQ(byOwn.iterations, 500);
}

/// Increments may promise what the certificate does not hold; only the certificate ends the loop.
TEST(Loop, GoesOnUntilTheCertificateIsMet)
{
	struct Promising : Scripted {
		double certificate() const { return sweeps >= 300 ? 0 : 1; }
		SweepNorms sweep(Extrapolation from)
		{
			Scripted::sweep(from);
			return {std::pow(0.9, sweeps), 1};
		}
	} op;
	const LoopResult result = signoriniCoulombLoop(op, {});
	EXPECT_GE(result.iterations, 300);
	EXPECT_EQ(result.residual, 0);
}

TEST(Loop, StopsAtOnceWhereNothingIsFinite)
{
	struct Broken : Scripted {
		SweepNorms sweep(Extrapolation from)
		{
			Scripted::sweep(from);
			return {sweeps == 7 ? std::numeric_limits<double>::quiet_NaN() : 1, 1};
		}
	} op;
	const LoopResult result = signoriniCoulombLoop(op, {});
	EXPECT_EQ(result.iterations, 7);
	EXPECT_FALSE(std::isfinite(result.residual));
}

TEST(Loop, SweepsOverNothingThatSleeps)
{
	Scripted op = cold();
	op.awake = false;
	EXPECT_EQ(signoriniCoulombLoop(op, {}).iterations, 0);
	EXPECT_EQ(op.sweeps, 0);
}

TEST(Accelerator, SettlesLongerEachTime)
{
	Accelerator accelerator(false);
	std::vector<int> lengths;
	for (int sweep = 0, settling = 0; sweep < 2000; ++sweep) {
		const Extrapolation next = accelerator.next(1, 0);
		const bool light = next.relax == 0.3 && next.momentum == 0.2;
		settling += light;
		if (!light && settling > 0) {
			lengths.push_back(settling);
			settling = 0;
		}
	}
	ASSERT_GE(lengths.size(), 2u);
	EXPECT_EQ(lengths[0], 100);
	EXPECT_EQ(lengths[1], 200);
}

TEST(Accelerator, RestartsWhereIncrementsHaveGrownToTwice)
{
	Accelerator accelerator(false);
	double before = -1;
	for (int sweep = 0; sweep < 50; ++sweep) {
		const Extrapolation next = accelerator.next(1, 0);
		EXPECT_GT(next.momentum, before); // it grows towards 1
		EXPECT_LT(next.momentum, 1);
		EXPECT_DOUBLE_EQ(next.relax, 1.5 * next.momentum);
		before = next.momentum;
	}
	EXPECT_GT(accelerator.next(3.99, 0).momentum, before);
	EXPECT_TRUE(isPlain(accelerator.next(4.01, 0)));
	EXPECT_TRUE(isPlain(accelerator.next(4.01, 0))); // t = 1
	EXPECT_GT(accelerator.next(4.01, 0).momentum, 0);
}

TEST(Accelerator, StaysPlainWhereThatIsSoonDone)
{
	const auto plainSweeps = [](double rate) { // of increment2, from 1 down to 1e-8
		Accelerator accelerator(true);
		int sweeps = 0;
		for (double increment2 = 1; increment2 > 1e-8; increment2 *= rate, ++sweeps)
			if (!isPlain(accelerator.next(increment2, 1e-8))) break;
		return sweeps;
	};
	const double in50 = std::pow(1e-8, 1.0 / 50), in200 = std::pow(1e-8, 1.0 / 200);
	EXPECT_GE(plainSweeps(in50), 50);
	EXPECT_LE(plainSweeps(in200), 2 * 8 + 1); // it takes two stretches of eight to know the rate, and the first sweep with t = 1
}
