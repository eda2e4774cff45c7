// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <exception>
#include <vector>

namespace yade {

/// `work(i)` for i = 0 … count−1 on all OpenMP threads. An exception must not leave an OpenMP loop; the one of the smallest i is thrown
/// afterwards, so that the thread count does not decide which error the user sees. A short loop stays on one thread: waking the others
/// costs as much as a few hundred bodies or contacts.
template <class Work> void parallelLoop(long count, const Work& work)
{
	long firstFailed = count;
	std::exception_ptr error;
#pragma omp parallel for schedule(static) if (count > 500)
	for (long i = 0; i < count; i++) {
		try {
			work(i);
		} catch (...) {
#pragma omp critical(contactdynamics_parallelLoop)
			if (i < firstFailed) {
				firstFailed = i;
				error = std::current_exception();
			}
		}
	}
	if (error) std::rethrow_exception(error);
}

} // namespace yade
