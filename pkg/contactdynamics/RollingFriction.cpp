// SPDX-License-Identifier: GPL-2.0-or-later
#include "RollingFriction.hpp"
#include "ContactDynamicsPhys.hpp"
#include <algorithm>
#include <cmath>

namespace yade {
namespace {
/// A ball at rest on a slope gains 5/7 in accuracy per pass from a cold start, which is 28 passes to 1e-4; the warm start makes it a few.
constexpr int mostPasses = 100;
} // namespace

void RollingFriction::add(int contact, ContactDynamicsPhys& phys, bool swapped, Real warmStart, const Vector3r& drive)
{
	rows.push_back({contact, &phys, swapped, (swapped ? -warmStart : warmStart) * phys.torqueImpulse, drive});
}

/// One sweep over the rows with the velocities and normal impulses of the problem. @return change of the torques over the largest ones that the
/// contacts bear, both weighted by W. Not over the torques themselves: those of a ball that has just stopped vanish, by 2/7 a pass for ever.
Real RollingFriction::improve(const contactdynamics::GrainProblem& problem)
{
	spin.resize(problem.bodies.size());
	for (std::size_t i = 0; i < spin.size(); i++) spin[i] = problem.bodies[i].angularVelocity;
	improved.resize(rows.size());
	Real change = 0, size = 0;
	for (std::size_t i = 0; i < rows.size(); i++) {
		const Row& row = rows[i];
		const auto& contact = problem.contacts[row.contact];
		const Matrix3r &inverse1 = problem.bodies[contact.body1].inverseInertia, &inverse2 = problem.bodies[contact.body2].inverseInertia;
		const Matrix3r W = inverse1 + inverse2;
		const Real largest = W.cwiseAbs().rowwise().sum().maxCoeff(); // at least the largest eigenvalue; equal to it for balls
		improved[i] = row.impulse;
		if (!(largest > 0)) continue;
		const Vector3r& n = contact.normal;
		const Real normal = std::max(Real(0), contact.impulse.dot(n));
		const Vector3r trial = row.impulse - (spin[contact.body2] - spin[contact.body1] + row.drive) / largest;
		const Real twist = std::min(std::max(trial.dot(n), -row.phys->twistingArm * normal), row.phys->twistingArm * normal);
		Vector3r rolling = trial - trial.dot(n) * n;
		const Real limit = row.phys->rollingArm * normal, length = rolling.norm();
		if (length > limit) rolling *= limit / length;
		improved[i] = rolling + twist * n;
		const Vector3r delta = improved[i] - row.impulse;
		spin[contact.body1] -= inverse1 * delta;
		spin[contact.body2] += inverse2 * delta;
		change += delta.dot(W * delta);
		const Real most = std::max(row.phys->rollingArm, row.phys->twistingArm) * normal;
		size += largest * most * most;
	}
	return change > 0 ? std::sqrt(change / std::max(size, std::numeric_limits<Real>::min())) : 0;
}

contactdynamics::SolveReport RollingFriction::solve(contactdynamics::SignoriniCoulombSolver& solver, contactdynamics::GrainProblem& problem,
													const contactdynamics::SolverOptions& options)
{
	free = problem.bodies;
	freeField = problem.meanField;
	int iterations = 0;
	for (int pass = 1;; pass++) {
		problem.bodies = free;
		problem.meanField = freeField;
		for (const Row& row : rows) {
			const auto& contact = problem.contacts[row.contact];
			auto &one = problem.bodies[contact.body1], &two = problem.bodies[contact.body2];
			one.angularVelocity -= one.inverseInertia * row.impulse;
			two.angularVelocity += two.inverseInertia * row.impulse;
		}
		contactdynamics::SolverOptions left = options;
		left.maxIterations -= iterations;
		auto report = solver.solve(problem, left);
		report.iterations = iterations += report.iterations;
		if (report.status == contactdynamics::SolveStatus::notFinite) return report;
		const Real change = improve(problem);
		if (!(change > options.tolerance)) return report; // the torques applied are those of the velocities; what improve() found is not needed
		if (pass == mostPasses || iterations >= options.maxIterations) {
			report.residual = std::max(report.residual, change);
			report.status = contactdynamics::SolveStatus::maxIterations;
			return report;
		}
		for (std::size_t i = 0; i < rows.size(); i++) rows[i].impulse = improved[i];
	}
}

void RollingFriction::remember() const
{
	for (const Row& row : rows) row.phys->torqueImpulse = row.swapped ? Vector3r(-row.impulse) : row.impulse;
}

} // namespace yade
