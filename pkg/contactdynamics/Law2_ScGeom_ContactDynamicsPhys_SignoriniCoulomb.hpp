// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "ContactDynamicsPhys.hpp"
#include "MissingEngine.hpp"
#include <core/Dispatching.hpp>
#include <pkg/dem/ScGeom.hpp>

namespace yade {

class Law2_ScGeom_ContactDynamicsPhys_SignoriniCoulomb : public LawFunctor {
public:
	bool go(shared_ptr<IGeom>& geom, shared_ptr<IPhys>& phys, Interaction* interaction) override;
	FUNCTOR2D(ScGeom, ContactDynamicsPhys);
	// clang-format off
	YADE_CLASS_BASE_DOC(Law2_ScGeom_ContactDynamicsPhys_SignoriniCoulomb,LawFunctor,
		"Keeps the contacts that two bodies may close within the coming step as candidates of :yref:`ContactDynamicsEngine` and ends all others. Applies no force: "
		"the Signorini condition and Coulomb's law hold for all contacts of the scene together and are solved by the engine. A candidate is kept while its gap is at most "
		"the sum of the reaches of the two bodies: the way a body may go in one step at its own speed or at the largest speed around it, which a collision may hand on to it, "
		"plus 5 % of its radius. The decision depends on the current state only, so it is the same after loading a saved scene."
	);
	// clang-format on

private:
	MissingEngine missingEngine;
};
REGISTER_SERIALIZABLE(Law2_ScGeom_ContactDynamicsPhys_SignoriniCoulomb);

} // namespace yade
