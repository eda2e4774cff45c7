// SPDX-License-Identifier: GPL-2.0-or-later
// Built with -DCONTACTDYNAMICS_BENCHMARKS=ON as contactdynamics_sweep_benchmark.
// Nanoseconds per ball contact and sweep, and per contact for the fixed parts of a solve. Heaps of spheres from tests/solver/Scenes.hpp, mu = 0.3,
// seed 1. The counter "per_contact_sweep" is the time of a solve of 200 sweeps, set-up and certificate included, over active contacts and sweeps.
#include "pkg/solver/SignoriniCoulombSolver.hpp"
#include "tests/solver/Scenes.hpp"

#include <benchmark/benchmark.h>

using namespace contactdynamics;

namespace {

void sweep(benchmark::State& state)
{
	const GrainProblem given = scenes::heap(int(state.range(0)), 1);
	SolverOptions options;
	options.tolerance = 1e-300; // never met: every solve does all its sweeps
	options.maxIterations = 200;
	options.threads = int(state.range(1));
	SignoriniCoulombSolver solver;
	GrainProblem problem;
	SolveReport report;
	for (auto _ : state) {
		state.PauseTiming();
		problem = given;
		state.ResumeTiming();
		report = solver.solve(problem, options);
	}
	state.counters["candidates"] = double(given.contacts.size());
	state.counters["active"] = report.activeContacts;
	state.counters["residual"] = report.residual;
	const double visits = double(report.activeContacts) * report.iterations;
	state.counters["per_contact_sweep"] = benchmark::Counter(visits, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

} // namespace

BENCHMARK(sweep)->ArgNames({"side", "threads"})->ArgsProduct({{8, 14, 22}, {1, 2}})->UseRealTime()->Unit(benchmark::kMillisecond);

BENCHMARK_MAIN();
