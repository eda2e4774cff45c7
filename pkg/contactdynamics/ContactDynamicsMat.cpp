// SPDX-License-Identifier: GPL-2.0-or-later
#include "ContactDynamicsMat.hpp"
#include "AdmittedValues.hpp"
#include "RefuseAttribute.hpp"
#include <cmath>
#include <limits>

namespace yade {

YADE_PLUGIN((ContactDynamicsMat));

namespace {
void requireUpTo(Real limit, const char* allowed, const char* attribute, Real value)
{
	if (!(value >= 0 && value <= limit)) refuseAttribute(std::string("ContactDynamicsMat.") + attribute, value, allowed);
}
void requireCoefficient(const char* attribute, Real value) { requireUpTo(1, "it must lie in [0, 1]", attribute, value); }
void requireNotNegative(const char* attribute, Real value)
{
	requireUpTo(std::numeric_limits<Real>::max(), "it must be finite and not negative", attribute, value);
}
} // namespace

void ContactDynamicsMat::postLoad(ContactDynamicsMat&)
{
	admit(attributes(), admitted, [this] {
		requireCoefficient("normalRestitution", normalRestitution);
		requireCoefficient("tangentialRestitution", tangentialRestitution);
		requireNotNegative("restitutionVelocity", restitutionVelocity);
		requireUpTo(std::nextafter(Real(M_PI_2), Real(0)), "it must lie in [0, pi/2)", "staticFrictionAngle", staticFrictionAngle);
		requireNotNegative("cohesionForce", cohesionForce);
		requireNotNegative("cohesionStress", cohesionStress);
		requireNotNegative("kn", kn);
		requireNotNegative("ks", ks);
		requireNotNegative("normalDamping", normalDamping);
		requireNotNegative("rollingFriction", rollingFriction);
		requireNotNegative("twistingFriction", twistingFriction);
	});
}

} // namespace yade
