// SPDX-License-Identifier: GPL-2.0-or-later
// Compiled with -mavx2 (but without fused multiply-add, which would change the bits); called only where the processor has it.
#define WIDE_LANES 4
#define CONTACT_KERNELS contactKernelsAvx2
#include "KernelVersion.inl"
