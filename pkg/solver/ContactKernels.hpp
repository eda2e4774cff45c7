// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "GeneralPack.hpp"

namespace contactdynamics {

/// One visit of each contact of the packs, in any order: exact one-contact solution for W = diag(Wn, Wt, Wt) at the
/// extrapolated impulse; the velocities are expected extrapolated already.
/// @param rolling  parallel to packs, null where no contact has rolling friction;  @param field  null where there is no mean field
using BallSweep = SweepNorms (*)(BodyState* bodies, BallPack* packs, RollingPack* rolling, std::size_t count, Extrapolation extrapolation,
								 FieldPass* field);

/// Moves bodies to the extrapolated point. Of `start` and `direction` the mobilities are those of the bodies and zero, so that they stay what they
/// are.
/// @param now  velocities after the last sweep;  @param start  those before it;  @param direction  search direction; all three are updated
using BodyAdvance = void (*)(BodyState* now, BodyState* start, BodyState* direction, std::size_t count, Extrapolation extrapolation);

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

/// The certificate of ball contacts at the impulses of the packs and the velocities of the bodies.
/// @param gradient  of the mean field, row by row; null where there is none [1/s]
using BallCertify = CertificateSums (*)(const BodyState* bodies, const BallPack* packs, const RollingPack* rolling, std::size_t count,
										RoundOff roundOff, const double* gradient);

/// The same three for general contacts, with W of any form. Mobilities are parallel to the bodies.
using GeneralSweep = SweepNorms (*)(BodyState* bodies, const BodyMobility* mobilities, GeneralPack* packs, RollingPack* rolling, std::size_t count,
									Extrapolation extrapolation, FieldPass* field);
using GeneralRebuild = void (*)(BodyState* bodies, const BodyMobility* mobilities, const GeneralPack* packs, const RollingPack* rolling,
								std::size_t count, FieldPass* field);
using GeneralCertify = CertificateSums (*)(const BodyState* bodies, const BodyMobility* mobilities, const GeneralPack* packs,
										   const RollingPack* rolling, std::size_t count, RoundOff roundOff, const double* gradient);

/// One version of all of them. All versions give the same bits.
struct ContactKernels {
	BodyAdvance advance;
	BallSweep sweep;
	BallRebuild rebuild;
	BallCertify certify;
	GeneralSweep sweepGeneral;
	GeneralRebuild rebuildGeneral;
	GeneralCertify certifyGeneral;
};

constexpr int contactKernelVersions = 3; ///< for the baseline of the machine's family, for AVX2, for AVX-512
/// Null where this machine, or the build, has no such version.
const ContactKernels* contactKernels(int version);
const ContactKernels& widestContactKernels();

extern const ContactKernels contactKernelsBaseline, contactKernelsAvx2, contactKernelsAvx512;

} // namespace contactdynamics
