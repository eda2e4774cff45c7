// SPDX-License-Identifier: GPL-2.0-or-later
// Penetration repair of a step: bodies are displaced before NewtonIntegrator moves them by h v.
#include "ContactDynamicsStep.hpp"
#include <core/Clump.hpp>
#include <core/Scene.hpp>
#include <omp.h>
#include <algorithm>

namespace yade {

/// Radius of the smaller sphere or polyhedron of a contact, 0 if there is none.
Real ContactDynamicsStep::radiusOf(const Link& link) const
{
	const Real radius1 = views[link.interaction->getId1()].size, radius2 = views[link.interaction->getId2()].size;
	return radius1 > 0 && radius2 > 0 ? std::min(radius1, radius2) : std::max(radius1, radius2);
}

void ContactDynamicsStep::repairPenetration(Scene& scene, Real rate, Real allowed)
{
	overlaps.clear();
	for (std::size_t i = 0; i < links.size(); i++) {
		// The overlap of a compliant contact is its deformation, which carries its force: radius 0 leaves it alone.
		overlaps.push_back({links[i].gap, problem.contacts[i].normalCompliance > 0 ? 0 : radiusOf(links[i])});
	}
	if (!repair.solve(problem, overlaps, h, rate, allowed, omp_get_max_threads())) return;

	for (std::size_t index = 0; index < idOfIndex.size(); index++) {
		const Vector3r displacement = repair.displacement(static_cast<int>(index));
		if (displacement == Vector3r::Zero()) continue;
		const Body& body = *(*scene.bodies)[idOfIndex[index]];
		body.state->pos += displacement;
		// A changing periodic cell gives velocity by position: the velocity at the end of the step must not see that this is another one now.
		body.state->vel -= displacementAsVelocity * displacement;
		// Members at once, too: the integrator takes the torque of their contact forces about the position of the clump.
		if (!body.isClump()) continue;
		for (const auto& member : static_cast<const Clump&>(*body.shape).members) (*scene.bodies)[member.first]->state->pos += displacement;
	}
}

} // namespace yade
