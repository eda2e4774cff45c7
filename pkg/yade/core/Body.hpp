// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <core/Bound.hpp>
#include <core/Material.hpp>
#include <core/Shape.hpp>
#include <core/State.hpp>

#include <map>

namespace yade {

class Interaction;

/// A particle, a wall, a clump or a member of one.
class Body : public Serializable {
	YADE_STOCK_SERIALIZABLE(Body)

	using id_t = int;
	using MapId2IntrT = std::map<id_t, shared_ptr<Interaction>>;

	static const id_t ID_NONE;
	enum { FLAG_BOUNDED = 1, FLAG_ASPHERICAL = 2, FLAG_SUBDOMAIN = 4, FLAG_FLUIDDOMAINBBOX = 8 };

	id_t id;
	mask_t groupMask;
	int flags; ///< bits of FLAG_*
	int subdomain;
	shared_ptr<Material> material;
	shared_ptr<State> state;
	shared_ptr<Shape> shape;
	shared_ptr<Bound> bound;
	MapId2IntrT intrs; ///< interactions of this body, by the id of the other one
	id_t clumpId;	   ///< id of the clump this body is, or is a member of; ID_NONE otherwise
	long iterBorn;
	Real timeBorn;

	Body();
	virtual void userForcedDisplacementRedrawHook();

	static const shared_ptr<Body>& byId(id_t id, Scene* scene = nullptr);
	static const shared_ptr<Body>& byId(id_t id, shared_ptr<Scene> scene);

	id_t getId() const { return id; }
	mask_t getGroupMask() const { return groupMask; }
	bool maskOk(int mask) const;
	bool maskCompatible(int mask) const;

	bool isClump() const { return clumpId != ID_NONE && clumpId == id; }
	bool isClumpMember() const { return clumpId != ID_NONE && clumpId != id; }
	bool isStandalone() const { return clumpId == ID_NONE; }
	bool isBounded() const { return flags & FLAG_BOUNDED; }
	bool isAspherical() const { return flags & FLAG_ASPHERICAL; }
	bool getIsSubdomain() const { return flags & FLAG_SUBDOMAIN; }
	bool getIsFluidDomainBbox() const { return flags & FLAG_FLUIDDOMAINBBOX; }
	/// Whether at least one degree of freedom is free.
	bool isDynamic() const { return state->blockedDOFs != State::DOF_ALL; }
};

} // namespace yade

YADE_STOCK_SERIALIZERS(Body)
