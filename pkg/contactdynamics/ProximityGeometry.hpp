// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/Interaction.hpp>
#include <lib/base/Math.hpp>

namespace yade {

class Scene;

/// Nearest points of two bodies as the Ig2_*_Proximity functors find them.
struct Nearest {
	Vector3r point;	 // on the surface of body 1, global axes                 [m]
	Vector3r normal; // unit, from body 1 to body 2                           [-]
	Real gap;		 // distance of the surfaces along the normal, < 0 inside [m]
	Real radius1;	 // YADE's reference radii: sphere's radius, for other shapes that of the sphere they touch [m]
	Real radius2;
};

/// True when the pair is no contact and cannot become one in the coming step: the functor then returns without making a geometry.
bool beyondReach(const Scene& scene, const Interaction& interaction, Real gap, bool force);

/// Fill (and create at the first call) the interaction's ScGeom. Returns true, the functor's answer.
bool updateScGeom(Interaction& interaction, const Nearest& nearest);

/// Report a body without material and return true if there is one; YADE would read through the null pointer right after the Ig2 functor.
bool lacksMaterial(const Scene& scene, const Interaction& interaction);

} // namespace yade
