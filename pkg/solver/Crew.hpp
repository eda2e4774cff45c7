// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>
#include <vector>

namespace contactdynamics {

/// Threads that share the independent jobs of one stage after another, for stages of microseconds.
///
/// The leader deals the jobs of a stage out to desks, one of each thread, in runs of neighbours: so each core meets the same bodies again in the next
/// sweep. Everybody works off the own desk from the front, then the others' from the back, so that the leader never waits for a thread, only for a
/// job that a mate has begun. OpenMP's barriers were rejected: on a machine with other work each of them waits for every thread to be scheduled
/// again, and a sweep of ten stages, 20 microseconds of work, took 40 milliseconds on two busy cores. So was one desk for all, whose cache line goes
/// from core to core with each job (doc/grains.rst). Which thread does a job is a matter of chance; results must not depend on it.
class Crew {
public:
	/// Mates for the life time of the object; none when the system refuses more threads: then the leader does all. They sleep until resume().
	explicit Crew(int threads);
	~Crew();
	Crew(const Crew&) = delete;
	Crew& operator=(const Crew&) = delete;

	int threads() const { return wanted; } ///< asked for, the leader included

	/// Around many stages: between resume() and rest() mates spin for a while when there is no job, after rest() they go to sleep at once, so that
	/// they do not stand in the way of other threads of the program.
	void resume() { resting.store(false, std::memory_order_relaxed); }
	void rest() { resting.store(true, std::memory_order_relaxed); }

	/// Calls job(0) ... job(count - 1), each once, concurrently; returns when all are done. Jobs must not throw.
	template <class Job> void run(std::size_t count, const Job& job)
	{
		if (mates.empty() || count < 2 || worksAlone()) {
			for (std::size_t i = 0; i < count; ++i) job(i);
			return;
		}
		call = [](const void* context, std::size_t i) { (*static_cast<const Job*>(context))(i); };
		context = &job;
		for (std::size_t first = 0; first < count; first += maxJobs) stage(first, count - first < maxJobs ? count - first : maxJobs);
		context = nullptr;
	}

private:
	static constexpr std::size_t maxJobs = 0x7fffffff;

	int wanted;
	std::vector<std::thread> mates;
	// Of the present stage; written by the leader only while no job is open.
	void (*call)(const void*, std::size_t) = nullptr;
	const void* context = nullptr;
	std::size_t first = 0;
	std::size_t issued = 0; // jobs, since the beginning
	// A mate that the system took off its core in mid-job holds everybody up; the leader then works alone for a while, longer each time, and
	// shorter again after a while together without that. [s]
	static constexpr double leastPenalty = 0.002, longestPenalty = 1;
	double aloneUntil = 0, penalty = leastPenalty, togetherSince = 0;
	struct alignas(64) Desk {
		std::atomic<std::uint64_t> open{0}; // jobs: one past the last (upper half) and the first (lower half)
		std::atomic<bool> asleep{false};	// its mate waits for the bell, because nothing came for a while
	};
	struct alignas(64) Tally {
		std::atomic<std::size_t> done{0}; // jobs, since the beginning, by the one thread that writes here
	};
	// Apart from what the leader writes in each stage, because mates that wait look here all the time.
	alignas(64) std::vector<Desk> desks; // of the leader, then of the mates
	std::vector<Tally> tallies;
	std::atomic<bool> dismissed{false}, resting{true};
	alignas(64) std::mutex bed;
	std::condition_variable bell;

	bool jobOpen(std::size_t desk) const;
	bool allDone() const;
	void ring();
	bool worksAlone();
	void takeOffence();
	void forgive();
	bool takeJob(std::size_t thread, std::size_t desk);
	void work(std::size_t thread);
	void stage(std::size_t firstJob, std::size_t count);
	void assist(std::size_t thread);
};

} // namespace contactdynamics
