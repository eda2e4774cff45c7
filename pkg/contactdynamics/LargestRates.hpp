// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <lib/base/Math.hpp>

namespace yade {

class Scene;

/// How fast the bodies of a scene move, for the choice of a time step, and how the cell and walls that our controllers drive may move in it.
/// Values that are not finite count as 0.
struct LargestRates {
	Real speed = 0;			 // of a body's centre, without the mean field of a periodic cell but with its strain over the smallest radius [m/s]
	Real acceleration = 0;	 // by gravity and permanent force, of a wall and of the cell likewise by the stress prescribed [m/s2]
	Real rotation = 0;		 // of a body or of the periodic cell; of the latter with its strain [1/s]
	Real smallestRadius = 0; // of a sphere, or of the ball inside a polyhedron or a box that can move; 0 if there is none [m]

	explicit LargestRates(const Scene& scene);
};

} // namespace yade
