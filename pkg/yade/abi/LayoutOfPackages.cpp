// SPDX-License-Identifier: GPL-2.0-or-later
// Pins the declarations of pkg/yade to the layout of Debian's yade 2023.02a (amd64, yade-double): sizes, alignments and offsets as measured in its
// libraries. Compiled with every build and linked nowhere.

#include <abi/LayoutChecks.hpp>
#include <pkg/common/BoundaryController.hpp>
#include <pkg/common/Box.hpp>
#include <pkg/common/Collider.hpp>
#include <pkg/common/CombinedKinematicEngine.hpp>
#include <pkg/common/ElastMat.hpp>
#include <pkg/common/Facet.hpp>
#include <pkg/common/FieldApplier.hpp>
#include <pkg/common/NormShearPhys.hpp>
#include <pkg/common/Sphere.hpp>
#include <pkg/common/Wall.hpp>
#include <pkg/dem/DemXDofGeom.hpp>
#include <pkg/dem/FrictPhys.hpp>
#include <pkg/dem/NewtonIntegrator.hpp>
#include <pkg/dem/PeriIsoCompressor.hpp>
#include <pkg/dem/ScGeom.hpp>
#include <pkg/dem/TriaxialStressController.hpp>
#include <pkg/polyhedra/Polyhedra.hpp>

namespace yade {

STOCK_CLASS(BoundaryController, 104, 104)

STOCK_CLASS(Box, 120, 120)
STOCK_MEMBER(Box, extents, 96)

STOCK_CLASS(Collider, 128, 124)
STOCK_MEMBER(Collider, boundDispatcher, 104)
STOCK_MEMBER(Collider, avoidSelfInteractionMask, 120)

STOCK_CLASS(CombinedKinematicEngine, 152, 152)
STOCK_MEMBER(CombinedKinematicEngine, comb, 128)

STOCK_CLASS(ElastMat, 96, 96)
STOCK_MEMBER(ElastMat, young, 80)
STOCK_MEMBER(ElastMat, poisson, 88)

STOCK_CLASS(FrictMat, 104, 104)
STOCK_MEMBER(FrictMat, frictionAngle, 96)

STOCK_CLASS(Facet, 328, 328)
STOCK_MEMBER(Facet, ne, 96)
STOCK_MEMBER(Facet, icr, 168)
STOCK_MEMBER(Facet, vl, 176)
STOCK_MEMBER(Facet, vu, 200)
STOCK_MEMBER(Facet, vertices, 272)
STOCK_MEMBER(Facet, normal, 296)
STOCK_MEMBER(Facet, area, 320)

STOCK_CLASS(FieldApplier, 112, 108)

STOCK_CLASS(NormPhys, 64, 64)
STOCK_MEMBER(NormPhys, kn, 32)
STOCK_MEMBER(NormPhys, normalForce, 40)

STOCK_CLASS(NormShearPhys, 96, 96)
STOCK_MEMBER(NormShearPhys, ks, 64)
STOCK_MEMBER(NormShearPhys, shearForce, 72)

STOCK_CLASS(Sphere, 104, 104)
STOCK_MEMBER(Sphere, radius, 96)

STOCK_CLASS(Wall, 104, 100)
STOCK_MEMBER(Wall, sense, 92)
STOCK_MEMBER(Wall, axis, 96)

STOCK_CLASS(GenericSpheresContact, 96, 96)
STOCK_MEMBER(GenericSpheresContact, normal, 32)
STOCK_MEMBER(GenericSpheresContact, contactPoint, 56)
STOCK_MEMBER(GenericSpheresContact, refR1, 80)
STOCK_MEMBER(GenericSpheresContact, refR2, 88)

STOCK_CLASS(FrictPhys, 104, 104)
STOCK_MEMBER(FrictPhys, tangensOfFrictionAngle, 96)

STOCK_CLASS(NewtonIntegrator, 432, 428)
STOCK_MEMBER(NewtonIntegrator, densityScaling, 216)
STOCK_MEMBER(NewtonIntegrator, damping, 256)
STOCK_MEMBER(NewtonIntegrator, gravity, 264)
STOCK_MEMBER(NewtonIntegrator, maxVelocitySq, 288)
STOCK_MEMBER(NewtonIntegrator, exactAsphericalRot, 296)
STOCK_MEMBER(NewtonIntegrator, prevVelGrad, 304)
STOCK_MEMBER(NewtonIntegrator, prevCellSize, 376)
STOCK_MEMBER(NewtonIntegrator, warnNoForceReset, 400)
STOCK_MEMBER(NewtonIntegrator, dampGravity, 409)
STOCK_MEMBER(NewtonIntegrator, mask, 424)

STOCK_CLASS(Peri3dController, 1232, 1232)
STOCK_MEMBER(Peri3dController, stressMask, 800)

STOCK_CLASS(PeriTriaxController, 488, 484)
STOCK_MEMBER(PeriTriaxController, stressMask, 136)

STOCK_CLASS(Polyhedra, 384, 384)
STOCK_MEMBER(Polyhedra, v, 328)
STOCK_MEMBER(Polyhedra, seed, 352)
STOCK_MEMBER(Polyhedra, size, 360)

STOCK_CLASS(ScGeom, 192, 192)
STOCK_MEMBER(ScGeom, radius1, 144)
STOCK_MEMBER(ScGeom, radius2, 152)
STOCK_MEMBER(ScGeom, penetrationDepth, 160)
STOCK_MEMBER(ScGeom, shearInc, 168)

STOCK_CLASS(TriaxialStressController, 1088, 1081)
STOCK_MEMBER(TriaxialStressController, stressMask, 1000)
STOCK_MEMBER(TriaxialStressController, internalCompaction, 1048)

} // namespace yade
