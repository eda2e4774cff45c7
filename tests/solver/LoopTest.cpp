// SPDX-License-Identifier: GPL-2.0-or-later
// When the loop begins a rival, what that costs at most, how it ends, and when the accelerator stalls: on operators whose increments are written out.
#include "pkg/solver/GuardedLoop.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

using namespace contactdynamics;

namespace {

constexpr int never = std::numeric_limits<int>::max();

struct SpotOutcome {
	bool settled = false;
	double sweeps = 0, newtonCost = 0;
};
/// Nothing is done about the largest changes.
template <class Operator> SpotOutcome leaveThem(Operator&, int, int) { return {}; }

constexpr int firstStall = 122; // the sweep that sets the mark, 120 that do not pass it, and the one that notices

/// Sweeps whose increments stay as they are until one of them meets the tolerance.
struct Scripted {
	static constexpr bool startsPlainly = false;
	int firstCheck = 0;
	int solvedAfter = never; // sweeps
	double unsolved = 1;	 // residual as long as it is not solved
	bool awake = true;
	int sweeps = 0, certificates = 0;
	std::vector<Extrapolation> starts = {};

	bool anyAwake() const { return awake; }
	bool mend() const { return false; }
	void keep() {}
	void exchangeKept() {}
	double certificate()
	{
		++certificates;
		return sweeps >= solvedAfter ? 0 : unsolved;
	}
	SweepNorms sweep(Extrapolation from)
	{
		starts.push_back(from);
		return {++sweeps >= solvedAfter ? 0 : 1.0, 1};
	}
};

Scripted solvedAfter(int sweeps)
{
	Scripted op;
	op.solvedAfter = sweeps;
	return op;
}

struct Solve {
	GuardedResult result;
	int begun; // sweeps of the operator when the rival began; never: it did not
	std::vector<Extrapolation> startsOfRival;
};

template <class Operator> Solve solve(Operator op, Operator rival, int lead, int maxIterations = 100000)
{
	SolverOptions options;
	options.maxIterations = maxIterations;
	Solve made{{}, never, {}};
	made.result = guardedLoop(
			op, options, lead,
			[&]() -> Operator& {
				EXPECT_EQ(made.begun, never) << "a second rival";
				made.begun = op.sweeps;
				return rival;
			},
			leaveThem<Operator>);
	made.startsOfRival = rival.starts;
	return made;
}

bool isPlain(const Extrapolation& from) { return from.relax == 0 && from.momentum == 0; }

} // namespace

TEST(Loop, RivalBeginsWhereMomentumHasStalledAndLed)
{
	EXPECT_EQ(solve(Scripted(), solvedAfter(1), 0).begun, firstStall);
	EXPECT_EQ(solve(Scripted(), solvedAfter(1), firstStall + 1).begun, firstStall + 1);
	EXPECT_EQ(solve(Scripted(), solvedAfter(1), 1000).begun, 1000);
	EXPECT_EQ(solve(solvedAfter(firstStall), solvedAfter(1), 0).begun, never);
}

TEST(Loop, RivalSweepsPlainly)
{
	const Solve made = solve(Scripted(), solvedAfter(500), 0);
	ASSERT_EQ(made.startsOfRival.size(), 500u);
	for (const Extrapolation& from : made.startsOfRival) EXPECT_TRUE(isPlain(from));
}

TEST(Loop, PlainWithoutAcceleration)
{
	Scripted op, rival = solvedAfter(1);
	SolverOptions plain;
	plain.acceleration = Acceleration::none;
	bool begun = false;
	guardedLoop(
			op, plain, 0,
			[&]() -> Scripted& {
				begun = true;
				return rival;
			},
			leaveThem<Scripted>);
	EXPECT_FALSE(begun);
	for (const Extrapolation& from : op.starts) EXPECT_TRUE(isPlain(from));
}

/// Sweeps whose increments fall by a power of their number, as plain ones do, until they are as small as the tolerance and it is met; or stay at 1.
struct Falling : Scripted {
	double power = 0;
	SweepNorms sweep(Extrapolation from)
	{
		const SweepNorms atOne = Scripted::sweep(from);
		if (power == 0 || sweeps >= solvedAfter) return atOne;
		return {std::pow(SolverOptions().tolerance * std::pow(double(solvedAfter) / sweeps, power), 2), 1};
	}
};

Falling fallingUntil(int solved, double power)
{
	Falling op;
	op.solvedAfter = solved;
	op.power = power;
	return op;
}

/// What is foretold is never more than what it takes then, so that the operator has done P at most when plain sweeps alone take P, or its lead.
TEST(Loop, CostsTwiceThePlainSweepsOrTheLeadAtMost)
{
	for (const double power : {0.5, 1.0, 3.0})
		for (const int lead : {0, 1000})
			for (int needed = 1; needed < 6000; needed += needed < 700 ? 1 : 97) {
				const GuardedResult result = solve(Falling(), fallingUntil(needed, power), lead).result;
				EXPECT_TRUE(result.byRival);
				EXPECT_LE(result.iterations, needed + std::max({needed, lead, firstStall})) << needed << ", " << power;
			}
}

/// It may stand still until it is done: the operator has done twice as many then.
TEST(Loop, CostsThreeTimesThePlainSweepsThatStandStill)
{
	for (int needed = 1; needed < 6000; needed += needed < 700 ? 1 : 97)
		for (const int lead : {0, 1000}) {
			const Solve made = solve(Scripted(), solvedAfter(needed), lead);
			EXPECT_TRUE(made.result.byRival);
			EXPECT_LE(made.result.iterations, needed + std::max({2 * needed, lead, firstStall})) << needed;
		}
}

/// Turns of 64. A rival that stands still has done half as many when the operator has its turn, and is ahead by less than two turns.
TEST(Loop, MomentumGoesOnBesideTheRival)
{
	for (int needed = firstStall + 1; needed < 4000; needed += 7) {
		const Solve both = solve(solvedAfter(needed), Scripted(), 0);
		EXPECT_FALSE(both.result.byRival);
		EXPECT_EQ(both.result.residual, 0);
		EXPECT_LT(both.result.iterations, 1.5 * needed + 2 * 64) << needed;
		EXPECT_GE(both.result.iterations, 1.5 * needed) << needed; // the rival did have its turns
	}
}

/// Outside the loop a few contacts are solved from time to time; more often where momentum has stalled, less often where that is dear.
TEST(Loop, SettlesTheLargestChangesFromTimeToTime)
{
	SolverOptions options;
	options.maxIterations = 2000;
	std::size_t sweeps = 0;
	const auto solveWith = [&](SpotOutcome outcome) {
		Scripted op, rival;
		std::vector<int> at;
		const GuardedResult result = guardedLoop(
				op, options, never, [&]() -> Scripted& { return rival; },
				[&](Scripted& its, int left, int done) {
					EXPECT_EQ(done, its.sweeps);
					EXPECT_LE(left, 2000 - 32 - its.sweeps);
					at.push_back(its.sweeps);
					return outcome;
				});
		EXPECT_EQ(result.iterations, 2000);
		sweeps = op.starts.size();
		// The change is not carried on by momentum, neither in the sweep that follows nor in the one after it, also while a stall is settled.
		for (const int first : outcome.settled ? at : std::vector<int>())
			EXPECT_TRUE(isPlain(op.starts[first]) && isPlain(op.starts[first + 1])) << "after sweep " << first;
		return at;
	};
	// Stalled already: the increments of the script never fall.
	const std::vector<int> often = solveWith({true, 0, 0});
	EXPECT_EQ(sweeps, 2000u);
	ASSERT_GT(often.size(), 2u);
	EXPECT_EQ(often[0], 150);
	for (std::size_t i = 1; i < often.size(); ++i) EXPECT_EQ(often[i] - often[i - 1], 20);
	EXPECT_EQ(often.back(), 150 + (1967 - 150) / 20 * 20); // not in the last 32 sweeps, which are plain
	// What a spot costs counts as sweeps, Newton steps do not, and a quarter of both is waited for.
	const std::vector<int> seldom = solveWith({false, 2.5, 397.5});
	EXPECT_EQ(seldom[1] - seldom[0], 100);
	EXPECT_EQ(sweeps, 2000 - std::size_t(2.5 * double(seldom.size())));
}

/// The rival keeps up with what spots cost, too.
TEST(Loop, CostsTwiceThePlainSweepsWithSpotsToo)
{
	for (int needed = 400; needed < 6000; needed += 97) {
		Falling op, rival = fallingUntil(needed, 1);
		SolverOptions options;
		options.maxIterations = 100000;
		const double ofSpot = 17.25;
		const GuardedResult result = guardedLoop(
				op, options, 1000, [&]() -> Falling& { return rival; },
				[&](Falling&, int, int) {
					return SpotOutcome{true, ofSpot, 1000};
				});
		EXPECT_TRUE(result.byRival);
		EXPECT_LE(result.iterations, needed + std::max(needed, 1000) + ofSpot + 1) << needed; // a spot is not left half-way
	}
}

/// Before momentum has stalled there is less to settle.
TEST(Loop, SettlesLessOftenWhileMomentumGainsGround)
{
	struct Gaining : Scripted {
		SweepNorms sweep(Extrapolation from)
		{
			Scripted::sweep(from);
			return {std::pow(0.99, sweeps), 1};
		}
	} op, rival;
	std::vector<int> at;
	guardedLoop(
			op, {}, never, [&]() -> Gaining& { return rival; },
			[&](Gaining& its, int, int) {
				at.push_back(its.sweeps);
				return SpotOutcome{};
			});
	ASSERT_GT(at.size(), 2u);
	for (std::size_t i = 1; i < at.size(); ++i) EXPECT_EQ(at[i] - at[i - 1], 50);
}

TEST(Loop, EndsPlainly)
{
	for (const int most : {1000, 100}) {
		Scripted op, rival;
		SolverOptions options;
		options.maxIterations = most;
		EXPECT_EQ(guardedLoop(
						  op, options, never, [&]() -> Scripted& { return rival; }, leaveThem<Scripted>)
						  .iterations,
				  most);
		EXPECT_EQ(rival.sweeps, 0);
		const int plain = std::min(32, most / 8);
		ASSERT_EQ(op.starts.size(), std::size_t(most));
		for (int i = most - plain; i < most; ++i) EXPECT_TRUE(isPlain(op.starts[i])) << i;
		EXPECT_FALSE(isPlain(op.starts[most - plain - 1]));
	}
}

TEST(Loop, ReturnsTheBetterPoint)
{
	Scripted good, bad;
	good.unsolved = 2e-4;
	bad.unsolved = 3e-4;
	const GuardedResult byRival = solve(bad, good, 0, 500).result, byOwn = solve(good, bad, 0, 500).result;
	EXPECT_TRUE(byRival.byRival);
	EXPECT_FALSE(byOwn.byRival);
	EXPECT_EQ(byRival.residual, 2e-4);
	EXPECT_EQ(byOwn.residual, 2e-4);
	EXPECT_EQ(byOwn.iterations, 500);
}

/// Increments fall until sweep `best` and grow again; the point of a sweep is its increment.
struct Wandering : Scripted {
	int best = 700;
	bool misleads = false; // large increments are the good points
	double point = 0, kept = 0;
	std::vector<double> pointsAtExchange = {};
	SweepNorms sweep(Extrapolation from)
	{
		Scripted::sweep(from);
		point = 1 + 0.01 * std::abs(sweeps - best);
		return {point * point, 1};
	}
	double certificate() const { return misleads ? 1 / point : point; }
	void keep() { kept = point; }
	void exchangeKept()
	{
		pointsAtExchange.push_back(point);
		std::swap(point, kept);
	}
};

TEST(Loop, TakesUpTheBestPointAndReturnsItWhereTheSweepsRunOut)
{
	for (const int best : {600, 700, 900}) {
		Wandering op, rival;
		op.best = best;
		const GuardedResult result = guardedLoop(
				op, {}, never, [&]() -> Wandering& { return rival; }, leaveThem<Wandering>);
		EXPECT_EQ(result.iterations, 1000);
		EXPECT_EQ(result.residual, op.point);
		EXPECT_GE(result.residual, 1);
		EXPECT_LE(result.residual, 1 / std::sqrt(0.8)); // a point is kept where it is better by that, no sooner
		ASSERT_EQ(op.pointsAtExchange.size(), 2u);
		EXPECT_EQ(op.pointsAtExchange[0], 1 + 0.01 * std::abs(968 - best)); // before the plain end
		EXPECT_EQ(op.pointsAtExchange[1], 1 + 0.01 * std::abs(1000 - best));
	}
}

/// The certificate decides, not the increments.
TEST(Loop, ReturnsThePointWithTheBetterCertificate)
{
	Wandering op, rival;
	op.misleads = true;
	const GuardedResult result = guardedLoop(
			op, {}, never, [&]() -> Wandering& { return rival; }, leaveThem<Wandering>);
	EXPECT_EQ(op.point, 1 + 0.01 * std::abs(1000 - op.best));
	EXPECT_EQ(result.residual, 1 / op.point);
}

/// A rival has its best point, too.
TEST(Loop, ReturnsTheBestPointOfTheRival)
{
	Wandering op, rival;
	op.best = 4000;	  // at 4000 - sweeps of 100 or more
	rival.best = 250; // it does a third of 968 sweeps at least
	const GuardedResult result = guardedLoop(
			op, {}, 0, [&]() -> Wandering& { return rival; }, leaveThem<Wandering>);
	EXPECT_TRUE(result.byRival);
	EXPECT_EQ(result.residual, rival.point);
	EXPECT_LE(result.residual, 1 / std::sqrt(0.8));
}

TEST(Loop, KeepsNothingWithoutAcceleration)
{
	Wandering op, rival;
	SolverOptions plain;
	plain.acceleration = Acceleration::none;
	const GuardedResult result = guardedLoop(
			op, plain, 0, [&]() -> Wandering& { return rival; }, leaveThem<Wandering>);
	EXPECT_TRUE(op.pointsAtExchange.empty());
	EXPECT_EQ(op.kept, 0);
	EXPECT_EQ(result.residual, 1 + 0.01 * std::abs(1000 - op.best)); // the last one, as Gauss-Seidel leaves it
}

/// Increments may promise what the certificate does not hold. Only the certificate ends the loop, but it is believed less often: where it is 1e4
/// times too large, the next one is due when the increments are 1e4 times smaller (and a twentieth).
TEST(Loop, BelievesIncrementsLessAfterABrokenPromise)
{
	struct Promising : Scripted {
		double certificate()
		{
			++certificates;
			return sweeps >= 300 ? 0 : 1;
		}
		SweepNorms sweep(Extrapolation from)
		{
			Scripted::sweep(from);
			return {std::pow(0.9, sweeps), 1};
		}
	} op;
	const LoopResult result = signoriniCoulombLoop(op, {});
	EXPECT_EQ(result.residual, 0);
	EXPECT_EQ(op.certificates, 2); // at increments of 1e-4 and 0.95e-8
	EXPECT_EQ(result.iterations, int(std::ceil(2 * std::log(0.95e-8) / std::log(0.9))));
}

TEST(Loop, StopsAtOnceWhereNothingIsFinite)
{
	struct Broken : Scripted {
		bool ofImpulse = false;
		SweepNorms sweep(Extrapolation from)
		{
			Scripted::sweep(from);
			const double broken = sweeps == 7 ? std::numeric_limits<double>::quiet_NaN() : 1;
			return ofImpulse ? SweepNorms{1, broken} : SweepNorms{broken, 1};
		}
	};
	for (const bool ofImpulse : {false, true}) {
		Broken op;
		op.ofImpulse = ofImpulse;
		const LoopResult result = signoriniCoulombLoop(op, {});
		EXPECT_EQ(result.iterations, 7);
		EXPECT_FALSE(std::isfinite(result.residual));
	}
}

TEST(Loop, SweepsOverNothingThatSleeps)
{
	Scripted op;
	op.awake = false;
	EXPECT_EQ(signoriniCoulombLoop(op, {}).iterations, 0);
	EXPECT_EQ(op.sweeps, 0);
}

TEST(Accelerator, SettlesLongerEachTime)
{
	Accelerator accelerator(false);
	std::vector<int> lengths;
	bool afterSettling = false;
	for (int sweep = 0, settling = 0; sweep < 2000; ++sweep) {
		const Extrapolation next = accelerator.next(1, 0);
		const bool light = next.relax == 0.3 && next.momentum == 0.2;
		settling += light;
		if (afterSettling) {
			EXPECT_GT(next.momentum, 0.2); // t = 1.5 by now
			afterSettling = false;
		}
		if (!light && settling > 0) {
			EXPECT_TRUE(isPlain(next)); // it begins anew, t = 1
			afterSettling = true;
			lengths.push_back(settling);
			settling = 0;
		}
	}
	ASSERT_GE(lengths.size(), 2u);
	EXPECT_EQ(lengths[0], 100);
	EXPECT_EQ(lengths[1], 200);
}

/// A fifth of the energy is a tenth of the increments.
TEST(Accelerator, StallsWhereIncrementsDoNotLoseATenth)
{
	const auto stalls = [](double lostIn120) {
		Accelerator accelerator(false);
		const double rate = std::pow(1 - lostIn120, 1.0 / 120);
		double increment2 = 1;
		for (int sweep = 0; sweep < 1000 && !accelerator.hasStalled(); ++sweep, increment2 *= rate) accelerator.next(increment2, 0);
		return accelerator.hasStalled();
	};
	EXPECT_TRUE(stalls(0.19));
	EXPECT_FALSE(stalls(0.21));
}

TEST(Accelerator, RestartsWhereIncrementsHaveGrownToTwice)
{
	Accelerator accelerator(false);
	for (int sweep = 0; sweep < 50; ++sweep) {
		const double t = 1 + 0.5 * sweep;
		const Extrapolation next = accelerator.next(1, 0);
		EXPECT_DOUBLE_EQ(next.momentum, (t - 1) / (t + 0.5));
		EXPECT_DOUBLE_EQ(next.relax, 1.5 * next.momentum);
	}
	EXPECT_GT(accelerator.next(3.99, 0).momentum, 0.9);
	EXPECT_TRUE(isPlain(accelerator.next(4.01, 0)));
	EXPECT_TRUE(isPlain(accelerator.next(4.01, 0))); // t = 1
	EXPECT_GT(accelerator.next(4.01, 0).momentum, 0);
}

/// Stretches of eight sweeps tell the rate; the first sweep with momentum has t = 1 and is plain, too.
TEST(Accelerator, StaysPlainWhereThatIsSoonDone)
{
	const auto plainSweeps = [](double needed) { // of increment2, from 1 down to 1e-8
		Accelerator accelerator(true);
		const double rate = std::pow(1e-8, 1 / needed);
		int sweeps = 0;
		for (double increment2 = 1; increment2 > 1e-8 && sweeps < 1000; increment2 *= rate, ++sweeps)
			if (!isPlain(accelerator.next(increment2, 1e-8))) break;
		return sweeps;
	};
	EXPECT_EQ(plainSweeps(200), 8 + 1);
	EXPECT_EQ(plainSweeps(70), 8 + 1); // 62 left after the first stretch
	EXPECT_GE(plainSweeps(66), 64);	   // 58 left
	EXPECT_GE(plainSweeps(50), 50);
}

/// Increments that always promise to be done in 58 sweeps, and never are.
TEST(Accelerator, DoesNotStayPlainForEver)
{
	Accelerator accelerator(true);
	int sweeps = 0;
	for (double increment2 = 1; sweeps < 1000; increment2 *= 0.9, ++sweeps)
		if (!isPlain(accelerator.next(increment2, increment2 * std::pow(0.9, 58)))) break;
	EXPECT_EQ(sweeps, 64 + 1);
}
