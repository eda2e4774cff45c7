// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "Bo1_Proximity.hpp"
#include <pkg/polyhedra/Polyhedra.hpp>

namespace yade {

class Bo1_Polyhedra_Aabb_Proximity : public Bo1_Proximity {
public:
	FUNCTOR1D(Polyhedra);
	// clang-format off
	YADE_CLASS_BASE_DOC(Bo1_Polyhedra_Aabb_Proximity,BoundFunctor,
		"Creates/updates an :yref:`Aabb` of a :yref:`Polyhedra` around its vertices (in a sheared periodic cell, too, where :yref:`Bo1_Polyhedra_Aabb` ignores the cell), enlarged on all sides by the distance the body may go in the coming step "
		"(see :yref:`Law2_ScGeom_ContactDynamicsPhys_SignoriniCoulomb`). A Polyhedra without vertices stops the step with an error."
	);
	// clang-format on
protected:
	void bound(const shared_ptr<Shape>& shape, shared_ptr<Bound>& bound, const Se3r& se3, const Body* body) override;
};
REGISTER_SERIALIZABLE(Bo1_Polyhedra_Aabb_Proximity);

} // namespace yade
