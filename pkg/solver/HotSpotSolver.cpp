// SPDX-License-Identifier: GPL-2.0-or-later
#include "HotSpotSolver.hpp"

#include "AssembledGrains.hpp"
#include "LocalDelassus.hpp"
#include "NewtonFinish.hpp"
#include "SignoriniCoulombLoop.hpp"
#include "Squeeze.hpp"

namespace contactdynamics {

namespace {

constexpr int mostSweeps = 300;		// mostly a few dozen; those that do not end by then go round in circles, however many there are
constexpr double ofTolerance = 0.3; // what a spot may keep of the residual
constexpr int mostNewtonSteps = 10; // where it works at all it takes three to five
constexpr std::size_t mostContactsOfNewton = 100;
constexpr double visitsPerSquare = 7; // a Newton step for n contacts takes as long as 7 n^2 visits: 60 us for 24, 0.3 ms for 64

} // namespace

HotSpotSolver::Outcome HotSpotSolver::settle(GrainOperator& op, double tolerance, Crew& crew)
{
	Outcome outcome;
	if (!op.takeHotSpot(spot)) return outcome;
	divide();
	bool all = true;
	for (int k = 0; k < parts; ++k) {
		take(members[k]);
		double impulse2 = 0;
		for (const std::int32_t i : members[k]) impulse2 += spot.impulse2[i];
		const double own = impulse2 > 0 ? ofTolerance * tolerance * std::sqrt(op.impulse2() / impulse2) : ofTolerance;
		const double bound = std::min(own, ofTolerance);
		if (!sweep(bound, crew, outcome) && !solveByNewton(bound, outcome)) {
			all = false;
			continue;
		}
		for (std::size_t i = 0; i < members[k].size(); ++i) spot.problem.contacts[members[k][i]].impulse = part.contacts[i].impulse;
		outcome.settled = true;
	}
	// A smaller one where it was too hard.
	spot.room = all ? std::min(2 * spot.room, HotSpot::mostContacts) : std::max(spot.room / 2, HotSpot::fewestContacts);
	if (outcome.settled) op.putHotSpot(spot);
	return outcome;
}

/// Into parts that share no body that can move.
void HotSpotSolver::divide()
{
	const auto& bodies = spot.problem.bodies;
	groups.reset(bodies.size());
	const auto moves = [&](std::int32_t body) { return bodies[body].moves(); };
	for (const Contact& c : spot.problem.contacts)
		if (moves(c.body1) && moves(c.body2)) groups.join(c.body1, c.body2);
	parts = 0;
	for (std::size_t i = 0; i < spot.problem.contacts.size(); ++i) {
		const Contact& c = spot.problem.contacts[i];
		std::int32_t& number = groups.of(moves(c.body1) ? c.body1 : c.body2).number;
		if (number < 0) {
			number = parts++;
			if (parts > int(members.size())) members.emplace_back();
			members[number].clear();
		}
		members[number].push_back(std::int32_t(i));
	}
}

void HotSpotSolver::take(const std::vector<std::int32_t>& contacts)
{
	part.bodies.clear();
	part.contacts.clear();
	bodyOf.assign(spot.problem.bodies.size(), -1);
	const auto bodyAt = [&](std::int32_t of) {
		if (bodyOf[of] < 0) {
			bodyOf[of] = std::int32_t(part.bodies.size());
			part.bodies.push_back(spot.problem.bodies[of]);
		}
		return bodyOf[of];
	};
	for (const std::int32_t i : contacts) {
		Contact c = spot.problem.contacts[i];
		c.body1 = bodyAt(c.body1);
		c.body2 = bodyAt(c.body2);
		part.contacts.push_back(c);
	}
}

bool HotSpotSolver::sweep(double tolerance, Crew& crew, Outcome& outcome)
{
	SolverOptions options;
	options.tolerance = tolerance;
	options.maxIterations = mostSweeps;
	sweeps.start(part, true, crew);
	const LoopResult result = signoriniCoulombLoop(sweeps, options);
	outcome.sweeps += result.iterations * double(part.contacts.size()) / double(spot.awake);
	if (!std::isfinite(result.residual)) return false;
	SolveReport report;
	sweeps.finish(report);
	return result.residual <= tolerance && sweeps.approachLeft() < Squeeze::leastApproach;
}

/// From where the sweeps have ended. Where there is no solution, Newton's method meets any relative tolerance by impulses that are large enough, as
/// sweeps do in the end; contacts go on closing then, and the guard of the whole collection must not be handed such impulses.
bool HotSpotSolver::solveByNewton(double tolerance, Outcome& outcome)
{
	if (part.contacts.size() > mostContactsOfNewton) return false;
	frames.clear();
	for (const Contact& c : part.contacts) frames.push_back(contactFrame(c.normal));
	BlockProblem problem = assembled(part, frames);
	BlockOperator<3> blocks(problem, Measure::naturalMap);
	CertifiedPoint<3> best{blocks.certificate(), {}};
	if (!std::isfinite(best.residual)) return false;
	blocks.impulses(best.impulses);
	const double contacts = double(part.contacts.size());
	const int steps = NewtonFinish<3>(problem, blocks).improve(best, tolerance, mostNewtonSteps);
	outcome.newtonSteps += steps;
	outcome.newtonCost += steps * visitsPerSquare * contacts * contacts / double(spot.awake);
	if (best.residual > tolerance) return false;
	blocks.setImpulses(best.impulses);
	if (blocks.approachLeft() >= Squeeze::leastApproach) return false;
	for (std::size_t i = 0; i < frames.size(); ++i) part.contacts[i].impulse = frames[i].transpose() * best.impulses[i];
	return true;
}

} // namespace contactdynamics
