// SPDX-License-Identifier: GPL-2.0-or-later
#include "ContactDynamicsPhys.hpp"
#include <cmath>
#include <utility>

namespace yade {

YADE_PLUGIN((ContactDynamicsPhys));

void ContactDynamicsPhys::requireUsable(const std::function<void(const char*, Real, const char*)>& refuse) const
{
	for (const auto& [name, value] : {std::pair<const char*, Real>{"ContactDynamicsPhys.normalRestitution", normalRestitution},
									  {"ContactDynamicsPhys.tangentialRestitution", tangentialRestitution},
									  {"ContactDynamicsPhys.restitutionVelocity", restitutionVelocity},
									  {"ContactDynamicsPhys.staticFriction", staticFriction},
									  {"ContactDynamicsPhys.cohesionForce", cohesionForce},
									  {"ContactDynamicsPhys.cohesionShear", cohesionShear},
									  {"ContactDynamicsPhys.kn", kn},
									  {"ContactDynamicsPhys.ks", ks},
									  {"ContactDynamicsPhys.normalDamping", normalDamping},
									  {"ContactDynamicsPhys.rollingArm", rollingArm},
									  {"ContactDynamicsPhys.twistingArm", twistingArm}})
		if (!(value >= 0 && std::isfinite(value))) refuse(name, value, "it must be finite and not negative");
	if (normalRestitution > 1 || tangentialRestitution > 1)
		refuse("ContactDynamicsPhys restitution", std::max(normalRestitution, tangentialRestitution), "it must lie in [0, 1]");
	if (cohesionShear > 0 && !(tangensOfFrictionAngle > 0))
		refuse("ContactDynamicsPhys.tangensOfFrictionAngle", tangensOfFrictionAngle, "with cohesionShear it must be above 0");
}

} // namespace yade
