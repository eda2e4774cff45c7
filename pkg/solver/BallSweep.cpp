// SPDX-License-Identifier: GPL-2.0-or-later
#include "BallPack.hpp"

namespace contactdynamics {

BallSweep selectBallSweep()
{
#ifdef CONTACTDYNAMICS_HAS_AVX2_SWEEP
	if (__builtin_cpu_supports("avx2")) return ballSweepAvx2;
#endif
	return ballSweepBaseline;
}

BodyAdvance selectBodyAdvance()
{
#ifdef CONTACTDYNAMICS_HAS_AVX2_SWEEP
	if (__builtin_cpu_supports("avx2")) return bodyAdvanceAvx2;
#endif
	return bodyAdvanceBaseline;
}

} // namespace contactdynamics
