// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "BallPack.hpp"

namespace contactdynamics {

// Plain data only, as in BallPack.hpp.

/// Mobilities of a body that BodyState has no place for: only contacts that are not of balls ask for them. Constant in a sweep.
struct alignas(64) BodyMobility {
	double inverseMassY, inverseMassZ; ///< along x: BodyState::inverseMass [1/kg]
	double diagonal[3], yz, zx, xy;	   ///< of the inverse inertia, global axes [1/(kg m2)]
};

/// Contacts with any W, of clumps and blocks or with blocked degrees of freedom, that share no moving body; lanes as in BallPack.
///
/// The tangents of the frame are the eigenvectors of A (PrincipalContact.hpp): t1 is stored, t2 = n x t1. Impulses are in this frame, normal first.
/// W is that of the visits, compliance included: see PrincipalContact.hpp for its numbers, and GrainOperator::startField().
struct alignas(64) GeneralPack {
	double normal[3][packLanes], tangent[3][packLanes];					 ///< n, t1
	double arm1[3][packLanes], arm2[3][packLanes];						 ///< [m]
	double offset[3][packLanes];										 ///< image velocity in the frame, plus the gap velocity on the normal [m/s]
	double normalCompliance[packLanes], tangentialCompliance[packLanes]; ///< on the diagonal of W: what the velocities do not know [1/kg]
	double Wnn[packLanes], wLarge[packLanes], wSmall[packLanes], largeEigen[packLanes], smallEigen[packLanes], roundOff[packLanes]; ///< W [1/kg]
	double friction[packLanes];																										///< mu >= 0 [-]
	double slidingRate[packLanes];	///< of the last visit in which it slid, 0: unknown [1/kg]
	double impulse[3][packLanes];	///< r: after the last visit, inside the cone [N s]
	double increment[3][packLanes]; ///< change of the impulse in the last visit [N s]
	double direction[3][packLanes]; ///< search direction of the acceleration, one sweep behind [N s]
	std::int32_t body1[packLanes], body2[packLanes];
	std::int32_t id[packLanes];
};

} // namespace contactdynamics
