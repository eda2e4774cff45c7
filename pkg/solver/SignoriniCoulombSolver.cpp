// SPDX-License-Identifier: GPL-2.0-or-later
#include "SignoriniCoulombSolver.hpp"

#include "GrainOperator.hpp"
#include "GrainSqueeze.hpp"
#include "GuardedLoop.hpp"
#include "HotSpotSolver.hpp"

#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

namespace contactdynamics {

struct SignoriniCoulombSolver::Workspace {
	GrainOperator grains, rival;
	HotSpotSolver spots;
	GrainSqueeze squeeze;
	ImpulseSet added;
	std::optional<Crew> crew;

	/// Kept while the number of threads stays the same, also over small problems in between.
	Crew& crewFor(const GrainProblem& problem, int threads)
	{
		if (!GrainOperator::isWorthThreads(problem.contacts.size())) threads = crew ? crew->threads() : 1;
		if (!crew || crew->threads() != threads) crew.emplace(threads);
		return *crew;
	}
	bool runsAway(const GrainOperator& winner, const GrainProblem& solved, const SolverOptions& options, int done);
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
		if (const double least = std::min(c.normalCompliance, c.tangentialCompliance); least < 0)
			refuse(problem, i, "a compliance is " + std::to_string(least) + ", must be >= 0");
		if (std::abs(c.normal.squaredNorm() - 1) > 1e-9)
			refuse(problem, i, "the normal has length " + std::to_string(c.normal.norm()) + ", must be 1");
	}
}

void requireRolling(const GrainProblem& problem)
{
	std::int32_t last = -1;
	for (const RollingFriction& one : problem.rolling) {
		if (one.contact <= last || one.contact >= std::int32_t(problem.contacts.size()))
			throw std::invalid_argument("GrainProblem::rolling refers to contact " + std::to_string(one.contact) + " after " + std::to_string(last) +
										"; each of the " + std::to_string(problem.contacts.size()) + " contacts may stand there once, in order");
		last = one.contact;
		if (const double least = std::min(one.rollingArm, one.twistingArm); least < 0)
			refuse(problem, std::size_t(one.contact), "an arm of rolling friction is " + std::to_string(least) + ", must be >= 0");
	}
}

void requireField(const GrainProblem& problem)
{
	if (!problem.meanField) return;
	const MeanField& field = *problem.meanField;
	if (const double least = field.inverseMass.minCoeff(); least < 0)
		throw std::invalid_argument("MeanField::inverseMass has the negative component " + std::to_string(least) + ", must be >= 0");
	if (field.inverseMass != field.inverseMass.transpose()) throw std::invalid_argument("MeanField::inverseMass is not symmetric");
	if (!(field.limit > 0)) throw std::invalid_argument("MeanField::limit is " + std::to_string(field.limit) + ", must be > 0");
}

/// Mates are awake during a solve, whichever way it is left.
class AtWork {
public:
	explicit AtWork(Crew& its) : crew(its) { crew.resume(); }
	~AtWork() { crew.rest(); }
	AtWork(const AtWork&) = delete;
	AtWork& operator=(const AtWork&) = delete;

private:
	Crew& crew;
};

bool isFinite(const GrainProblem& problem)
{
	double poison = 0; // zero times a finite number is zero, times anything else not a number
	for (const Body& b : problem.bodies)
		poison += 0 * (b.velocity.sum() + b.angularVelocity.sum() + b.inverseMass.sum() + b.inverseInertia.sum()) + (0 * b.centre).sum();
	if (problem.meanField) poison += 0 * (problem.meanField->gradient.sum() + problem.meanField->inverseMass.sum());
	for (const Contact& c : problem.contacts)
		poison += 0 * (c.normal.sum() + c.arm1.sum() + c.arm2.sum() + c.imageVelocity.sum() + c.impulse.sum() + c.friction + c.gapVelocity +
					   c.normalCompliance + c.tangentialCompliance);
	for (const RollingFriction& one : problem.rolling) poison += 0 * (one.rollingArm + one.twistingArm + one.drive.sum() + one.torque.sum());
	return poison == 0;
}

/// Plain sweeps carry a load from grain to grain: they take as many as the square of the grains in a row, N^(2/3), times something. Twenty-four makes
/// a lead of 1900 for 729 grains: of 777 stored steps, each solved five times, none then takes more than 2.1 times the plain sweeps. With thirty two
/// take 2.15 and 2.26 times, with twelve the sums are larger by a fifth (doc/grains.rst). Earlier after a cold start, at the first stall: nothing
/// gained on 166 heaps of 64 to 216.
int leadOfMomentum(std::size_t movingBodies)
{
	const double inARow = std::cbrt(static_cast<double>(movingBodies));
	return static_cast<int>(24 * inARow * inARow);
}

} // namespace

/// Whether the impulses of a solution grow without bound when the sweeps go on from there, see Squeeze.hpp.
bool SignoriniCoulombSolver::Workspace::runsAway(const GrainOperator& winner, const GrainProblem& solved, const SolverOptions& options, int done)
{
	const auto factor = [&] { return squeeze.factor(solved, added); };
	winner.lastIncrements(added);
	if (factor() < Squeeze::suspected) {
		if (done >= Squeeze::sweepsToBalance) return false;
		added.take(solved); // what few sweeps add is not in balance yet, but what earlier steps have left may be
		if (factor() < Squeeze::suspected) return false;
	}
	GrainProblem further = squeeze.from(solved);
	rival.start(further, options.acceleration != Acceleration::none, *crew);
	signoriniCoulombLoop(rival, Squeeze::further(options, done));
	SolveReport report;
	rival.finish(report);
	added.take(further);
	added.subtract(solved);
	return squeeze.factor(further, added) >= GrainSqueeze::certain;
}

SolveReport SignoriniCoulombSolver::solve(GrainProblem& problem, const SolverOptions& options)
{
	requireOptions(options);
	requireContacts(problem);
	requireRolling(problem);
	requireField(problem);
	SolveReport report;
	report.status = SolveStatus::notFinite;
	if (!isFinite(problem)) return report;

	GrainOperator &grains = workspace->grains, &rival = workspace->rival;
	Crew& crew = workspace->crewFor(problem, options.threads);
	const AtWork work(crew);
	grains.start(problem, options.acceleration != Acceleration::none, crew);
	const auto makeRival = [&]() -> GrainOperator& {
		rival.start(problem, false, crew);
		return rival;
	};
	workspace->spots.start();
	const auto settle = [&](GrainOperator& op, int sweepsLeft, int sweepsDone) {
		const HotSpotSolver::Outcome outcome = workspace->spots.settle(op, {options.tolerance, sweepsLeft, sweepsDone}, crew);
		report.newtonSteps += outcome.newtonSteps;
		return outcome;
	};
	const GuardedResult result = guardedLoop(grains, options, leadOfMomentum(grains.movingBodies()), makeRival, settle);
	report.iterations = result.iterations;
	report.residual = result.residual;
	if (!std::isfinite(result.residual)) return report;
	GrainOperator& winner = result.byRival ? rival : grains;
	const bool converged = result.residual <= options.tolerance;
	report.status = converged ? SolveStatus::converged : SolveStatus::maxIterations;
	const bool doubtful = converged && winner.approachLeft() >= Squeeze::leastApproach && !GrainSqueeze::mayStandStill(problem);
	if (doubtful) workspace->squeeze.keepFree(problem);
	winner.finish(report);
	if (doubtful && workspace->runsAway(winner, problem, options, result.iterations)) report.status = SolveStatus::unbounded;
	return report;
}

} // namespace contactdynamics
