// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/Dispatching.hpp>
#include <pkg/common/Box.hpp>
#include <pkg/polyhedra/Polyhedra.hpp>

namespace yade {

class Ig2_Box_Polyhedra_ManifoldGeom : public IGeomFunctor {
public:
	bool go(const shared_ptr<Shape>& shape1, const shared_ptr<Shape>& shape2, const State& state1, const State& state2, const Vector3r& shift2,
			const bool& force, const shared_ptr<Interaction>& interaction) override;
	FUNCTOR2D(Box, Polyhedra);
	DEFINE_FUNCTOR_ORDER_2D(Box, Polyhedra);
	// clang-format off
	YADE_CLASS_BASE_DOC(Ig2_Box_Polyhedra_ManifoldGeom,IGeomFunctor,
		"Create/update a :yref:`ManifoldGeom` between a box and a polyhedron, touching or not: the contact is seen while the gap is at most what the two bodies may close in the coming step "
		"(see :yref:`Law2_ScGeom_ContactDynamicsPhys_SignoriniCoulomb`). Nothing is made for two bodies that cannot move. A shape without volume or with numbers that are not finite stops the step with an error that names the body."
	);
	// clang-format on
};
REGISTER_SERIALIZABLE(Ig2_Box_Polyhedra_ManifoldGeom);

} // namespace yade
