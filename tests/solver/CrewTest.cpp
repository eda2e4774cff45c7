// SPDX-License-Identifier: GPL-2.0-or-later
// Threads that share the jobs of many short stages: all of them come, and each job is done once, in its stage, whoever is late.
#include "pkg/solver/Crew.hpp"

#include <atomic>
#include <chrono>
#include <gtest/gtest.h>
#include <thread>
#include <vector>

using namespace contactdynamics;

namespace {

class CrewOf : public testing::TestWithParam<int> {};

/// Each job waits for the others, so each needs a thread of its own: all mates must be dealt a job and wake, from spinning and from bed. A crew of
/// its own for each round, because one whose mates were late works alone for a while.
TEST_P(CrewOf, AllTakePart)
{
	const int threads = GetParam();
	for (int round = 0; round < 20; ++round) {
		Crew crew(threads);
		if (round % 2 == 0) crew.resume();
		if (round % 3 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));
		std::atomic<int> here{0};
		const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
		crew.run(std::size_t(threads), [&](std::size_t) {
			++here;
			while (here < threads && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
		});
		ASSERT_EQ(here, threads) << "round " << round;
		ASSERT_LT(std::chrono::steady_clock::now(), deadline) << "round " << round << ": somebody was waited for in vain";
	}
}

/// A stage reads what the one before has written, as the jobs of a sweep do: a job that is missed, done twice or done in another stage shows.
TEST_P(CrewOf, EveryJobOnceInItsStage)
{
	Crew crew(GetParam());
	crew.resume();
	constexpr std::size_t most = 70;
	std::vector<long> value(most), between(most), times(most);
	for (long round = 1; round <= 7000; ++round) {
		const std::size_t count = std::size_t(round) % (most + 1);
		value.assign(most, round);
		between.assign(most, 0);
		times.assign(most, 0);
		crew.run(count, [&](std::size_t i) {
			++times[i];
			between[i] = value[i] + long(i);
		});
		crew.run(count, [&](std::size_t i) {
			++times[i];
			value[i] = between[count - 1 - i];
		});
		for (std::size_t i = 0; i < most; ++i) {
			ASSERT_EQ(times[i], i < count ? 2 : 0) << "job " << i << " of " << count << ", round " << round;
			ASSERT_EQ(value[i], i < count ? round + long(count - 1 - i) : round) << "job " << i << " of " << count << ", round " << round;
		}
	}
}

/// Mates that sleep, that are at work when the crew rests, and that are held up in a job.
TEST_P(CrewOf, LateMates)
{
	Crew crew(GetParam());
	for (int round = 0; round < 20; ++round) {
		if (round % 2 == 0) crew.resume();
		std::vector<int> done(50, 0);
		crew.run(done.size(), [&](std::size_t i) {
			if (i % 17 == std::size_t(round) % 17) std::this_thread::sleep_for(std::chrono::microseconds(300));
			++done[i];
		});
		EXPECT_EQ(done, std::vector<int>(50, 1)) << "round " << round;
		if (round % 3 == 0) crew.rest();
		if (round % 5 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));
	}
}

INSTANTIATE_TEST_SUITE_P(Threads, CrewOf, testing::Values(1, 2, 3, 8));

} // namespace
