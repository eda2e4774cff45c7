// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/Body.hpp>
#include <core/Scene.hpp>

namespace yade {

/// What a controller takes the default mass of its cell or wall from.
struct MovableBodies {
	Real mass = 0; ///< [kg]
	int count = 0; ///< a clump is one body

	/// @param isOneOfThem  of a movable body of the scene: false to leave it out
	template <class Predicate> static MovableBodies of(const Scene& scene, const Predicate& isOneOfThem)
	{
		MovableBodies found;
		for (const auto& body : *scene.bodies) {
			if (!body || body->isClumpMember() || !body->isDynamic() || !isOneOfThem(*body)) continue;
			found.mass += body->state->mass;
			found.count++;
		}
		return found;
	}
};

} // namespace yade
