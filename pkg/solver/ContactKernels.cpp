// SPDX-License-Identifier: GPL-2.0-or-later
#include "ContactKernels.hpp"

namespace contactdynamics {

const ContactKernels* contactKernels(int version)
{
#ifdef CONTACTDYNAMICS_HAS_AVX512_KERNELS
	const bool wide = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
	if (version == 2) return wide ? &contactKernelsAvx512 : nullptr;
#endif
#ifdef CONTACTDYNAMICS_HAS_AVX2_KERNELS
	if (version == 1) return __builtin_cpu_supports("avx2") ? &contactKernelsAvx2 : nullptr;
#endif
	return version == 0 ? &contactKernelsBaseline : nullptr;
}

const ContactKernels& widestContactKernels()
{
	int version = contactKernelVersions - 1;
	while (!contactKernels(version)) --version;
	return *contactKernels(version);
}

} // namespace contactdynamics
