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

Crew::Crew(int threads) : wanted(threads)
{
	mates.reserve(threads > 1 ? threads - 1 : 0);
	for (int i = 1; i < threads; ++i) {
		try {
			mates.emplace_back([this] { assist(); });
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

bool Crew::jobOpen() const
{
	const std::uint64_t now = board.load();
	return (now & 0xffffffff) < (now >> 32);
}

/// Wakes the mates that sleep. Sequentially consistent order does it: either the leader sees a mate as asleep, or that mate sees the new board.
void Crew::ring()
{
	if (asleep.load() == 0) return;
	{
		const std::lock_guard<std::mutex> lock(bed);
	}
	bell.notify_all();
}

/// Takes and does one job; false when none is open. Both ends of the open jobs are one word: a thread that comes late finds either no open job or
/// valid ones, never one of a stage that is over.
bool Crew::takeJob(End end)
{
	constexpr std::uint64_t half = 0xffffffff;
	std::uint64_t now = board.load(std::memory_order_acquire), next;
	do {
		if ((now & half) >= (now >> 32)) return false;
		next = end == End::front ? now + 1 : now - (half + 1);
	} while (!board.compare_exchange_weak(now, next, std::memory_order_acq_rel, std::memory_order_acquire));
	call(context, first + (end == End::front ? now & half : (now >> 32) - 1));
	done.fetch_add(1, std::memory_order_acq_rel);
	return true;
}

void Crew::stage(std::size_t firstJob, std::size_t count)
{
	first = firstJob;
	done.store(0, std::memory_order_relaxed);
	board.store(std::uint64_t(count) << 32);
	ring();
	while (takeJob(End::front)) {}
	constexpr int patience = 20000; // pauses, some tenths of a millisecond: longer than the longest job
	int spins = 0;
	for (; done.load(std::memory_order_acquire) != count; ++spins) {
		if (spins < patience)
			pauseBriefly();
		else
			std::this_thread::yield();
	}
	if (spins > patience)
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
void Crew::assist()
{
	int spins = 0;
	while (!dismissed.load(std::memory_order_acquire)) {
		if (takeJob(End::back))
			spins = 0;
		else if (!resting.load(std::memory_order_relaxed) && ++spins < 20000)
			pauseBriefly();
		else {
			asleep.fetch_add(1);
			std::unique_lock<std::mutex> lock(bed);
			bell.wait(lock, [this] { return jobOpen() || dismissed.load(); });
			lock.unlock();
			asleep.fetch_sub(1);
			spins = 0;
		}
	}
}

} // namespace contactdynamics
