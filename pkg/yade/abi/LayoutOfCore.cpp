// SPDX-License-Identifier: GPL-2.0-or-later
// Pins the declarations of pkg/yade to the layout of Debian's yade 2023.02a (amd64, yade-double): sizes, alignments and offsets as measured in its
// libraries. Compiled with every build and linked nowhere.

#include <abi/LayoutChecks.hpp>
#include <lib/factory/Factorable.hpp>
#include <lib/serialization/Serializable.hpp>
#include <core/Aabb.hpp>
#include <core/Body.hpp>
#include <core/BodyContainer.hpp>
#include <core/Bound.hpp>
#include <core/Cell.hpp>
#include <core/Clump.hpp>
#include <core/Dispatcher.hpp>
#include <core/Dispatching.hpp>
#include <core/EnergyTracker.hpp>
#include <core/Engine.hpp>
#include <core/ForceContainer.hpp>
#include <core/Functor.hpp>
#include <core/GlobalEngine.hpp>
#include <core/IGeom.hpp>
#include <core/IPhys.hpp>
#include <core/Interaction.hpp>
#include <core/InteractionContainer.hpp>
#include <core/InteractionLoop.hpp>
#include <core/Material.hpp>
#include <core/Omega.hpp>
#include <core/PartialEngine.hpp>
#include <core/Scene.hpp>
#include <core/Shape.hpp>
#include <core/State.hpp>
#include <core/TimeStepper.hpp>
#include <core/Timing.hpp>

namespace yade {

STOCK_CLASS(Factorable, 24, 24)

STOCK_CLASS(Serializable, 24, 24)

STOCK_CLASS(Aabb, 144, 144)

STOCK_CLASS(Body, 176, 176)
STOCK_MEMBER(Body, id, 24)
STOCK_MEMBER(Body, groupMask, 28)
STOCK_MEMBER(Body, flags, 32)
STOCK_MEMBER(Body, subdomain, 36)
STOCK_MEMBER(Body, material, 40)
STOCK_MEMBER(Body, state, 56)
STOCK_MEMBER(Body, shape, 72)
STOCK_MEMBER(Body, bound, 88)
STOCK_MEMBER(Body, intrs, 104)
STOCK_MEMBER(Body, clumpId, 152)
STOCK_MEMBER(Body, iterBorn, 160)
STOCK_MEMBER(Body, timeBorn, 168)

STOCK_CLASS(BodyContainer, 200, 200)
STOCK_MEMBER(BodyContainer, body, 24)
STOCK_MEMBER(BodyContainer, checkedByCollider, 49)

STOCK_CLASS(Bound, 144, 144)
STOCK_MEMBER(Bound, lastUpdateIter, 32)
STOCK_MEMBER(Bound, refPos, 40)
STOCK_MEMBER(Bound, sweepLength, 64)
STOCK_MEMBER(Bound, color, 72)
STOCK_MEMBER(Bound, min, 96)
STOCK_MEMBER(Bound, max, 120)

STOCK_CLASS(Cell, 1104, 1102)
STOCK_MEMBER(Cell, trsf, 592)
STOCK_MEMBER(Cell, refHSize, 664)
STOCK_MEMBER(Cell, hSize, 736)
STOCK_MEMBER(Cell, prevHSize, 808)
STOCK_MEMBER(Cell, velGrad, 880)
STOCK_MEMBER(Cell, nextVelGrad, 952)
STOCK_MEMBER(Cell, prevVelGrad, 1024)
STOCK_MEMBER(Cell, homoDeform, 1096)
STOCK_MEMBER(Cell, velGradChanged, 1100)
STOCK_MEMBER(Cell, flipFlippable, 1101)

STOCK_CLASS(Clump, 168, 168)
STOCK_MEMBER(Clump, members, 96)
STOCK_MEMBER(Clump, ids, 144)

STOCK_CLASS(Dispatcher, 104, 104)

STOCK_CLASS(BoundFunctor, 88, 88)

STOCK_CLASS(IGeomFunctor, 88, 88)

STOCK_CLASS(IPhysFunctor, 88, 88)

STOCK_CLASS(LawFunctor, 88, 88)

STOCK_CLASS(BoundDispatcher, 216, 216)
STOCK_MEMBER(BoundDispatcher, functors, 152)
STOCK_MEMBER(BoundDispatcher, activated, 176)
STOCK_MEMBER(BoundDispatcher, sweepDist, 184)

STOCK_CLASS(IGeomDispatcher, 184, 184)
STOCK_MEMBER(IGeomDispatcher, functors, 160)

STOCK_CLASS(IPhysDispatcher, 176, 176)
STOCK_MEMBER(IPhysDispatcher, functors, 152)

STOCK_CLASS(LawDispatcher, 176, 176)
STOCK_MEMBER(LawDispatcher, functors, 152)

STOCK_CLASS(EnergyTracker, 176, 176)

STOCK_CLASS(Engine, 104, 104)
STOCK_MEMBER(Engine, scene, 24)
STOCK_MEMBER(Engine, timingInfo, 32)
STOCK_MEMBER(Engine, timingDeltas, 48)
STOCK_MEMBER(Engine, dead, 64)
STOCK_MEMBER(Engine, ompThreads, 68)
STOCK_MEMBER(Engine, label, 72)

STOCK_CLASS(ForceContainer, 304, 304)

STOCK_CLASS(Functor, 80, 80)
STOCK_MEMBER(Functor, timingDeltas, 24)
STOCK_MEMBER(Functor, scene, 40)
STOCK_MEMBER(Functor, label, 48)

STOCK_CLASS(GlobalEngine, 104, 104)

STOCK_CLASS(IGeom, 32, 32)

STOCK_CLASS(IPhys, 32, 32)

STOCK_CLASS(Interaction, 168, 168)
STOCK_MEMBER(Interaction, isActive, 24)
STOCK_MEMBER(Interaction, functorCache, 32)
STOCK_MEMBER(Interaction, id1, 88)
STOCK_MEMBER(Interaction, id2, 92)
STOCK_MEMBER(Interaction, iterMadeReal, 96)
STOCK_MEMBER(Interaction, iterLastSeen, 104)
STOCK_MEMBER(Interaction, geom, 112)
STOCK_MEMBER(Interaction, phys, 128)
STOCK_MEMBER(Interaction, cellDist, 144)
STOCK_MEMBER(Interaction, linIx, 156)
STOCK_MEMBER(Interaction, iterBorn, 160)

STOCK_CLASS(InteractionContainer, 192, 192)
STOCK_MEMBER(InteractionContainer, dirty, 128)

STOCK_CLASS(InteractionLoop, 216, 209)
STOCK_MEMBER(InteractionLoop, geomDispatcher, 136)
STOCK_MEMBER(InteractionLoop, physDispatcher, 152)
STOCK_MEMBER(InteractionLoop, lawDispatcher, 168)

STOCK_CLASS(Material, 80, 80)
STOCK_MEMBER(Material, id, 32)
STOCK_MEMBER(Material, label, 40)
STOCK_MEMBER(Material, density, 72)

STOCK_CLASS(DynlibDescriptor, 56, 49)
STOCK_MEMBER(DynlibDescriptor, baseClasses, 0)
STOCK_MEMBER(DynlibDescriptor, isSerializable, 48)

STOCK_CLASS(Omega, 416, 416)

STOCK_CLASS(PartialEngine, 128, 128)
STOCK_MEMBER(PartialEngine, ids, 104)

STOCK_CLASS(Scene, 752, 752)
STOCK_MEMBER(Scene, forces, 32)
STOCK_MEMBER(Scene, dt, 440)
STOCK_MEMBER(Scene, iter, 448)
STOCK_MEMBER(Scene, subStepping, 456)
STOCK_MEMBER(Scene, subStep, 460)
STOCK_MEMBER(Scene, time, 464)
STOCK_MEMBER(Scene, speed, 472)
STOCK_MEMBER(Scene, stopAtIter, 480)
STOCK_MEMBER(Scene, stopAtTime, 488)
STOCK_MEMBER(Scene, isPeriodic, 496)
STOCK_MEMBER(Scene, trackEnergy, 497)
STOCK_MEMBER(Scene, doSort, 498)
STOCK_MEMBER(Scene, subdomain, 504)
STOCK_MEMBER(Scene, engines, 552)
STOCK_MEMBER(Scene, _nextEngines, 576)
STOCK_MEMBER(Scene, bodies, 600)
STOCK_MEMBER(Scene, interactions, 616)
STOCK_MEMBER(Scene, energy, 632)
STOCK_MEMBER(Scene, materials, 648)
STOCK_MEMBER(Scene, bound, 672)
STOCK_MEMBER(Scene, cell, 688)

STOCK_CLASS(Shape, 96, 90)

STOCK_CLASS(State, 320, 320)
STOCK_MEMBER(State, pos, 32)
STOCK_MEMBER(State, ori, 40)
STOCK_MEMBER(State, se3, 88)
STOCK_MEMBER(State, vel, 144)
STOCK_MEMBER(State, mass, 168)
STOCK_MEMBER(State, angVel, 176)
STOCK_MEMBER(State, angMom, 200)
STOCK_MEMBER(State, inertia, 224)
STOCK_MEMBER(State, refPos, 248)
STOCK_MEMBER(State, refOri, 272)
STOCK_MEMBER(State, blockedDOFs, 304)
STOCK_MEMBER(State, isDamped, 308)
STOCK_MEMBER(State, densityScaling, 312)

STOCK_CLASS(TimeStepper, 112, 112)
STOCK_MEMBER(TimeStepper, active, 104)
STOCK_MEMBER(TimeStepper, timeStepUpdateInterval, 108)

STOCK_CLASS(TimingInfo, 16, 16)
STOCK_MEMBER(TimingInfo, nExec, 0)
STOCK_MEMBER(TimingInfo, nsec, 8)

struct abi::PrivateMembers {
	STOCK_MEMBER(Cell, _vGradTimesPrevH, 168)
	STOCK_MEMBER(Cell, _size, 240)
	STOCK_MEMBER(Cell, _cos, 264)
	STOCK_MEMBER(Cell, _hasShear, 312)
	STOCK_MEMBER(Cell, _shearTrsf, 320)
	STOCK_MEMBER(Cell, _unshearTrsf, 392)
	STOCK_MEMBER(InteractionContainer, linIntrs, 24)
	STOCK_MEMBER(InteractionContainer, currSize, 80)
};

} // namespace yade
