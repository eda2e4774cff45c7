// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>

// Plain data only, no library header: this file is compiled once for the baseline and once for wide instructions, and a library's inline function
// compiled with wide instructions could be picked by the linker for a machine that has none.
namespace contactdynamics {

/// What a sweep reads and writes of one body, in one cache line. The mobilities are meaningful for bodies with ball contacts only.
struct alignas(64) BodyState {
	double velocity[3];
	double inverseMass;
	double angularVelocity[3];
	double inverseInertia;
};

/// Four ball contacts that share no moving body, one per lane. A lane without a contact has id -1, zeros, and refers to a body at rest.
///
/// A body index is complemented (~index, negative) when the body cannot move: it is read but never written, so that threads do not meet there.
struct alignas(64) BallPack {
	double normal[3][4];	 ///< from body 1 to body 2
	double gapVelocity[4];	 ///< s, normal image velocity included [m/s]
	double friction[4];		 ///< mu
	double arm1[4], arm2[4]; ///< arms along the normal [m]; arm2 is negative for two convex bodies
	double inverseWn[4];	 ///< 1 / W_nn [kg]
	double inverseWt[4];	 ///< 1 / W_tt [kg]
	double impulse[3][4];	 ///< y: after the last visit, inside the cone, global axes [N s]
	double increment[3][4];	 ///< change of the impulse in the last visit [N s]
	double direction[3][4];	 ///< search direction of the acceleration, one sweep behind [N s]
	std::int32_t body1[4], body2[4];
	std::int32_t id[4]; ///< index of the contact in the problem
};

/// Rolling and twisting friction of the four contacts of a BallPack, see RollingContact.hpp; zeros in a lane without.
struct alignas(64) RollingPack {
	double rollingArm[4], twistingArm[4];				   // [m]
	double mobility[4], inverseMobility[4];				   // [1/(kg m2)], [kg m2]
	double drive[3][4];									   // [rad/s]
	double torque[3][4], increment[3][4], direction[3][4]; // [N m s]
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
	double gradient[9]; ///< L, the same for the whole sweep: contacts of a colour may be visited in any order [1/s]
	double moment[9];	///< in and out: sum of dr b^T over the contacts visited [kg m2/s]
};

/// One visit of each contact of the packs, in any order: exact one-contact solution for W = diag(Wn, Wt, Wt) at the
/// extrapolated impulse; the velocities are expected extrapolated already.
/// @param rolling  parallel to packs, null where no contact has rolling friction;  @param field  null where there is no mean field
using BallSweep = SweepNorms (*)(BodyState* bodies, BallPack* packs, RollingPack* rolling, std::size_t count, Extrapolation extrapolation,
								 FieldPass* field);

SweepNorms ballSweepBaseline(BodyState* bodies, BallPack* packs, RollingPack* rolling, std::size_t count, Extrapolation extrapolation,
							 FieldPass* field);
SweepNorms ballSweepAvx2(BodyState* bodies, BallPack* packs, RollingPack* rolling, std::size_t count, Extrapolation extrapolation, FieldPass* field);

/// Moves bodies to the extrapolated point. Of `start` and `direction` the mobilities are those of the bodies and zero, so that they stay what they
/// are.
/// @param now  velocities after the last sweep;  @param start  those before it;  @param direction  search direction; all three are updated
using BodyAdvance = void (*)(BodyState* now, BodyState* start, BodyState* direction, std::size_t count, Extrapolation extrapolation);

void bodyAdvanceBaseline(BodyState* now, BodyState* start, BodyState* direction, std::size_t count, Extrapolation extrapolation);
void bodyAdvanceAvx2(BodyState* now, BodyState* start, BodyState* direction, std::size_t count, Extrapolation extrapolation);

/// Round-off of a velocity that is a sum of terms of some sizes: a share of their sum, bounded; see NaturalMap.hpp.
struct RoundOff {
	double perSpeed; ///< [-]
	double most;	 ///< [m/s]
};

/// Sums of the certificate over a run of contacts, and the largest approach speed among them.
struct CertificateSums {
	double map2 = 0;	 ///< sum of F^T W F, F the natural map of NaturalMap.hpp [J]
	double impulse2 = 0; ///< sum of r^T W r [J]
	double approach = 0; ///< [m/s]
};

/// Adds to the velocities, and to the moment of the field, what the impulses of the packs give.
using BallRebuild = void (*)(BodyState* bodies, const BallPack* packs, const RollingPack* rolling, std::size_t count, FieldPass* field);

void ballRebuildBaseline(BodyState* bodies, const BallPack* packs, const RollingPack* rolling, std::size_t count, FieldPass* field);
void ballRebuildAvx2(BodyState* bodies, const BallPack* packs, const RollingPack* rolling, std::size_t count, FieldPass* field);

/// The certificate of ball contacts at the impulses of the packs and the velocities of the bodies.
/// @param gradient  of the mean field, row by row; null where there is none [1/s]
using BallCertify = CertificateSums (*)(const BodyState* bodies, const BallPack* packs, const RollingPack* rolling, std::size_t count,
										RoundOff roundOff, const double* gradient);

CertificateSums ballCertifyBaseline(const BodyState* bodies, const BallPack* packs, const RollingPack* rolling, std::size_t count, RoundOff roundOff,
									const double* gradient);
CertificateSums ballCertifyAvx2(const BodyState* bodies, const BallPack* packs, const RollingPack* rolling, std::size_t count, RoundOff roundOff,
								const double* gradient);

/// The widest versions this machine can run. All versions give the same bits.
BallSweep selectBallSweep();
BodyAdvance selectBodyAdvance();
BallRebuild selectBallRebuild();
BallCertify selectBallCertify();

} // namespace contactdynamics
