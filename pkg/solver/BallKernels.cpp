// SPDX-License-Identifier: GPL-2.0-or-later
#include "BallKernels.hpp"

namespace contactdynamics {

const BallKernels* ballKernels(int version)
{
#ifdef CONTACTDYNAMICS_HAS_AVX512_KERNELS
	const bool wide = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
	if (version == 2) return wide ? &ballKernelsAvx512 : nullptr;
#endif
#ifdef CONTACTDYNAMICS_HAS_AVX2_KERNELS
	if (version == 1) return __builtin_cpu_supports("avx2") ? &ballKernelsAvx2 : nullptr;
#endif
	return version == 0 ? &ballKernelsBaseline : nullptr;
}

const BallKernels& widestBallKernels()
{
	int version = ballKernelVersions - 1;
	while (!ballKernels(version)) --version;
	return *ballKernels(version);
}

} // namespace contactdynamics
