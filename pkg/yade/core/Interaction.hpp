// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <core/Body.hpp>
#include <core/IGeom.hpp>
#include <core/IPhys.hpp>

namespace yade {

class IGeomFunctor;
class IPhysFunctor;
class LawFunctor;

/// A pair of bodies whose bounds overlap; a real one if it has geometry and physics.
class Interaction : public Serializable {
	YADE_STOCK_SERIALIZABLE(Interaction)

	bool isActive;
	/// Functors that InteractionLoop calls for this pair.
	struct {
		bool geomExists; ///< whether an IGeom functor for the pair of shapes exists
		shared_ptr<IGeomFunctor> geom;
		shared_ptr<IPhysFunctor> phys;
		shared_ptr<LawFunctor> constLaw;
	} functorCache;
	Body::id_t id1;
	Body::id_t id2;
	long iterMadeReal; ///< step in which it became real; -1 otherwise
	long iterLastSeen; ///< not initialised by YADE for interactions that the collider makes
	shared_ptr<IGeom> geom;
	shared_ptr<IPhys> phys;
	Vector3i cellDist; ///< body 2 is to be shifted by so many periods of the cell
	int linIx;
	long iterBorn;

	Interaction();
	Interaction(Body::id_t id1, Body::id_t id2);

	bool isReal() const { return geom && phys; }
	bool isFresh(Scene* scene);
	const Body::id_t& getId1() const { return id1; }
	const Body::id_t& getId2() const { return id2; }
	void swapOrder();
};

} // namespace yade

YADE_STOCK_SERIALIZERS(Interaction)
