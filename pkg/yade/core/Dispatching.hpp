// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <core/Aabb.hpp>
#include <core/Dispatcher.hpp>
#include <core/Functor.hpp>
#include <core/IGeom.hpp>
#include <core/IPhys.hpp>
#include <core/Interaction.hpp>
#include <core/Scene.hpp>
#include <core/Shape.hpp>
#include <core/State.hpp>

namespace yade {

/// Makes or updates the bound of a body.
class BoundFunctor : public Functor1D<Shape, void, boost::mpl::vector<const shared_ptr<Shape>&, shared_ptr<Bound>&, const Se3r&, const Body*>> {
	YADE_STOCK_SERIALIZABLE(BoundFunctor)
	BoundFunctor() {}
};

/// Makes or updates the geometry of an interaction. Returns whether there is one: `force` asks for one at any distance. Shape 2 is displaced by
/// `shift2` (periods of the cell).
class IGeomFunctor : public Functor2D<Shape, Shape, bool,
									  boost::mpl::vector<const shared_ptr<Shape>&, const shared_ptr<Shape>&, const State&, const State&,
														 const Vector3r&, const bool&, const shared_ptr<Interaction>&>> {
	YADE_STOCK_SERIALIZABLE(IGeomFunctor)
	IGeomFunctor() {}
	virtual void preStep();
};

/// Makes the physical side of an interaction; has to leave `interaction->phys` set.
class IPhysFunctor : public Functor2D<Material, Material, void,
									  boost::mpl::vector<const shared_ptr<Material>&, const shared_ptr<Material>&, const shared_ptr<Interaction>&>> {
	YADE_STOCK_SERIALIZABLE(IPhysFunctor)
	IPhysFunctor() {}
};

/// The contact law. Returns false if the interaction is to be dropped.
class LawFunctor : public Functor2D<IGeom, IPhys, bool, boost::mpl::vector<shared_ptr<IGeom>&, shared_ptr<IPhys>&, Interaction*>> {
	YADE_STOCK_SERIALIZABLE(LawFunctor)
	LawFunctor() {}
};

// The dispatchers are declared for reading their functors. In YADE each derives from templates between it and Dispatcher; they hold the tables
// of the dispatch, here the opaque storage.

class BoundDispatcher : public Dispatcher {
	YADE_STOCK_SERIALIZABLE(BoundDispatcher)
private:
	abi::Opaque<104, 152> tables;

public:
	vector<shared_ptr<BoundFunctor>> functors;
	bool activated;
	Real sweepDist; ///< by how much bounds are enlarged for motion between runs of the collider [m]

private:
	abi::Opaque<192, 216> forCollider;
};

class IGeomDispatcher : public Dispatcher {
	YADE_STOCK_SERIALIZABLE(IGeomDispatcher)
private:
	abi::Opaque<104, 160> tables;

public:
	vector<shared_ptr<IGeomFunctor>> functors;
};

class IPhysDispatcher : public Dispatcher {
	YADE_STOCK_SERIALIZABLE(IPhysDispatcher)
private:
	abi::Opaque<104, 152> tables;

public:
	vector<shared_ptr<IPhysFunctor>> functors;
};

class LawDispatcher : public Dispatcher {
	YADE_STOCK_SERIALIZABLE(LawDispatcher)
private:
	abi::Opaque<104, 152> tables;

public:
	vector<shared_ptr<LawFunctor>> functors;
};

} // namespace yade

YADE_STOCK_SERIALIZERS(BoundFunctor)
YADE_STOCK_SERIALIZERS(IGeomFunctor)
YADE_STOCK_SERIALIZERS(IPhysFunctor)
YADE_STOCK_SERIALIZERS(LawFunctor)
