// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <lib/base/Math.hpp>
#include <string>

namespace yade {

class Body;
class ContactDynamicsPhys;

/// What the two materials of a contact agree on, in the units of ContactDynamicsMat; 0 means off.
struct PairLaw {
	Real frictionAngle = 0, staticFrictionAngle = 0;
	Real normalRestitution = 0, tangentialRestitution = 0, restitutionVelocity = 0;
	Real cohesionForce = 0, cohesionStress = 0;
	Real kn = 0, ks = 0, normalDamping = 0;
	Real rollingFriction = 0, twistingFriction = 0;

	/// Sets the attributes of `phys`, with the lengths of the two bodies' spheres.
	/// @return  what is wrong and what is allowed; empty when all is well. Nothing is set otherwise.
	std::string applyTo(ContactDynamicsPhys& phys, const Body& body1, const Body& body2) const;
};

} // namespace yade
