// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <lib/base/Math.hpp>

#include <ctime>

namespace yade {

/// How often something ran and how long that took.
struct TimingInfo {
	using delta = unsigned long long;

	long nExec = 0;
	delta nsec = 0; ///< [ns]

	/// Time of the system's steady clock [ns]; 0 while timing is switched off (`O.timingEnabled`).
	static delta getNow(bool evenIfDisabled = false)
	{
		if (!enabled && !evenIfDisabled) return 0;
		timespec now;
		clock_gettime(CLOCK_MONOTONIC, &now);
		return static_cast<delta>(now.tv_sec) * 1000000000ull + static_cast<delta>(now.tv_nsec);
	}
	static bool enabled;
};

/// Times of the parts of an engine's step, shown by `yade.timing.stats()`. `start()` once a step, then `checkpoint("name")` after each part.
class TimingDeltas {
	TimingInfo::delta last = 0;
	size_t next = 0;

public:
	vector<TimingInfo> data;
	vector<string> labels;

	void start()
	{
		if (!TimingInfo::enabled) return;
		next = 0;
		last = TimingInfo::getNow();
	}
	void checkpoint(const string& label);
	void reset()
	{
		data.clear();
		labels.clear();
	}
};

} // namespace yade
