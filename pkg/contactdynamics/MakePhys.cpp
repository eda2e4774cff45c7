// SPDX-License-Identifier: GPL-2.0-or-later
#include "MakePhys.hpp"
#include "ContactDynamicsManifoldPhys.hpp"
#include "RefusedInteraction.hpp"
#include "StockControllers.hpp"
#include <core/Interaction.hpp>
#include <core/Scene.hpp>
#include <pkg/common/ElastMat.hpp>
#include <pkg/dem/ScGeom.hpp>
#include <cmath>
#include <sstream>

namespace yade {

void makePhys(const Scene* scene, const FrictMat& material1, const FrictMat& material2, Interaction& interaction, const PairLaw& law)
{
	if (interaction.phys) return;
	const bool manifold = dynamic_cast<ManifoldGeom*>(interaction.geom.get());
	shared_ptr<ContactDynamicsPhys> phys = manifold ? boost::make_shared<ContactDynamicsManifoldPhys>() : boost::make_shared<ContactDynamicsPhys>();
	interaction.phys = phys;
	const std::string pair = "contact #" + std::to_string(interaction.getId1()) + "+#" + std::to_string(interaction.getId2());
	if (law.frictionAngle >= 0 && law.frictionAngle < M_PI_2) {
		phys->tangensOfFrictionAngle = std::tan(law.frictionAngle);
		const std::string wrong = law.applyTo(*phys, *(*scene->bodies)[interaction.getId1()], *(*scene->bodies)[interaction.getId2()]);
		if (!wrong.empty()) refuseInteraction(scene, interaction, pair + ": " + wrong);
	} else {
		std::ostringstream message;
		message << pair << ": the friction angle is " << law.frictionAngle << " rad (FrictMat.frictionAngle " << material1.frictionAngle << " and "
				<< material2.frictionAngle << "); it must lie in [0, pi/2).";
		refuseInteraction(scene, interaction, message.str());
	}
	const std::string forbidden = whatForbidsOtherContacts(*scene);
	if (!forbidden.empty()) refuseInteraction(scene, interaction, pair + ": " + forbidden);
	if (!dynamic_cast<ScGeom*>(interaction.geom.get()))
		refuseInteraction(scene, interaction,
						  pair + ": geometry " + interaction.geom->getClassName() +
								  " has no Contact Dynamics law; known geometries are ScGeom and classes derived from it."
								  " Use another Ig2 functor for these shapes, or another material (and so another Ip2) for these bodies.");
}

} // namespace yade
