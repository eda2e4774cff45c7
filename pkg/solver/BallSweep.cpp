// SPDX-License-Identifier: GPL-2.0-or-later
#include "BallPack.hpp"

namespace contactdynamics {

#ifdef CONTACTDYNAMICS_HAS_AVX2_SWEEP
BallSweep selectBallSweep() { return __builtin_cpu_supports("avx2") ? ballSweepAvx2 : ballSweepBaseline; }
BodyAdvance selectBodyAdvance() { return __builtin_cpu_supports("avx2") ? bodyAdvanceAvx2 : bodyAdvanceBaseline; }
BallRebuild selectBallRebuild() { return __builtin_cpu_supports("avx2") ? ballRebuildAvx2 : ballRebuildBaseline; }
BallCertify selectBallCertify() { return __builtin_cpu_supports("avx2") ? ballCertifyAvx2 : ballCertifyBaseline; }
#else
BallSweep selectBallSweep() { return ballSweepBaseline; }
BodyAdvance selectBodyAdvance() { return bodyAdvanceBaseline; }
BallRebuild selectBallRebuild() { return ballRebuildBaseline; }
BallCertify selectBallCertify() { return ballCertifyBaseline; }
#endif

} // namespace contactdynamics
