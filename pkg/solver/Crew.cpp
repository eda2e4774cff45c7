// SPDX-License-Identifier: GPL-2.0-or-later
#include "Crew.hpp"

#include <algorithm>
#include <chrono>
#include <system_error>

namespace contactdynamics {

namespace {

void pauseBriefly()
{
#if defined(__x86_64__) || defined(__i386__)
	__builtin_ia32_pause();
#endif
}

double secondsNow() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

} // namespace

Crew::Crew(int threads) : wanted(threads), desks(std::size_t(std::max(threads, 1))), tallies(desks.size())
{
	mates.reserve(threads > 1 ? threads - 1 : 0);
	for (int i = 1; i < threads; ++i) {
		try {
			mates.emplace_back([this, i] { assist(std::size_t(i)); });
		} catch (const std::system_error&) {
			return;
		}
	}
}

Crew::~Crew()
{
	dismissed.store(true);
	ring();
	for (std::thread& mate : mates) mate.join();
}

bool Crew::jobOpen(std::size_t desk) const
{
	const std::uint64_t now = desks[desk].open.load();
	return (now & 0xffffffff) < (now >> 32);
}

bool Crew::allDone() const
{
	std::size_t done = 0;
	for (const Tally& tally : tallies) done += tally.done.load(std::memory_order_acquire);
	return done == issued;
}

/// Wakes the mates that sleep.
void Crew::ring()
{
	{
		const std::lock_guard<std::mutex> lock(bed);
	}
	bell.notify_all();
}

/// Takes and does one job, from the front of the thread's own desk or the back of another one; false when none is open there. Both ends of the open
/// jobs are one word: a thread that comes late finds either no open job or valid ones, never one of a stage that is over.
bool Crew::takeJob(std::size_t thread, std::size_t desk)
{
	constexpr std::uint64_t half = 0xffffffff;
	const bool own = thread == desk;
	std::atomic<std::uint64_t>& open = desks[desk].open;
	std::uint64_t now = open.load(std::memory_order_acquire), next;
	do {
		if ((now & half) >= (now >> 32)) return false;
		next = own ? now + 1 : now - (half + 1);
	} while (!open.compare_exchange_weak(now, next, std::memory_order_acq_rel, std::memory_order_acquire));
	call(context, first + (own ? now & half : (now >> 32) - 1));
	std::atomic<std::size_t>& done = tallies[thread].done;
	done.store(done.load(std::memory_order_relaxed) + 1, std::memory_order_release);
	return true;
}

void Crew::work(std::size_t thread)
{
	for (std::size_t k = 0; k < desks.size(); ++k)
		while (takeJob(thread, (thread + k) % desks.size())) {}
}

void Crew::stage(std::size_t firstJob, std::size_t count)
{
	first = firstJob;
	issued += count;
	const std::size_t hands = std::min(mates.size() + 1, count);
	bool asleep = false;
	for (std::size_t k = hands; k-- > 0;) { // the leader's own last: mates may begin
		desks[k].open.store(std::uint64_t((k + 1) * count / hands) << 32 | k * count / hands);
		// Sequentially consistent order: either the mate is seen asleep here, or it sees its desk before it sleeps.
		asleep = asleep || desks[k].asleep.load();
	}
	if (asleep) ring();
	const std::size_t doneBefore = tallies[0].done.load(std::memory_order_relaxed);
	const double begun = secondsNow();
	work(0);
	const double ready = secondsNow();
	const auto own = double(std::max<std::size_t>(tallies[0].done.load(std::memory_order_relaxed) - doneBefore, 1));
	const double patience = 3e-4 + 2 * (ready - begun) / own; // a mate may have begun a job a moment ago
	bool late = false;
	while (!allDone()) {
		late = late || secondsNow() > ready + patience;
		if (late)
			std::this_thread::yield();
		else
			pauseBriefly();
	}
	if (late)
		takeOffence();
	else if (penalty > leastPenalty)
		forgive();
}

bool Crew::worksAlone()
{
	if (aloneUntil > 0 && secondsNow() >= aloneUntil) aloneUntil = 0;
	return aloneUntil > 0;
}

void Crew::takeOffence()
{
	togetherSince = aloneUntil = secondsNow() + penalty;
	penalty = std::min(2 * penalty, longestPenalty);
}

void Crew::forgive()
{
	const double now = secondsNow();
	if (now < togetherSince + 4 * penalty) return;
	penalty = std::max(0.5 * penalty, leastPenalty);
	togetherSince = now;
}

/// Stages follow each other within microseconds: a mate spins for some, then sleeps. It does not yield: recent kernels count that against the
/// thread, and a mate that yielded was not seen again for milliseconds.
void Crew::assist(std::size_t thread)
{
	int spins = 0;
	while (!dismissed.load(std::memory_order_acquire)) {
		if (jobOpen(thread)) {
			work(thread);
			spins = 0;
		} else if (!resting.load(std::memory_order_relaxed) && ++spins < 20000)
			pauseBriefly();
		else {
			desks[thread].asleep.store(true);
			std::unique_lock<std::mutex> lock(bed);
			bell.wait(lock, [this, thread] { return jobOpen(thread) || dismissed.load(); });
			lock.unlock();
			desks[thread].asleep.store(false);
			spins = 0;
		}
	}
}

} // namespace contactdynamics
