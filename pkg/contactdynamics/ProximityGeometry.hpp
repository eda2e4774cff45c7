// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/Interaction.hpp>
#include <lib/base/Math.hpp>

namespace yade {

class Scene;
class State;

/// Nearest points of two bodies as the Ig2_*_Proximity functors find them.
struct Nearest {
	Vector3r point;	 // on the surface of body 1, global axes                 [m]
	Vector3r normal; // unit, from body 1 to body 2                           [-]
	Real gap;		 // distance of the surfaces along the normal, < 0 inside [m]
	Real radius1;	 // YADE's reference radii, for soft laws: of a sphere its own, of a facet twice that of the sphere it touches, of others once [m]
	Real radius2;
};

/// Fetch what the interactions that come next will need. InteractionLoop takes them in the order of their container and waits for each of their
/// objects; only a functor can tell it what comes.
void prefetchComing(const Scene& scene, const Interaction& interaction);

/// True when the pair is no contact and cannot become one in the coming step: the functor then returns without making a geometry.
bool beyondReach(const Scene& scene, const Interaction& interaction, Real gap, bool force);

/// Put the interaction's ScGeom where the bodies are nearest.
void placeScGeom(Interaction& interaction, const Nearest& nearest);

/// The same, made at the first call, with the increment of shear and the rotation of the contact since the last step, for soft laws that act beside
/// Contact Dynamics. Returns true, the functor's answer.
/// @param shift2     of body 2, where it is an image [m]
/// @param fixedArms  of rotation, the radii whatever the gap, so that closed cycles leave no shear: as in YADE for two spheres, one on a wall, one
/// with its centre in a box
bool updateScGeom(const Scene& scene, const shared_ptr<Interaction>& interaction, const State& state1, const State& state2, const Vector3r& shift2,
				  const Nearest& nearest, bool fixedArms = false);

/// Report a body without material and return true if there is one; YADE would read through the null pointer right after the Ig2 functor.
bool lacksMaterial(const Scene& scene, const Interaction& interaction);

} // namespace yade
