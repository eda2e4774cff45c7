// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>

// Plain data only, no library header: this file is compiled once for the baseline and again for wide instructions, and a library's inline function
// compiled with wide instructions could be picked by the linker for a machine that has none.
namespace contactdynamics {

/// What a sweep reads and writes of one body, in one cache line. The mobilities are those of balls; of other bodies along x, see BodyMobility.
struct alignas(64) BodyState {
	double velocity[3];
	double inverseMass;
	double angularVelocity[3];
	double inverseInertia;
};

/// As many as the widest instructions take at once; narrower ones take a pack in parts.
constexpr int packLanes = 8;

/// Ball contacts that share no moving body, one per lane. A lane without a contact has id -1, zeros, and refers to a body at rest.
///
/// A body index is complemented (~index, negative) when the body cannot move: it is read but never written, so that threads do not meet there.
struct alignas(64) BallPack {
	double normal[3][packLanes];			 ///< from body 1 to body 2
	double gapVelocity[packLanes];			 ///< s, normal image velocity included [m/s]
	double friction[packLanes];				 ///< mu
	double arm1[packLanes], arm2[packLanes]; ///< arms along the normal [m]; arm2 is negative for two convex bodies
	double inverseWn[packLanes];			 ///< 1 / W_nn [kg]
	double inverseWt[packLanes];			 ///< 1 / W_tt [kg]
	double impulse[3][packLanes];			 ///< y: after the last visit, inside the cone, global axes [N s]
	double increment[3][packLanes];			 ///< change of the impulse in the last visit [N s]
	double direction[3][packLanes];			 ///< search direction of the acceleration, one sweep behind [N s]
	std::int32_t body1[packLanes], body2[packLanes];
	std::int32_t id[packLanes]; ///< index of the contact in the problem
};

/// Rolling and twisting friction of the contacts of a BallPack, see RollingContact.hpp; zeros in a lane without.
struct alignas(64) RollingPack {
	double rollingArm[packLanes], twistingArm[packLanes];						   // [m]
	double mobility[packLanes], inverseMobility[packLanes];						   // [1/(kg m2)], [kg m2]
	double drive[3][packLanes];													   // [rad/s]
	double torque[3][packLanes], increment[3][packLanes], direction[3][packLanes]; // [N m s]
};

/// How the next sweep starts: x' = y + relax (y - x) + momentum (x - x_before), for impulses and, by linearity, velocities.
struct Extrapolation {
	double relax = 0, momentum = 0;
};

/// Sums over a run of contacts: what a sweep costs nothing to know.
struct SweepNorms {
	double increment2 = 0; ///< sum of dr^T W dr, dr the change of the impulse in the sweep [J]
	double impulse2 = 0;   ///< sum of r^T W r [J]
};

/// The mean field as one sweep sees it; matrices row by row.
struct FieldPass {
	double gradient[9]; ///< L, the same for the whole sweep: contacts may be visited at the same time [1/s]
	double moment[9];	///< in and out: sum of dr b^T over the contacts visited [kg m2/s]
};

} // namespace contactdynamics
