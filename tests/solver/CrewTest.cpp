// SPDX-License-Identifier: GPL-2.0-or-later
// Threads that share the jobs of many short stages: each job is done once, in its stage, whoever is late.
#include "pkg/solver/Crew.hpp"

#include <chrono>
#include <gtest/gtest.h>
#include <thread>

using namespace contactdynamics;

namespace {

class EveryJobOnce : public testing::TestWithParam<int> {};

/// A stage reads what the one before has written, as the colours of a sweep do: a job that is missed, done twice or done in another stage shows.
TEST_P(EveryJobOnce, InItsStage)
{
	Crew crew(GetParam());
	crew.resume();
	constexpr std::size_t most = 70;
	std::vector<long> before(most, 0), now(most, 0);
	for (long stage = 1; stage <= 200 * long(most); ++stage) {
		const std::size_t count = std::size_t(stage) % (most + 1);
		crew.run(count, [&](std::size_t i) { now[i] += before[count - 1 - i] + 1; });
		for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(now[i], stage) << "job " << i << " of " << count;
		before.assign(most, stage);
		now.assign(most, 0);
	}
}

/// Mates that sleep, that are at work when the crew rests, and that are held up in a job.
TEST_P(EveryJobOnce, WithLateMates)
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

INSTANTIATE_TEST_SUITE_P(Threads, EveryJobOnce, testing::Values(1, 2, 3, 8));

} // namespace
