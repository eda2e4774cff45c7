// SPDX-License-Identifier: GPL-2.0-or-later
// Pours of spheres, warm-started from step to step; some of the steps are solved twice from the same start, by default and by plain Gauss-Seidel, to
// the same certificate. One thread, processor time. Prints CSV; run by accelerate.py. Usage: contactdynamics_accelerate GRAINS FRICTION HEAVY_SHARE
// STEPS EVERY [SEED]
#include "GrainBox.hpp"

#include <cstdio>
#include <cstdlib>
#include <ctime>

using namespace contactdynamics;

namespace {

double processorTime()
{
	timespec now;
	clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
	return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

struct Timed {
	SolveReport report;
	double seconds;
};

Timed timed(SignoriniCoulombSolver& solver, GrainProblem& problem, Acceleration acceleration)
{
	SolverOptions options;
	options.acceleration = acceleration;
	options.maxIterations = 20000;
	const double start = processorTime();
	const SolveReport report = solver.solve(problem, options);
	return {report, processorTime() - start};
}

} // namespace

int main(int count, char** argument)
{
	if (count < 6) {
		std::fputs("usage: contactdynamics_accelerate GRAINS FRICTION HEAVY_SHARE STEPS EVERY [SEED]\n", stderr);
		return 2;
	}
	GrainBox::Setup setup;
	setup.grains = std::atoi(argument[1]);
	setup.friction = std::atof(argument[2]);
	setup.heavyShare = std::atof(argument[3]);
	if (count > 6) setup.seed = unsigned(std::atoi(argument[6]));
	const int steps = std::atoi(argument[4]), every = std::atoi(argument[5]);

	GrainBox box(setup);
	SignoriniCoulombSolver solver, other;
	GrainProblem first, second;
	std::puts("grains,friction,heavy_share,step,contacts,active,kinetic_over_mgr,sweeps,seconds,residual,converged,plain_sweeps,plain_seconds,plain_"
			  "residual,"
			  "plain_converged");
	for (int step = 1; step <= steps; ++step) {
		first = box.next();
		second = first;
		const Timed own = timed(solver, first, Acceleration::momentum);
		if (step % every == 0) {
			const Timed plain = timed(other, second, Acceleration::none);
			std::printf("%d,%g,%g,%d,%zu,%d,%.3g,%d,%.6f,%.3g,%d,%d,%.6f,%.3g,%d\n", setup.grains, setup.friction, setup.heavyShare, step,
						first.contacts.size(), own.report.activeContacts, box.kineticEnergyPerGrain(), own.report.iterations, own.seconds,
						own.report.residual, own.report.status == SolveStatus::converged, plain.report.iterations, plain.seconds,
						plain.report.residual, plain.report.status == SolveStatus::converged);
		}
		box.advance(first);
	}
}
