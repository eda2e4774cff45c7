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
constexpr double ofTolerance = 0.3; // what each part may keep of the residual; less with many parts: up to twice the sweeps
constexpr int mostNewtonSteps = 10; // where it works at all it takes three to five
constexpr std::size_t mostContactsOfNewton = 100;
constexpr double newtonPerSweeps =
		5; // cost of all Newton steps of a solve over that of its sweeps, at most; with 2 one step in 200 was missed for it
constexpr double visitsPerSquare = 7; // a Newton step for n contacts takes as long as 7 n^2 visits: 60 us for 24, 0.3 ms for 64

} // namespace

void HotSpotSolver::start()
{
	spot.room = HotSpot::mostContacts;
	spot.bodyOf.clear(); // whichever way the last solve was left
	bodyOf.clear();
	newtonSpent = 0;
}

HotSpotSolver::Outcome HotSpotSolver::settle(GrainOperator& op, const Terms& terms, Crew& crew)
{
	Outcome outcome;
	if (!op.takeHotSpot(spot)) return outcome;
	divide();
	bool all = true;
	for (int k = 0; k < parts; ++k) {
		take(members[k]);
		double impulse2 = 0;
		for (const std::int32_t i : members[k]) impulse2 += spot.impulse2[i];
		const double own = impulse2 > 0 ? ofTolerance * terms.tolerance * std::sqrt(op.impulse2() / impulse2) : ofTolerance;
		if (!solve(std::min(own, ofTolerance), terms, crew, outcome)) {
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
	bodiesOfPart.clear();
	bodyOf.resize(spot.problem.bodies.size(), -1);
	const auto bodyAt = [&](std::int32_t of) {
		if (bodyOf[of] < 0) {
			bodyOf[of] = std::int32_t(part.bodies.size());
			bodiesOfPart.push_back(of);
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
	for (const std::int32_t body : bodiesOfPart) bodyOf[body] = -1;
}

/// By sweeps, or else by Newton steps. Impulses that leave contacts closing are not taken: where there is no solution, any relative tolerance is met
/// by impulses that are large enough, which Newton's method finds at once, and the guard of the whole collection must not be handed such impulses.
bool HotSpotSolver::solve(double tolerance, const Terms& terms, Crew& crew, Outcome& outcome)
{
	const double share = double(part.contacts.size()) / double(spot.awake);
	SolverOptions options;
	options.tolerance = tolerance;
	options.maxIterations = int(std::min<double>(mostSweeps, (terms.sweepsLeft - outcome.sweeps) / share));
	if (options.maxIterations < 1) return false;
	operatorOfPart.start(part, true, crew);
	const LoopResult result = signoriniCoulombLoop(operatorOfPart, options);
	outcome.sweeps += result.iterations * share;
	if (!std::isfinite(result.residual)) return false;
	SolveReport report;
	operatorOfPart.finish(report);
	if (result.residual > tolerance) return solveByNewton(tolerance, terms, outcome);
	return result.residual == 0 || operatorOfPart.approachLeft() < Squeeze::leastApproach;
}

/// From where the sweeps have ended.
bool HotSpotSolver::solveByNewton(double tolerance, const Terms& terms, Outcome& outcome)
{
	const double contacts = double(part.contacts.size()), price = visitsPerSquare * contacts * contacts / double(spot.awake);
	const int most = int(std::min<double>(mostNewtonSteps, (newtonPerSweeps * terms.sweepsDone - newtonSpent) / price));
	if (part.contacts.size() > mostContactsOfNewton || most < 1) return false;
	frames.clear();
	for (const Contact& c : part.contacts) frames.push_back(contactFrame(c.normal));
	BlockProblem problem = assembled(part, frames);
	BlockOperator<3> blocks(problem, Measure::naturalMap);
	CertifiedPoint<3> best{blocks.certificate(), {}};
	if (!std::isfinite(best.residual)) return false;
	blocks.impulses(best.impulses);
	const int steps = NewtonFinish<3>(problem, blocks).improve(best, tolerance, most);
	outcome.newtonSteps += steps;
	outcome.newtonCost += steps * price;
	newtonSpent += steps * price;
	if (best.residual > tolerance) return false;
	blocks.setImpulses(best.impulses);
	if (blocks.approachLeft() >= Squeeze::leastApproach) return false;
	for (std::size_t i = 0; i < frames.size(); ++i) part.contacts[i].impulse = frames[i].transpose() * best.impulses[i];
	return true;
}

} // namespace contactdynamics
