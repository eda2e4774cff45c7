// SPDX-License-Identifier: GPL-2.0-or-later
// Kernels of the grain solver on dense lattices of spheres (mu = 0.3, seed 1), and the memory bandwidth of the machine beside them; run by sweep.py.
//
//     triad        a = b + s c over arrays of 256 MB in all: bytes per second, 24 a number, as STREAM counts them
//     sweep        one sweep with momentum over all contacts
//     certificate  residual with fresh velocities
//     start        everything before the first sweep: colouring, layout, start impulses
//     general...   the same of grains that are no balls: arms off the normal, three different moments of inertia
#include "GrainBox.hpp"
#include "pkg/solver/GrainOperator.hpp"

#include <Eigen/Geometry>
#include <benchmark/benchmark.h>
#include <random>

using namespace contactdynamics;

namespace {

/// Grains are no balls any more: seed 1.
void makeGeneral(GrainProblem& problem)
{
	std::mt19937_64 random(1);
	std::normal_distribution<double> normal;
	const auto vector = [&] { return Vector3(normal(random), normal(random), normal(random)); };
	for (Body& body : problem.bodies) {
		const Matrix3 turn = Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random)).normalized().toRotationMatrix();
		body.inverseInertia = turn * (body.inverseInertia * Eigen::DiagonalMatrix<double, 3>(0.5, 1, 1.5)) * turn.transpose();
	}
	for (Contact& c : problem.contacts) {
		c.ball = false;
		c.arm1 += 0.3 * GrainBox::radius * vector();
		c.arm2 += 0.3 * GrainBox::radius * vector();
	}
}

/// The lattice for about so many contacts; three to a grain. Made once for all kernels.
GrainProblem& lattice(std::int64_t contacts, bool general)
{
	static std::int64_t madeFor = 0;
	static bool isGeneral = false;
	static GrainProblem problem;
	if (madeFor != contacts || isGeneral != general) {
		GrainBox::Setup setup;
		setup.grains = int(contacts / 3);
		setup.pitch = 1.6;
		problem = GrainBox(setup).next();
		if (general) makeGeneral(problem);
		madeFor = contacts;
		isGeneral = general;
	}
	return problem;
}

void triad(benchmark::State& state)
{
	constexpr std::size_t count = 256'000'000 / 24, parts = 64;
	std::vector<double> a(count), b(count, 1), c(count, 2);
	Crew crew(int(state.range(0))); // threads of the kernels, too: new ones would not be spread over the cores in time
	crew.resume();
	for (auto _ : state) {
		crew.run(parts, [&](std::size_t k) {
			for (std::size_t i = k * count / parts; i < (k + 1) * count / parts; ++i) a[i] = b[i] + 3 * c[i];
		});
		benchmark::ClobberMemory();
	}
	state.counters["bytes"] = 24.0 * double(count);
}

template <bool general> class Kernel {
public:
	explicit Kernel(const benchmark::State& state) : problem(lattice(state.range(0), general)), crew(int(state.range(1)))
	{
		crew.resume();
		start();
	}
	void start() { grains.start(problem, true, crew); }

	/// Bytes that cross the border of the caches in a sweep at least: every pack is read and three of its vectors written, every body read and
	/// written in three arrays (velocity, velocity at the start of the sweep, direction), and for general contacts read in a fourth.
	void count(benchmark::State& state) const
	{
		const double contacts = double(grains.awakeContacts()), bodies = double(problem.bodies.size());
		const double pack = general ? sizeof(GeneralPack) : sizeof(BallPack), body = 6 * sizeof(BodyState) + (general ? sizeof(BodyMobility) : 0);
		state.counters["contacts"] = contacts;
		state.counters["bytes"] = contacts * (pack + 9 * packLanes * sizeof(double)) / packLanes + bodies * body;
		state.counters["per_contact"] = benchmark::Counter(contacts, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
	}

	GrainProblem& problem;
	Crew crew;
	GrainOperator grains;
};

template <bool general> void sweep(benchmark::State& state)
{
	Kernel<general> kernel(state);
	for (auto _ : state) kernel.grains.sweep({0.3, 0.2});
	kernel.count(state);
	state.counters["residual"] = kernel.grains.certificate();
}

template <bool general> void certificate(benchmark::State& state)
{
	Kernel<general> kernel(state);
	for (int i = 0; i < 5; ++i) kernel.grains.sweep({});
	double residual = 0;
	for (auto _ : state) residual = kernel.grains.certificate();
	kernel.count(state);
	state.counters["residual"] = residual;
}

template <bool general> void start(benchmark::State& state)
{
	Kernel<general> kernel(state);
	for (auto _ : state) kernel.start();
	kernel.count(state);
	state.counters["residual"] = kernel.grains.certificate();
}

const std::vector<std::int64_t> sizes{1000, 10000, 100000, 1000000}, threads{1, 2};

void bySizeAndThreads(benchmark::internal::Benchmark* kernel)
{
	kernel->ArgNames({"contacts", "threads"})->ArgsProduct({sizes, threads})->UseRealTime()->MeasureProcessCPUTime();
}

} // namespace

BENCHMARK(triad)->ArgNames({"threads"})->ArgsProduct({threads})->UseRealTime()->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(sweep, false)->Name("sweep")->Apply(bySizeAndThreads);
BENCHMARK_TEMPLATE(certificate, false)->Name("certificate")->Apply(bySizeAndThreads);
BENCHMARK_TEMPLATE(start, false)->Name("start")->Apply(bySizeAndThreads);
BENCHMARK_TEMPLATE(sweep, true)->Name("generalSweep")->Apply(bySizeAndThreads);
BENCHMARK_TEMPLATE(certificate, true)->Name("generalCertificate")->Apply(bySizeAndThreads);
BENCHMARK_TEMPLATE(start, true)->Name("generalStart")->Apply(bySizeAndThreads);

BENCHMARK_MAIN();
