// SPDX-License-Identifier: GPL-2.0-or-later
#include "ContactDynamicsMat.hpp"
#include "RefuseAttribute.hpp"
#include <cmath>
#include <limits>

namespace yade {

YADE_PLUGIN((ContactDynamicsMat));

void ContactDynamicsMat::postLoad(ContactDynamicsMat&)
{
	struct Attribute {
		const char* name;
		Real* value;
		Real limit;
		const char* allowed;
	};
	const Real largest = std::numeric_limits<Real>::max();
	const char* unbounded = "it must be finite and not negative";
	const char* coefficient = "it must lie in [0, 1]";
	const Attribute all[] = {
			{"normalRestitution", &normalRestitution, 1, coefficient},
			{"tangentialRestitution", &tangentialRestitution, 1, coefficient},
			{"restitutionVelocity", &restitutionVelocity, largest, unbounded},
			{"staticFrictionAngle", &staticFrictionAngle, std::nextafter(Real(M_PI_2), Real(0)), "it must lie in [0, pi/2)"},
			{"cohesionForce", &cohesionForce, largest, unbounded},
			{"cohesionStress", &cohesionStress, largest, unbounded},
			{"kn", &kn, largest, unbounded},
			{"ks", &ks, largest, unbounded},
			{"normalDamping", &normalDamping, largest, unbounded},
			{"rollingFriction", &rollingFriction, largest, unbounded},
			{"twistingFriction", &twistingFriction, largest, unbounded},
	};
	std::vector<Real> asked;
	for (const Attribute& a : all) {
		asked.push_back(*a.value);
		if (*a.value >= 0 && *a.value <= a.limit) continue;
		const Real refused = *a.value;
		for (std::size_t i = 0; i < admitted.size(); i++) *all[i].value = admitted[i];
		refuseAttribute(std::string("ContactDynamicsMat.") + a.name, refused, a.allowed);
	}
	admitted = asked;
}

} // namespace yade
