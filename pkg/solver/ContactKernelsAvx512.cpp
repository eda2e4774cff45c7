// SPDX-License-Identifier: GPL-2.0-or-later
// Compiled for AVX-512 (but without fused multiply-add, which would change the bits); called only where the processor has it.
#define WIDE_LANES 8
#define CONTACT_KERNELS contactKernelsAvx512
#include "KernelVersion.inl"
