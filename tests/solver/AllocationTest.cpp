// SPDX-License-Identifier: GPL-2.0-or-later
// A warm solver allocates nothing. This file replaces the global operator new of the test program by one that counts.
#include "Scenes.hpp"
#include "pkg/solver/SignoriniCoulombSolver.hpp"

#include <atomic>
#include <cstdlib>
#include <gtest/gtest.h>
#include <new>

namespace {
std::atomic<long> allocations{0};

void* counted(std::size_t size, std::size_t alignment)
{
	++allocations;
	void* memory = alignment > alignof(std::max_align_t) ? std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)
														 : std::malloc(size > 0 ? size : 1);
	if (!memory) throw std::bad_alloc();
	return memory;
}
} // namespace

void* operator new(std::size_t size) { return counted(size, 1); }
void* operator new[](std::size_t size) { return counted(size, 1); }
void* operator new(std::size_t size, std::align_val_t alignment) { return counted(size, std::size_t(alignment)); }
void* operator new[](std::size_t size, std::align_val_t alignment) { return counted(size, std::size_t(alignment)); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

using namespace contactdynamics;

TEST(Allocation, NoneInASolveOnceWarm)
{
	// Cold heaps of 1000 spheres, so that contacts wake and fall asleep; friction 0.5 settles hot spots, friction 1 with rolling calls the rival;
	// general contacts; two threads; rolling friction.
	struct Case {
		double friction;
		bool general;
		int threads;
		bool rolls;
		int moreSweepsThan;
	};
	for (const Case& one : {Case{0.3, false, 1, false, 20}, Case{0.5, false, 1, false, 200}, Case{0.3, true, 1, false, 20},
							Case{0.3, false, 2, false, 20}, Case{0.3, false, 1, true, 20}, Case{1, true, 1, true, 900}}) {
		GrainProblem given = scenes::heap(one.threads > 1 ? 12 : 8, 7, one.friction, false, one.general);
		if (one.rolls) scenes::addRollingFriction(given, 0.05);
		GrainProblem problem = given;
		SolverOptions options;
		options.threads = one.threads;
		SignoriniCoulombSolver solver;
		solver.solve(problem, options);
		problem = given; // into memory it has already
		const long before = allocations;
		const SolveReport report = solver.solve(problem, options);
		EXPECT_EQ(allocations - before, 0) << "friction " << one.friction << ", " << one.threads << " threads";
		EXPECT_EQ(report.newtonSteps, 0); // they do allocate
		EXPECT_GT(report.iterations, one.moreSweepsThan);
		ASSERT_GT(before, 0); // the counter is at work
	}
}
