// SPDX-License-Identifier: GPL-2.0-or-later
#include "Law2_ScGeom_ContactDynamicsPhys_SignoriniCoulomb.hpp"
#include "Reach.hpp"
#include <core/Interaction.hpp>
#include <core/Scene.hpp>

namespace yade {

YADE_PLUGIN((Law2_ScGeom_ContactDynamicsPhys_SignoriniCoulomb));

bool Law2_ScGeom_ContactDynamicsPhys_SignoriniCoulomb::go(shared_ptr<IGeom>& geom, shared_ptr<IPhys>& /*phys*/, Interaction* interaction)
{
	missingEngine.lookFor(*scene);
	const Real gap = -static_cast<const ScGeom&>(*geom).penetrationDepth;
	// Written so that a NaN gap is kept: the engine then names the contact, instead of the pair vanishing silently.
	return !(gap > Reach::ofPair(*scene, interaction->getId1(), interaction->getId2()));
}

} // namespace yade
