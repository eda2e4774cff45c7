// SPDX-License-Identifier: GPL-2.0-or-later
#include "Crew.hpp"

#include <system_error>

namespace contactdynamics {

namespace {

void pauseBriefly()
{
#if defined(__x86_64__) || defined(__i386__)
	__builtin_ia32_pause();
#endif
}

} // namespace

Crew::Crew(int threads)
{
	helpers.reserve(threads > 1 ? threads - 1 : 0);
	for (int i = 1; i < threads; ++i) {
		try {
			helpers.emplace_back([this] { help(); });
		} catch (const std::system_error&) {
			return;
		}
	}
}

Crew::~Crew()
{
	dismissed.store(true, std::memory_order_release);
	for (std::thread& helper : helpers) helper.join();
}

/// Takes and does one job; false when none is open. The number of jobs and the next one are one word: a thread that comes late finds either
/// no open job or a valid one, never one of a stage that is over.
bool Crew::takeJob()
{
	std::uint64_t now = board.load(std::memory_order_acquire);
	do {
		if ((now & 0xffffffff) >= (now >> 32)) return false;
	} while (!board.compare_exchange_weak(now, now + 1, std::memory_order_acq_rel, std::memory_order_acquire));
	call(context, first + (now & 0xffffffff));
	done.fetch_add(1, std::memory_order_acq_rel);
	return true;
}

void Crew::stage(std::size_t firstJob, std::size_t count)
{
	first = firstJob;
	done.store(0, std::memory_order_relaxed);
	board.store(std::uint64_t(count) << 32, std::memory_order_release);
	while (takeJob()) {}
	for (int spins = 0; done.load(std::memory_order_acquire) != count; ++spins) spins < 2000 ? pauseBriefly() : std::this_thread::yield();
}

void Crew::help()
{
	int spins = 0;
	while (!dismissed.load(std::memory_order_acquire)) {
		if (takeJob())
			spins = 0;
		else
			++spins < 2000 ? pauseBriefly() : std::this_thread::yield();
	}
}

} // namespace contactdynamics
