// SPDX-License-Identifier: GPL-2.0-or-later
#include "HotSpotSolver.hpp"

#include "AssembledGrains.hpp"
#include "LocalDelassus.hpp"
#include "NewtonFinish.hpp"
#include "SignoriniCoulombLoop.hpp"
#include "Squeeze.hpp"

#include <algorithm>
#include <cmath>

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
	newtonSpent = 0;
}

HotSpotSolver::Outcome HotSpotSolver::settle(GrainOperator& op, const Terms& terms, Crew& crew)
{
	Outcome outcome;
	if (!op.chooseHotSpot(spot)) return outcome;
	bool all = true;
	for (std::size_t k = 0; k < spot.parts; ++k) {
		const double impulse2 = op.takePart(spot, k, part);
		const double own = impulse2 > 0 ? ofTolerance * terms.tolerance * std::sqrt(op.impulse2() / impulse2) : ofTolerance;
		if (!solve(std::min(own, ofTolerance), terms, crew, outcome)) {
			all = false;
			continue;
		}
		op.putPart(spot, k, part);
		outcome.settled = true;
	}
	// A smaller one where it was too hard.
	spot.room = all ? std::min(2 * spot.room, HotSpot::mostContacts) : std::max(spot.room / 2, HotSpot::fewestContacts);
	return outcome;
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
