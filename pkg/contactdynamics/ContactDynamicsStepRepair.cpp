// SPDX-License-Identifier: GPL-2.0-or-later
// Penetration repair of a step: bodies are displaced before NewtonIntegrator moves them by h v.
#include "BodySize.hpp"
#include "ContactDynamicsPhys.hpp"
#include "ContactDynamicsStep.hpp"
#include "ContactEnergy.hpp"
#include "Prefetch.hpp"
#include <core/Clump.hpp>
#include <core/Scene.hpp>
#include <algorithm>
#include <limits>
#include <pkg/solver/LocalDelassus.hpp>
#include <pkg/solver/RoomToGrow.hpp>

namespace yade {
namespace {
/// The deepest overlap shrinks by this in a step, in sizes, and all others in proportion ...
constexpr Real gentleStep = 1e-4;
/// ... but at least by this share, which makes a hundredth of any overlap in 770 steps.
constexpr Real leastShare = 6e-3;
/// Overlap of a point up to which the loaded points of the same pair stay closed, in sizes.
constexpr Real bearable = 1e-3;

/// Of two lengths, 0 where one is not known [m].
Real smallerKnown(Real one, Real two) { return one > 0 && two > 0 ? std::min(one, two) : std::max(one, two); }
} // namespace

/// What an overlap is measured against: the radius of the smaller sphere, the shorter lever arm where there is none.
Real ContactDynamicsStep::sizeOf(std::size_t i) const
{
	const Real radius = smallerKnown(views[links[i].id1].radius, views[links[i].id2].radius);
	return radius > 0 ? radius : smallerKnown(problem.contacts[i].arm1.norm(), problem.contacts[i].arm2.norm());
}

/// The larger one of the gaps at the start and at the end of the step. The overlap of a compliant contact is its deformation, which carries its
/// force: it has no gap to repair.
Real ContactDynamicsStep::gapAfterMotion(std::size_t i) const
{
	const contactdynamics::Contact& contact = problem.contacts[i];
	return contact.normalCompliance > 0 ? 0 : links[i].gap + std::max(Real(0), h * contact.normal.dot(contact.relativeVelocity));
}

/// A translation moves all points of a pair alike. To part the deepest one would open the others: where they carry an impulse, the bodies would have
/// to turn to close them again, in the next step, by a velocity, for as long as the repair goes on; a heap of blocks would never stand still. So the
/// shallowest loaded point decides, which is deep as well where a whole face overlaps, unless another one is too deep to be left alone.
Real ContactDynamicsStep::gapToRepair(const TouchingPair& pair) const
{
	if (pair.last - pair.first == 1 || !pair.loaded || pair.deepest < -bearable * pair.size) return pair.deepest;
	Real shallowest = pair.deepest;
	for (std::size_t i = pair.first; i < pair.last; i++)
		if (problem.contacts[i].impulse != Vector3r::Zero()) shallowest = std::max(shallowest, std::min(Real(0), gapAfterMotion(i)));
	return shallowest;
}

ContactDynamicsStep::TouchingPair ContactDynamicsStep::pairFrom(std::size_t first) const
{
	TouchingPair pair{first, first, false, 0, std::numeric_limits<Real>::infinity(), std::numeric_limits<Real>::infinity()};
	for (; pair.last < links.size() && links[pair.last].interaction == links[first].interaction; pair.last++) {
		pair.loaded = pair.loaded || problem.contacts[pair.last].impulse != Vector3r::Zero();
		pair.deepest = std::min(pair.deepest, gapAfterMotion(pair.last));
		pair.size = std::min(pair.size, sizeOf(pair.last));
	}
	pair.gap = gapToRepair(pair);
	return pair;
}

/// The size of the pair is quick to have, but a lever arm says little about the bodies: their thickness decides.
void ContactDynamicsStep::noteOverlap(const Scene& scene, const TouchingPair& pair)
{
	constexpr Real worthALook = 1e-2;
	for (std::size_t i = pair.first; i < pair.last; i++) {
		const contactdynamics::Contact& contact = problem.contacts[i];
		const Real depth = -(links[i].gap + h * contact.normal.dot(contact.relativeVelocity));
		if (contact.normalCompliance > 0 || !(depth > worthALook * pair.size)) continue;
		const auto half = [&](int id) { return 0.5 * extentAlong(*(*scene.bodies)[id], contact.normal); };
		const Real size = smallerKnown(half(links[i].id1), half(links[i].id2));
		if (!(size > 0 && depth > std::max(deepOverlap, worstOverlap.share) * size)) continue;
		const auto &body1 = problem.bodies[contact.body1], &body2 = problem.bodies[contact.body2];
		const bool moves = contactdynamics::localDelassus(body1, body2, contact, contactdynamics::contactFrame(contact.normal))(0, 0) > 0;
		if (moves) worstOverlap = {depth / size, depth, links[i].id1, links[i].id2};
	}
}

void ContactDynamicsStep::setPseudoImpulse(const TouchingPair& pair, Real pseudoImpulse)
{
	for (std::size_t i = pair.first; i < pair.last; i++)
		if (pseudoImpulse != links[i].pseudoImpulse) links[i].phys->pseudoImpulse = links[i].pseudoImpulse = pseudoImpulse;
}

/// Those that the displacements of this step might close, and that are not compliant, whose overlap is meant. The others forget how they were pushed.
void ContactDynamicsStep::choosePairs(const Scene& scene)
{
	pairs.clear();
	contactdynamics::reserveWithRoom(pairs, links.size());
	for (std::size_t i = 0; i < links.size();) {
		const TouchingPair pair = pairFrom(i);
		i = pair.last;
		noteOverlap(scene, pair);
		if (pair.gap > 2 * PenetrationRepair::largestWay * pair.size || problem.contacts[pair.first].normalCompliance > 0)
			setPseudoImpulse(pair, 0);
		else
			pairs.push_back(pair);
	}
}

void ContactDynamicsStep::repairPenetration(Scene& scene, Real rate, Real allowed, const Matrix3r& cellMobility)
{
	remainingOverlap = repairDisplacement = 0;
	repairStrain.setZero();
	worstOverlap = Overlap();
	Real deepest = 0; // to be repaired, in sizes
	choosePairs(scene);
	for (const TouchingPair& pair : pairs) {
		remainingOverlap = std::max(remainingOverlap, -pair.deepest);
		deepest = std::max(deepest, -pair.gap / pair.size);
	}
	if (rate > 0 && deepest > allowed) {
		displace(scene, std::min(rate, std::max(leastShare, gentleStep / deepest)), allowed, cellMobility);
		return;
	}
	for (const TouchingPair& pair : pairs) setPseudoImpulse(pair, 0);
}

void ContactDynamicsStep::displace(Scene& scene, Real share, Real allowed, const Matrix3r& cellMobility)
{
	candidates.clear();
	contactdynamics::reserveWithRoom(candidates, pairs.size());
	for (const TouchingPair& pair : pairs) {
		std::size_t its = pair.first;
		while (pair.loaded && problem.contacts[its].impulse == Vector3r::Zero()) its++;
		candidates.push_back({static_cast<int>(its), pair.gap, pair.deepest, pair.size, pair.last - pair.first > 1, links[pair.first].pseudoImpulse});
	}
	repair.solve(problem, candidates, share, allowed, cellMobility);
	for (std::size_t k = 0; k < pairs.size(); k++) {
		if (k + Prefetch::ahead < pairs.size()) Prefetch::whole(&links[pairs[k + Prefetch::ahead].first].phys->pseudoImpulse);
		setPseudoImpulse(pairs[k], candidates[k].pseudoImpulse);
	}
	remainingOverlap = repair.remainingOverlap(candidates);
	repairDisplacement = repair.largestDisplacement();
	repairStrain = repair.strain();

	Real work = 0, workOfGravity = 0;
	const bool cellMoves = !repairStrain.isZero(0);
	const Matrix3r strainAsVelocity = cellMoves ? Matrix3r(planOfField->beforeStep(velGrad) * repairStrain) : Matrix3r(Matrix3r::Zero());
	for (std::size_t index = 0; index < idOfIndex.size(); index++) {
		if (index + Prefetch::ahead < idOfIndex.size()) {
			const int coming = idOfIndex[index + Prefetch::ahead];
			Prefetch::whole((*scene.bodies)[coming].get());
			Prefetch::between(&views[coming].state->se3, &views[coming].state->angVel);
		}
		const Vector3r& relative = repair.displacement(static_cast<int>(index));
		if (relative == Vector3r::Zero() && !cellMoves) continue;
		const Body& body = *(*scene.bodies)[idOfIndex[index]];
		const Vector3r withCell = cellMoves ? Vector3r(repairStrain * body.state->pos) : Vector3r(Vector3r::Zero());
		const Vector3r displacement = relative + withCell;
		// A changing periodic cell gives velocity by position: the velocity at the end of the step must not see that this is another one now, but be
		// that of the mean field where the cell has carried the body.
		body.state->vel -= displacementAsVelocity * displacement;
		if (cellMoves) body.state->vel += strainAsVelocity * body.state->pos;
		body.state->pos += displacement;
		const Vector3r weight = body.state->mass * gravity;
		work += motions[index].load.dot(relative) + weight.dot(withCell);
		workOfGravity += weight.dot(displacement);
		// Members at once, too: the integrator takes the torque of their contact forces about the position of the clump.
		if (!body.isClump()) continue;
		for (const auto& member : static_cast<const Clump&>(*body.shape).members) (*scene.bodies)[member.first]->state->pos += displacement;
	}
	if (scene.trackEnergy) ContactEnergy::reportRepair(*scene.energy, work, workOfGravity);
}

} // namespace yade
