// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <core/Body.hpp>
#include <core/BodyContainer.hpp>
#include <core/Cell.hpp>
#include <core/EnergyTracker.hpp>
#include <core/Engine.hpp>
#include <core/ForceContainer.hpp>
#include <core/InteractionContainer.hpp>
#include <core/Material.hpp>

namespace yade {

/// A whole simulation.
class Scene : public Serializable {
	YADE_STOCK_SERIALIZABLE(Scene)

private:
	abi::Opaque<24, 32> hostNameMax;

public:
	ForceContainer forces;

private:
	abi::Opaque<336, 440> speedAndRenderer;

public:
	Real dt; ///< time step [s]
	long iter;
	bool subStepping;
	int subStep;
	Real time;	///< [s]
	Real speed; ///< [steps/s]
	long stopAtIter;
	Real stopAtTime;
	bool isPeriodic;
	bool trackEnergy;
	bool doSort;

private:
	abi::Opaque<499, 504> checksAndSelection;

public:
	int subdomain; ///< rank of the process in a distributed run; 0 otherwise

private:
	abi::Opaque<508, 552> subdomainShapeAndTags;

public:
	vector<shared_ptr<Engine>> engines;
	vector<shared_ptr<Engine>> _nextEngines;
	shared_ptr<BodyContainer> bodies;
	shared_ptr<InteractionContainer> interactions;
	shared_ptr<EnergyTracker> energy;
	vector<shared_ptr<Material>> materials;
	shared_ptr<Bound> bound;
	shared_ptr<Cell> cell; ///< always there; meaningful if isPeriodic

private:
	abi::Opaque<704, 752> parameters;

public:
	Scene();
};

} // namespace yade
