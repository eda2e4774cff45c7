// SPDX-License-Identifier: GPL-2.0-or-later
// How far the problem of a step is solved.
#include "ContactDynamicsStep.hpp"
#include <algorithm>
#include <limits>
#include <omp.h>

namespace yade {

/// Whether the bodies have less energy than the forces on them would give them in one step from rest.
bool ContactDynamicsStep::standsStill() const
{
	const auto energy = [](const contactdynamics::Body& body, const Vector3r& velocity, const Vector3r& angularVelocity) {
		Real sum = 0;
		for (int k = 0; k < 3; k++)
			if (body.inverseMass[k] > 0) sum += velocity[k] * velocity[k] / body.inverseMass[k];
		const Real turning = body.inverseInertia.trace() / 3; // the mean will do
		return turning > 0 ? sum + angularVelocity.squaredNorm() / turning : sum;
	};
	Real now = 0, pushed = 0;
	for (std::size_t i = 0; i < motions.size(); i++) {
		const Twist start = atStart(static_cast<int>(i));
		now += energy(problem.bodies[i], start.velocity, start.angularVelocity);
		pushed += energy(problem.bodies[i], motions[i].velocity - start.velocity, motions[i].angularVelocity - start.angularVelocity);
	}
	return now <= pushed;
}

/// Share of the velocities at rest that the places do not determine: a gap is a difference of coordinates with their round-off, and enters as the
/// velocity gap / h. Impulses better than that would have to be found anew in each step. A tenth of it, because the residual is relative to all
/// impulses: in a stack of 20 cubes 30 sweeps a step then leave 2e-9 m/s at the top (all of it: 15 and 2e-8; none: 135 and 3e-11).
Real ContactDynamicsStep::roundOffAtRest() const
{
	Real farthest = 0, pushed = 0;
	for (std::size_t i = 0; i < motions.size(); i++) {
		farthest = std::max(farthest, views[idOfIndex[i]].state->pos.cwiseAbs().maxCoeff());
		pushed = std::max(pushed, (motions[i].velocity - atStart(static_cast<int>(i)).velocity).norm());
	}
	return pushed > 0 ? 0.1 * std::numeric_limits<Real>::epsilon() * farthest / (h * pushed) : 0;
}

/// Blocks that stand still should go on standing still. What a residual leaves of velocity, the next step has to take away: just below the tolerance
/// a stack of blocks would sway for ever, whatever the tolerance is, because solving on is what damps its sway. So impulses are improved to
/// round-off, as far as a limited number of sweeps a step allows; once they are right, they stay so, and the next steps need one or two sweeps.
contactdynamics::SolveReport ContactDynamicsStep::solveAtRest(const contactdynamics::SolverOptions& options)
{
	constexpr int sweeps = 200;
	constexpr Real best = 1e-12; // beyond lies the round-off of the sums in the solver
	freeBodies = problem.bodies;
	freeField = problem.meanField;
	contactdynamics::SolverOptions careful = options;
	careful.tolerance = std::min(options.tolerance, std::max(best, roundOffAtRest()));
	careful.maxIterations = std::min(options.maxIterations, sweeps);
	auto report = solver.solve(problem, careful);
	if (report.status != contactdynamics::SolveStatus::maxIterations) return report;
	if (report.residual <= options.tolerance) {
		report.status = contactdynamics::SolveStatus::converged;
		return report;
	}
	problem.bodies = freeBodies;
	problem.meanField = freeField;
	contactdynamics::SolverOptions rest = options;
	rest.maxIterations = options.maxIterations - report.iterations;
	if (rest.maxIterations < 1) return report;
	const auto before = report;
	report = solver.solve(problem, rest);
	report.iterations += before.iterations;
	report.newtonSteps += before.newtonSteps;
	return report;
}

contactdynamics::SolveReport ContactDynamicsStep::solve(Real allowedResidual, int maxIterations, bool accelerated)
{
	tolerance = allowedResidual;
	contactdynamics::SolverOptions options;
	options.tolerance = tolerance;
	options.maxIterations = maxIterations;
	if (!accelerated) options.acceleration = contactdynamics::Acceleration::none;
	options.threads = omp_get_max_threads();
	if (problem.meanField) toMeanField();
	const auto report = !manifolds.empty() && standsStill() ? solveAtRest(options) : solver.solve(problem, options);
	if (problem.meanField) fromMeanField();
	solved = report.status != contactdynamics::SolveStatus::notFinite;
	return report;
}

} // namespace yade
