// SPDX-License-Identifier: GPL-2.0-or-later
// The order of virtual functions in pkg/yade: each has to stand in the place of the table where Debian's yade 2023.02a has it. The compiler cannot
// assert this, so a program looks: a pointer to a virtual member function is 1 plus eight times the place (Itanium C++ ABI, 2.3.2).

#include <core/Clump.hpp>
#include <core/Dispatching.hpp>
#include <core/TimeStepper.hpp>
#include <pkg/common/Collider.hpp>
#include <pkg/common/ElastMat.hpp>
#include <pkg/dem/FrictPhys.hpp>
#include <pkg/dem/ScGeom.hpp>
#include <pkg/polyhedra/Polyhedra.hpp>

#include <cstring>
#include <iostream>

using namespace yade;

namespace {

int failures = 0;

template <class Function> void expectPlace(const char* name, Function function, long expected)
{
	struct {
		long pointer, adjustment;
	} parts;
	static_assert(sizeof parts == sizeof function);
	std::memcpy(&parts, &function, sizeof parts);
	if (parts.pointer == 1 + 8 * expected && parts.adjustment == 0) return;
	++failures;
	std::cerr << name << ": expected place " << expected << ", found " << (parts.pointer - 1) / 8 << " at offset " << parts.adjustment << "\n";
}

/// Makes protected functions of a class reachable.
template <class Class> struct Protected : Class {
	static void expectIndexPlaces(const char* name, long first)
	{
		expectPlace(name, &Protected::modifyClassIndex, first);
		expectPlace(name, &Class::getClassIndex, first + 1);
		expectPlace(name, &Class::getBaseClassIndex, first + 2);
		expectPlace(name, &Class::getMaxCurrentlyUsedClassIndexOfKin, first + 3);
		expectPlace(name, &Protected::incrementMaxCurrentlyUsedClassIndexOfKin, first + 4);
	}
};

template <> struct Protected<Indexable> : Indexable {
	static void expectOwnPlaces()
	{
		expectPlace("Indexable::incrementMaxCurrentlyUsedClassIndexOfKin", &Protected::incrementMaxCurrentlyUsedClassIndexOfKin, 0);
		expectPlace("Indexable::modifyClassIndex", &Protected::modifyClassIndex, 1);
		expectPlace("Indexable::getClassIndex", &Indexable::getClassIndex, 4);
		expectPlace("Indexable::getBaseClassIndex", &Indexable::getBaseClassIndex, 5);
		expectPlace("Indexable::getMaxCurrentlyUsedClassIndexOfKin", &Indexable::getMaxCurrentlyUsedClassIndexOfKin, 6);
	}
};

template <class Result, class... Arguments> struct Calls {
	template <class Wrapper> static void expectPlaces(const char* name, long go)
	{
		expectPlace(name, static_cast<Result (Wrapper::*)(Arguments...)>(&Wrapper::go), go);
		expectPlace(name, static_cast<Result (Wrapper::*)(Arguments...)>(&Wrapper::goReverse), go + 7);
	}
};

} // namespace

int main()
{
	expectPlace("Factorable::getBaseClassName", &Factorable::getBaseClassName, 2);
	expectPlace("Factorable::getBaseClassNumber", &Factorable::getBaseClassNumber, 3);
	expectPlace("Factorable::getClassName", &Factorable::getClassName, 4);
	expectPlace("Serializable::pySetAttr", &Serializable::pySetAttr, 5);
	expectPlace("Serializable::pyDict", &Serializable::pyDict, 6);
	expectPlace("Serializable::pyDictCustom", &Serializable::pyDictCustom, 7);
	expectPlace("Serializable::callPostLoad", &Serializable::callPostLoad, 8);
	expectPlace("Serializable::checkPyClassRegistersItself", &Serializable::checkPyClassRegistersItself, 9);
	expectPlace("Serializable::pyRegisterClass", &Serializable::pyRegisterClass, 10);
	expectPlace("Serializable::pyHandleCustomCtorArgs", &Serializable::pyHandleCustomCtorArgs, 11);

	expectPlace("Engine::isActivated", &Engine::isActivated, 12);
	expectPlace("Engine::action", &Engine::action, 13);
	expectPlace("TimeStepper::computeTimeStep", &TimeStepper::computeTimeStep, 14);
	expectPlace("Collider::probeBoundingVolume", &Collider::probeBoundingVolume, 14);
	expectPlace("Collider::invalidatePersistentData", &Collider::invalidatePersistentData, 15);
	expectPlace("Dispatcher::getFunctorType", &Dispatcher::getFunctorType, 14);
	expectPlace("Dispatcher::getBaseClassType", &Dispatcher::getBaseClassType, 16);
	expectPlace("Body::userForcedDisplacementRedrawHook", &Body::userForcedDisplacementRedrawHook, 12);

	Protected<Indexable>::expectOwnPlaces();
	Protected<IPhys>::expectIndexPlaces("IPhys", 12);
	Protected<FrictPhys>::expectIndexPlaces("FrictPhys", 12);
	Protected<IGeom>::expectIndexPlaces("IGeom", 12);
	Protected<ScGeom>::expectIndexPlaces("ScGeom", 12);
	Protected<Shape>::expectIndexPlaces("Shape", 12);
	Protected<Polyhedra>::expectIndexPlaces("Polyhedra", 12);
	Protected<Clump>::expectIndexPlaces("Clump", 12);
	Protected<Bound>::expectIndexPlaces("Bound", 12);
	Protected<Aabb>::expectIndexPlaces("Aabb", 12);
	Protected<State>::expectIndexPlaces("State", 12);
	expectPlace("Material::newAssocState", &Material::newAssocState, 12);
	expectPlace("Material::stateTypeOk", &Material::stateTypeOk, 13);
	Protected<Material>::expectIndexPlaces("Material", 14);
	Protected<FrictMat>::expectIndexPlaces("FrictMat", 14);

	expectPlace("Functor::getFunctorTypes", &Functor::getFunctorTypes, 12);
	expectPlace("BoundFunctor::get1DFunctorType1", &BoundFunctor::get1DFunctorType1, 13);
	expectPlace("IGeomFunctor::get2DFunctorType1", &IGeomFunctor::get2DFunctorType1, 13);
	expectPlace("IGeomFunctor::get2DFunctorType2", &IGeomFunctor::get2DFunctorType2, 14);
	expectPlace("IGeomFunctor::preStep", &IGeomFunctor::preStep, 15);

	using BoundCalls = FunctorWrapper<void, boost::mpl::vector<const shared_ptr<Shape>&, shared_ptr<Bound>&, const Se3r&, const Body*>>;
	using LawCalls = FunctorWrapper<bool, boost::mpl::vector<shared_ptr<IGeom>&, shared_ptr<IPhys>&, Interaction*>>;
	using PhysCalls =
			FunctorWrapper<void, boost::mpl::vector<const shared_ptr<Material>&, const shared_ptr<Material>&, const shared_ptr<Interaction>&>>;
	expectPlace("FunctorWrapper::checkOrder", &LawCalls::checkOrder, 2);
	Calls<void, const shared_ptr<Shape>&, shared_ptr<Bound>&, const Se3r&, const Body*>::expectPlaces<BoundCalls>("BoundFunctor::go", 6);
	Calls<bool, shared_ptr<IGeom>&, shared_ptr<IPhys>&, Interaction*>::expectPlaces<LawCalls>("LawFunctor::go", 5);
	Calls<void, const shared_ptr<Material>&, const shared_ptr<Material>&, const shared_ptr<Interaction>&>::expectPlaces<PhysCalls>("IPhysFunctor::go",
																																   5);

	if (failures == 0) std::cout << "every virtual function stands where Debian's YADE has it\n";
	return failures == 0 ? 0 : 1;
}
