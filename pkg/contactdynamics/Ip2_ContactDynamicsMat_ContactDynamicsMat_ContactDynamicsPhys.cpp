// SPDX-License-Identifier: GPL-2.0-or-later
#include "Ip2_ContactDynamicsMat_ContactDynamicsMat_ContactDynamicsPhys.hpp"
#include "MakePhys.hpp"
#include <algorithm>

namespace yade {

YADE_PLUGIN((Ip2_ContactDynamicsMat_ContactDynamicsMat_ContactDynamicsPhys));

void Ip2_ContactDynamicsMat_ContactDynamicsMat_ContactDynamicsPhys::go(const shared_ptr<Material>& material1, const shared_ptr<Material>& material2,
																	   const shared_ptr<Interaction>& interaction)
{
	const auto& one = static_cast<const ContactDynamicsMat&>(*material1);
	const auto& two = static_cast<const ContactDynamicsMat&>(*material2);
	const auto match = [&](const shared_ptr<MatchMaker>& rule, Real value1, Real value2, Real otherwise) {
		return rule ? (*rule)(one.id, two.id, value1, value2) : otherwise;
	};
	const auto smaller = [&](const shared_ptr<MatchMaker>& rule, Real value1, Real value2) {
		return match(rule, value1, value2, std::min(value1, value2));
	};
	const auto series = [&](const shared_ptr<MatchMaker>& rule, Real value1, Real value2, bool soft1, bool soft2) {
		const Real both = value1 > 0 && value2 > 0 ? value1 / (value1 + value2) * value2 : 0; // this order does not overflow
		return match(rule, value1, value2, soft1 && soft2 ? both : soft1 ? value1 : soft2 ? value2 : 0);
	};
	PairLaw law;
	law.frictionAngle = smaller(frictAngle, one.frictionAngle, two.frictionAngle);
	law.staticFrictionAngle =
			smaller(staticFrictAngle, std::max(one.staticFrictionAngle, one.frictionAngle), std::max(two.staticFrictionAngle, two.frictionAngle));
	law.normalRestitution = smaller(normalRestitution, one.normalRestitution, two.normalRestitution);
	law.tangentialRestitution = smaller(tangentialRestitution, one.tangentialRestitution, two.tangentialRestitution);
	law.restitutionVelocity =
			match(restitutionVelocity, one.restitutionVelocity, two.restitutionVelocity, std::max(one.restitutionVelocity, two.restitutionVelocity));
	law.cohesionForce = bonding ? smaller(cohesionForce, one.cohesionForce, two.cohesionForce) : 0;
	law.cohesionStress = bonding ? smaller(cohesionStress, one.cohesionStress, two.cohesionStress) : 0;
	law.kn = series(kn, one.kn, two.kn, one.kn > 0, two.kn > 0);
	law.ks = series(ks, one.ks, two.ks, one.ks > 0, two.ks > 0);
	law.normalDamping = series(normalDamping, one.normalDamping, two.normalDamping, one.kn > 0, two.kn > 0);
	law.rollingFriction = smaller(rollingFriction, one.rollingFriction, two.rollingFriction);
	law.twistingFriction = smaller(twistingFriction, one.twistingFriction, two.twistingFriction);
	makePhys(scene, one, two, *interaction, law);
}

} // namespace yade
