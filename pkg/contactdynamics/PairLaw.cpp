// SPDX-License-Identifier: GPL-2.0-or-later
#include "PairLaw.hpp"
#include "BodySize.hpp"
#include "ContactDynamicsPhys.hpp"
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace yade {
namespace {
Real radiusOf(const Body& body)
{
	const Sphere* sphere = asSphere(body.shape.get());
	return sphere ? sphere->radius : std::numeric_limits<Real>::infinity();
}
std::string complaint(const char* what, Real value, const char* allowed)
{
	std::ostringstream message;
	message << what << " of the pair is " << value << "; " << allowed << ".";
	return message.str();
}
} // namespace

std::string PairLaw::applyTo(ContactDynamicsPhys& phys, const Body& body1, const Body& body2) const
{
	struct Value {
		const char* name;
		Real value, limit;
		const char* allowed;
	};
	const Real largest = std::numeric_limits<Real>::max();
	const char* unbounded = "it must be finite and not negative";
	for (const Value& v :
		 {Value{"normalRestitution", normalRestitution, 1, "it must lie in [0, 1]"},
		  Value{"tangentialRestitution", tangentialRestitution, 1, "it must lie in [0, 1]"},
		  Value{"restitutionVelocity", restitutionVelocity, largest, unbounded},
		  Value{"staticFrictionAngle", staticFrictionAngle, std::nextafter(Real(M_PI_2), Real(0)), "it must lie in [0, pi/2)"},
		  Value{"cohesionForce", cohesionForce, largest, unbounded}, Value{"cohesionStress", cohesionStress, largest, unbounded},
		  Value{"kn", kn, largest, unbounded}, Value{"ks", ks, largest, unbounded}, Value{"normalDamping", normalDamping, largest, unbounded},
		  Value{"rollingFriction", rollingFriction, largest, unbounded}, Value{"twistingFriction", twistingFriction, largest, unbounded}})
		if (!(v.value >= 0 && v.value <= v.limit)) return complaint(v.name, v.value, v.allowed);
	if (cohesionStress > 0 && !(phys.tangensOfFrictionAngle > 0))
		return complaint("cohesionStress", cohesionStress, "Mohr-Coulomb cohesion needs a frictionAngle above 0");
	if (kn > 0 && normalRestitution > 0)
		return complaint("normalRestitution", normalRestitution, "it must be 0 where kn is set: a compliant contact bounces by kn and normalDamping");
	if (ks > 0 && tangentialRestitution > 0)
		return complaint("tangentialRestitution", tangentialRestitution, "it must be 0 where ks is set: a compliant contact rebounds by ks");

	const Real r1 = radiusOf(body1), r2 = radiusOf(body2), smaller = std::min(r1, r2);
	const bool round = std::isfinite(smaller);
	if (!round && cohesionStress > 0)
		return complaint("cohesionStress", cohesionStress,
						 "it needs a sphere in the pair, whose cross-section it acts on. Use cohesionForce, or set cohesionStress of this pair of "
						 "materials to 0 in Ip2_ContactDynamicsMat_ContactDynamicsMat_ContactDynamicsPhys");
	const Real reduced = round ? 1 / (1 / r1 + 1 / r2) : 0; // 1/infinity is 0: flat; blocks do not roll
	phys.staticFriction = staticFrictionAngle > frictionAngle ? std::tan(staticFrictionAngle) : 0;
	phys.normalRestitution = normalRestitution;
	phys.tangentialRestitution = tangentialRestitution;
	phys.restitutionVelocity = restitutionVelocity;
	phys.cohesionForce = cohesionForce;
	phys.cohesionShear = cohesionStress > 0 ? cohesionStress * M_PI * smaller * smaller : 0;
	phys.kn = kn;
	phys.ks = ks;
	phys.normalDamping = normalDamping;
	phys.rollingArm = rollingFriction > 0 ? rollingFriction * reduced : 0;
	phys.twistingArm = twistingFriction > 0 ? twistingFriction * reduced : 0;
	return "";
}

} // namespace yade
