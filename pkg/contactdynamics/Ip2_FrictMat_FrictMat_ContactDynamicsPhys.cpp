// SPDX-License-Identifier: GPL-2.0-or-later
#include "Ip2_FrictMat_FrictMat_ContactDynamicsPhys.hpp"
#include "ContactDynamicsMat.hpp"
#include "MakePhys.hpp"
#include <algorithm>

namespace yade {

YADE_PLUGIN((Ip2_FrictMat_FrictMat_ContactDynamicsPhys));

void Ip2_FrictMat_FrictMat_ContactDynamicsPhys::go(const shared_ptr<Material>& material1, const shared_ptr<Material>& material2,
												   const shared_ptr<Interaction>& interaction)
{
	const FrictMat& one = static_cast<const FrictMat&>(*material1);
	const FrictMat& two = static_cast<const FrictMat&>(*material2);
	PairLaw law;
	law.frictionAngle =
			frictAngle ? (*frictAngle)(one.id, two.id, one.frictionAngle, two.frictionAngle) : std::min(one.frictionAngle, two.frictionAngle);
	// Mixed pairs come here: YADE's dispatcher knows no functor for (ContactDynamicsMat, FrictMat) that would also take the reverse order.
	const auto* mat1 = dynamic_cast<const ContactDynamicsMat*>(&one);
	const auto* mat2 = dynamic_cast<const ContactDynamicsMat*>(&two);
	const auto* given = mat1 ? mat1 : mat2;
	if (given) {
		const FrictMat& plain = mat1 ? two : one;
		law.staticFrictionAngle = std::min(std::max(given->staticFrictionAngle, given->frictionAngle), plain.frictionAngle);
		law.normalRestitution = given->normalRestitution;
		law.tangentialRestitution = given->tangentialRestitution;
		law.restitutionVelocity = given->restitutionVelocity;
		law.cohesionForce = given->cohesionForce;
		law.cohesionStress = given->cohesionStress;
		law.kn = given->kn;
		law.ks = given->ks;
		law.normalDamping = given->normalDamping;
		law.rollingFriction = given->rollingFriction;
		law.twistingFriction = given->twistingFriction;
	}
	makePhys(scene, one, two, *interaction, law);
}

} // namespace yade
