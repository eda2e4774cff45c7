// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "Bo1_Proximity.hpp"
#include <pkg/common/Facet.hpp>

namespace yade {

class Bo1_Facet_Aabb_Proximity : public Bo1_Proximity {
public:
	FUNCTOR1D(Facet);
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR(Bo1_Facet_Aabb_Proximity,BoundFunctor,
		"Creates/updates an :yref:`Aabb` of a :yref:`Facet` like :yref:`Bo1_Facet_Aabb`, enlarged on all sides by the distance the body may go in the coming step "
		"(see :yref:`Law2_ScGeom_ContactDynamicsPhys_SignoriniCoulomb`), so that the collider sees every contact that can close before it does. Meant for an "
		":yref:`InsertionSortCollider` that runs every step (``verletDist=0``), as in ``contactdynamics.engines()``.",
		,
		delegateTo("Bo1_Facet_Aabb")
	);
	// clang-format on
};
REGISTER_SERIALIZABLE(Bo1_Facet_Aabb_Proximity);

} // namespace yade
