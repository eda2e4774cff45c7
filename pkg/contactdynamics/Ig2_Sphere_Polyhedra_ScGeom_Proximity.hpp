// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/Dispatching.hpp>
#include <pkg/common/Sphere.hpp>
#include <pkg/polyhedra/Polyhedra.hpp>

namespace yade {

class Ig2_Sphere_Polyhedra_ScGeom_Proximity : public IGeomFunctor {
public:
	bool go(const shared_ptr<Shape>& shape1, const shared_ptr<Shape>& shape2, const State& state1, const State& state2, const Vector3r& shift2,
			const bool& force, const shared_ptr<Interaction>& interaction) override;
	FUNCTOR2D(Sphere, Polyhedra);
	DEFINE_FUNCTOR_ORDER_2D(Sphere, Polyhedra);
	// clang-format off
	YADE_CLASS_BASE_DOC(Ig2_Sphere_Polyhedra_ScGeom_Proximity,IGeomFunctor,
		"Create/update a :yref:`ScGeom` between a sphere and a polyhedron, touching or not: the contact is seen while the gap is at most what the two bodies may close in the coming step "
		"(see :yref:`Law2_ScGeom_ContactDynamicsPhys_SignoriniCoulomb`). The normal points from the sphere to the nearest point of the polyhedron's surface, or, with the centre inside, leads out through the nearest face; "
		":yref:`penetrationDepth<ScGeom.penetrationDepth>` is minus the gap [m], the contact point lies in the middle of the gap or overlap. Shear increments of soft contact laws are not computed."
	);
	// clang-format on
};
REGISTER_SERIALIZABLE(Ig2_Sphere_Polyhedra_ScGeom_Proximity);

} // namespace yade
