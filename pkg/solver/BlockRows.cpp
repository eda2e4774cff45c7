// SPDX-License-Identifier: GPL-2.0-or-later
#include "BlockRows.hpp"

namespace contactdynamics {

#ifdef CONTACTDYNAMICS_HAS_AVX2_KERNELS
template <> BlockProduct selectBlockProduct<2>() { return __builtin_cpu_supports("avx2") ? blockProduct2Avx2 : blockProduct2Baseline; }
template <> BlockProduct selectBlockProduct<3>() { return __builtin_cpu_supports("avx2") ? blockProduct3Avx2 : blockProduct3Baseline; }
#else
template <> BlockProduct selectBlockProduct<2>() { return blockProduct2Baseline; }
template <> BlockProduct selectBlockProduct<3>() { return blockProduct3Baseline; }
#endif

} // namespace contactdynamics
