// SPDX-License-Identifier: GPL-2.0-or-later
// Penetration repair of a step: bodies are displaced before NewtonIntegrator moves them by h v.
#include "ContactDynamicsPhys.hpp"
#include "ContactDynamicsStep.hpp"
#include "ContactEnergy.hpp"
#include <core/Clump.hpp>
#include <core/Scene.hpp>
#include <algorithm>

namespace yade {
namespace {
/// The deepest overlap shrinks by this in a step, in sizes, and all others in proportion ...
constexpr Real gentleStep = 1e-4;
/// ... but at least by this share, which makes a hundredth of any overlap in 770 steps.
constexpr Real leastShare = 6e-3;
} // namespace

/// What an overlap is measured against: the radius of the smaller sphere, the shorter lever arm where there is none.
Real ContactDynamicsStep::sizeOf(std::size_t i) const
{
	const auto smaller = [](Real one, Real two) { return one > 0 && two > 0 ? std::min(one, two) : std::max(one, two); };
	const Real radius = smaller(views[links[i].id1].radius, views[links[i].id2].radius);
	return radius > 0 ? radius : smaller(problem.contacts[i].arm1.norm(), problem.contacts[i].arm2.norm());
}

/// The larger one of the gaps at the start and at the end of the step. The overlap of a compliant contact is its deformation, which carries its
/// force: it has no gap to repair.
Real ContactDynamicsStep::gapToRepair(std::size_t i) const
{
	const contactdynamics::Contact& contact = problem.contacts[i];
	return contact.normalCompliance > 0 ? 0 : links[i].gap + std::max(Real(0), h * contact.normal.dot(contact.relativeVelocity));
}

void ContactDynamicsStep::repairPenetration(Scene& scene, Real rate, Real allowed)
{
	remainingOverlap = repairDisplacement = 0;
	Real deepest = 0; // in sizes
	for (std::size_t i = 0; i < links.size(); i++) {
		const Real overlap = -gapToRepair(i);
		if (overlap <= 0) continue;
		remainingOverlap = std::max(remainingOverlap, overlap);
		deepest = std::max(deepest, overlap / sizeOf(i));
	}
	if (rate > 0 && deepest > allowed) {
		displace(scene, std::min(rate, std::max(leastShare, gentleStep / deepest)), allowed);
		return;
	}
	for (const Link& link : links) link.phys->pseudoImpulse = 0;
}

void ContactDynamicsStep::displace(Scene& scene, Real share, Real allowed)
{
	candidates.clear();
	for (std::size_t i = 0; i < links.size(); i++) {
		const Real gap = gapToRepair(i), size = sizeOf(i);
		if (gap > 2 * PenetrationRepair::largestWay * size || problem.contacts[i].normalCompliance > 0)
			links[i].phys->pseudoImpulse = 0;
		else
			candidates.push_back({static_cast<int>(i), gap, size, links[i].phys->pseudoImpulse});
	}
	repair.solve(problem, candidates, share, allowed);
	for (const PenetrationRepair::Candidate& candidate : candidates) links[candidate.contact].phys->pseudoImpulse = candidate.pseudoImpulse;
	remainingOverlap = repair.remainingOverlap(candidates);
	repairDisplacement = repair.largestDisplacement();

	Real work = 0, workOfGravity = 0;
	for (std::size_t index = 0; index < idOfIndex.size(); index++) {
		const Vector3r& displacement = repair.displacement(static_cast<int>(index));
		if (displacement == Vector3r::Zero()) continue;
		const Body& body = *(*scene.bodies)[idOfIndex[index]];
		body.state->pos += displacement;
		// A changing periodic cell gives velocity by position: the velocity at the end of the step must not see that this is another one now.
		body.state->vel -= displacementAsVelocity * displacement;
		work += motions[index].load.dot(displacement);
		workOfGravity += body.state->mass * gravity.dot(displacement);
		// Members at once, too: the integrator takes the torque of their contact forces about the position of the clump.
		if (!body.isClump()) continue;
		for (const auto& member : static_cast<const Clump&>(*body.shape).members) (*scene.bodies)[member.first]->state->pos += displacement;
	}
	if (scene.trackEnergy) ContactEnergy::reportRepair(*scene.energy, work, workOfGravity);
}

} // namespace yade
