// SPDX-License-Identifier: GPL-2.0-or-later
#include "Ip2_FrictMat_FrictMat_ContactDynamicsPhys.hpp"
#include "ContactDynamicsPhys.hpp"
#include "RefusedInteraction.hpp"
#include <core/Interaction.hpp>
#include <core/Scene.hpp>
#include <pkg/dem/ScGeom.hpp>
#include <cmath>
#include <sstream>

namespace yade {

YADE_PLUGIN((Ip2_FrictMat_FrictMat_ContactDynamicsPhys));

void Ip2_FrictMat_FrictMat_ContactDynamicsPhys::go(
        const shared_ptr<Material>& material1, const shared_ptr<Material>& material2, const shared_ptr<Interaction>& interaction)
{
	if (interaction->phys) return;
	const FrictMat& mat1  = static_cast<const FrictMat&>(*material1);
	const FrictMat& mat2  = static_cast<const FrictMat&>(*material2);
	const Real      angle = frictAngle ? (*frictAngle)(mat1.id, mat2.id, mat1.frictionAngle, mat2.frictionAngle) : std::min(mat1.frictionAngle, mat2.frictionAngle);

	auto phys         = boost::make_shared<ContactDynamicsPhys>();
	interaction->phys = phys;
	const std::string pair = "contact #" + std::to_string(interaction->getId1()) + "+#" + std::to_string(interaction->getId2());
	if (angle >= 0 && angle < M_PI_2) {
		phys->tangensOfFrictionAngle = std::tan(angle);
	} else {
		std::ostringstream message;
		message << pair << ": the friction angle is " << angle << " rad (FrictMat.frictionAngle " << mat1.frictionAngle << " and " << mat2.frictionAngle
		        << "); it must lie in [0, pi/2).";
		refuseInteraction(scene, *interaction, message.str());
	}
	if (!dynamic_cast<ScGeom*>(interaction->geom.get()))
		refuseInteraction(
		        scene,
		        *interaction,
		        pair + ": geometry " + interaction->geom->getClassName()
		                + " has no Contact Dynamics law; known geometries are ScGeom and classes derived from it."
		                  " Use another Ig2 functor for these shapes, or another material (and so another Ip2) for these bodies.");
}

} // namespace yade
