// SPDX-License-Identifier: GPL-2.0-or-later

#include "LayoutTable.hpp"

#include <core/Clump.hpp>
#include <core/Dispatching.hpp>
#include <core/GlobalEngine.hpp>
#include <core/InteractionLoop.hpp>
#include <core/Scene.hpp>
#include <pkg/common/Box.hpp>
#include <pkg/common/ElastMat.hpp>
#include <pkg/common/Facet.hpp>
#include <pkg/common/MatchMaker.hpp>
#include <pkg/common/Sphere.hpp>
#include <pkg/common/Wall.hpp>
#include <pkg/dem/FrictPhys.hpp>
#include <pkg/dem/NewtonIntegrator.hpp>
#include <pkg/dem/ScGeom.hpp>
#include <pkg/polyhedra/Polyhedra.hpp>

#include <boost/core/demangle.hpp>
#include <boost/python/data_members.hpp>

#include <cstddef>
#include <cstring>
#include <typeinfo>

namespace py = boost::python;

namespace yade {
namespace {

/// Collects the rows of one class.
class Rows {
	py::dict description, members;

public:
	Rows(py::dict& table, const char* className)
	{
		description["members"] = members;
		table[className] = description;
	}

	template <class Class> Rows& size()
	{
		description["size"] = sizeof(Class);
		return *this;
	}

	template <class Class, class Member> Rows& member(const char* name, Member Class::*which)
	{
		// A pointer to a data member is its offset (Itanium C++ ABI, 2.3.1). `offsetof` is not for classes with virtual functions.
		std::ptrdiff_t offset;
		static_assert(sizeof offset == sizeof which);
		std::memcpy(&offset, &which, sizeof offset);
		members[name] = py::make_tuple(offset, boost::core::demangle(typeid(py::detail::member<Member, Class>).name()));
		return *this;
	}
};

} // namespace

// Only members that Python knows as plain data: for these, the running YADE can be asked. HiddenMembers.cpp looks at the others.
#define ROW(Class, name) .member(#name, &Class::name)

py::dict compiledLayout()
{
	py::dict table;

	Rows(table, "Engine") ROW(Engine, dead) ROW(Engine, ompThreads) ROW(Engine, label) ROW(Engine, timingDeltas);
	Rows(table, "GlobalEngine").size<GlobalEngine>();
	Rows(table, "InteractionLoop") ROW(InteractionLoop, lawDispatcher);
	Rows(table, "NewtonIntegrator") ROW(NewtonIntegrator, damping) ROW(NewtonIntegrator, gravity) ROW(NewtonIntegrator, exactAsphericalRot)
			ROW(NewtonIntegrator, prevVelGrad) ROW(NewtonIntegrator, mask);

	Rows(table, "Functor") ROW(Functor, timingDeltas) ROW(Functor, label);
	Rows(table, "BoundFunctor").size<BoundFunctor>();
	Rows(table, "IGeomFunctor").size<IGeomFunctor>();
	Rows(table, "IPhysFunctor").size<IPhysFunctor>();
	Rows(table, "LawFunctor").size<LawFunctor>();
	Rows(table, "MatchMaker").size<MatchMaker>() ROW(MatchMaker, matches) ROW(MatchMaker, algo) ROW(MatchMaker, val);

	Rows(table, "Scene") ROW(Scene, dt) ROW(Scene, iter) ROW(Scene, subStep) ROW(Scene, time) ROW(Scene, isPeriodic) ROW(Scene, trackEnergy)
			ROW(Scene, doSort) ROW(Scene, subdomain);
	Rows(table, "Cell") ROW(Cell, refHSize) ROW(Cell, prevHSize) ROW(Cell, nextVelGrad) ROW(Cell, prevVelGrad) ROW(Cell, homoDeform)
			ROW(Cell, velGradChanged) ROW(Cell, flipFlippable);
	Rows(table, "Interaction") ROW(Interaction, isActive) ROW(Interaction, id1) ROW(Interaction, id2) ROW(Interaction, iterMadeReal)
			ROW(Interaction, geom) ROW(Interaction, phys) ROW(Interaction, cellDist) ROW(Interaction, iterBorn);
	Rows(table, "Body")
			.size<Body>() ROW(Body, id) ROW(Body, groupMask) ROW(Body, flags) ROW(Body, subdomain) ROW(Body, material) ROW(Body, state)
					ROW(Body, shape) ROW(Body, bound) ROW(Body, clumpId) ROW(Body, iterBorn) ROW(Body, timeBorn);
	Rows(table, "State")
			.size<State>() ROW(State, se3) ROW(State, vel) ROW(State, mass) ROW(State, angVel) ROW(State, angMom) ROW(State, inertia)
					ROW(State, refPos) ROW(State, refOri) ROW(State, isDamped) ROW(State, densityScaling);

	Rows(table, "Material") ROW(Material, id) ROW(Material, label) ROW(Material, density);
	Rows(table, "ElastMat") ROW(ElastMat, young) ROW(ElastMat, poisson);
	Rows(table, "FrictMat").size<FrictMat>() ROW(FrictMat, frictionAngle);

	Rows(table, "Sphere").size<Sphere>() ROW(Sphere, radius);
	Rows(table, "Box") ROW(Box, extents);
	Rows(table, "Polyhedra").size<Polyhedra>() ROW(Polyhedra, v) ROW(Polyhedra, seed) ROW(Polyhedra, size);
	Rows(table, "Wall") ROW(Wall, sense) ROW(Wall, axis);
	Rows(table, "Facet").size<Facet>() ROW(Facet, vertices) ROW(Facet, normal) ROW(Facet, area);
	Rows(table, "Clump") ROW(Clump, ids);
	Rows(table, "Bound") ROW(Bound, lastUpdateIter) ROW(Bound, refPos) ROW(Bound, sweepLength) ROW(Bound, min) ROW(Bound, max);
	Rows(table, "Aabb").size<Aabb>();

	Rows(table, "GenericSpheresContact") ROW(GenericSpheresContact, normal) ROW(GenericSpheresContact, contactPoint) ROW(GenericSpheresContact, refR1)
			ROW(GenericSpheresContact, refR2);
	Rows(table, "ScGeom").size<ScGeom>() ROW(ScGeom, penetrationDepth) ROW(ScGeom, shearInc);
	Rows(table, "NormPhys") ROW(NormPhys, kn) ROW(NormPhys, normalForce);
	Rows(table, "NormShearPhys") ROW(NormShearPhys, ks) ROW(NormShearPhys, shearForce);
	Rows(table, "FrictPhys").size<FrictPhys>() ROW(FrictPhys, tangensOfFrictionAngle);
	return table;
}

} // namespace yade
