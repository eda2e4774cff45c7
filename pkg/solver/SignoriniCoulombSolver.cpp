// SPDX-License-Identifier: GPL-2.0-or-later
#include "SignoriniCoulombSolver.hpp"

#include "GrainOperator.hpp"
#include "SignoriniCoulombLoop.hpp"

#include <stdexcept>
#include <string>

namespace contactdynamics {

struct SignoriniCoulombSolver::Workspace {
	GrainOperator grains, rival;
};

SignoriniCoulombSolver::SignoriniCoulombSolver() : workspace(std::make_unique<Workspace>()) {}
SignoriniCoulombSolver::~SignoriniCoulombSolver() = default;

namespace {

[[noreturn]] void refuse(const GrainProblem& problem, std::size_t i, const std::string& what)
{
	const Contact& c = problem.contacts[i];
	throw std::invalid_argument("contact " + std::to_string(i) + " between bodies " + std::to_string(c.body1) + " and " + std::to_string(c.body2) +
								": " + what);
}

void requireContacts(const GrainProblem& problem)
{
	const auto count = std::int32_t(problem.bodies.size());
	for (std::size_t i = 0; i < problem.contacts.size(); ++i) {
		const Contact& c = problem.contacts[i];
		if (c.body1 < 0 || c.body1 >= count || c.body2 < 0 || c.body2 >= count)
			refuse(problem, i, "body index outside the " + std::to_string(count) + " bodies");
		if (c.body1 == c.body2) refuse(problem, i, "a body cannot touch itself");
		if (c.friction < 0) refuse(problem, i, "friction is " + std::to_string(c.friction) + ", must be >= 0");
		if (c.normalCompliance < 0 || c.tangentialCompliance < 0) refuse(problem, i, "a compliance is negative, must be >= 0");
		if (std::abs(c.normal.squaredNorm() - 1) > 1e-9)
			refuse(problem, i, "the normal has length " + std::to_string(c.normal.norm()) + ", must be 1");
	}
}

void requireField(const GrainProblem& problem)
{
	if (!problem.meanField) return;
	const MeanField& field = *problem.meanField;
	if (field.inverseMass.minCoeff() < 0) throw std::invalid_argument("MeanField::inverseMass has a negative component, must be >= 0");
	if (field.inverseMass != field.inverseMass.transpose()) throw std::invalid_argument("MeanField::inverseMass is not symmetric");
	if (!(field.limit > 0)) throw std::invalid_argument("MeanField::limit is " + std::to_string(field.limit) + ", must be > 0");
}

bool isFinite(const GrainProblem& problem)
{
	double poison = 0; // zero times a finite number is zero, times anything else not a number
	for (const Body& b : problem.bodies) poison += 0 * (b.velocity.sum() + b.angularVelocity.sum() + b.inverseMass.sum() + b.inverseInertia.sum());
	if (problem.meanField) poison += 0 * (problem.meanField->gradient.sum() + problem.meanField->inverseMass.sum());
	for (const Contact& c : problem.contacts)
		poison += 0 * (c.normal.sum() + c.arm1.sum() + c.arm2.sum() + c.imageVelocity.sum() + c.impulse.sum() + c.friction + c.gapVelocity +
					   c.normalCompliance + c.tangentialCompliance);
	return poison == 0;
}

} // namespace

SolveReport SignoriniCoulombSolver::solve(GrainProblem& problem, const SolverOptions& options)
{
	requireOptions(options);
	requireContacts(problem);
	requireField(problem);
	SolveReport report;
	report.status = SolveStatus::notFinite;
	if (!isFinite(problem)) return report;

	GrainOperator &grains = workspace->grains, &rival = workspace->rival;
	grains.start(problem, options.acceleration != Acceleration::none, options.threads);
	const LoopResult result = signoriniCoulombLoop(grains, options, [&] {
		rival.start(problem, false, options.threads);
		return &rival;
	});
	report.iterations = result.iterations;
	report.residual = result.residual;
	if (!std::isfinite(result.residual)) return report;
	(result.byRival ? rival : grains).finish(report);
	grains.dismissCrew();
	rival.dismissCrew();
	report.status = result.residual <= options.tolerance ? SolveStatus::converged : SolveStatus::maxIterations;
	return report;
}

} // namespace contactdynamics
