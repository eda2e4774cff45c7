// SPDX-License-Identifier: GPL-2.0-or-later
#define WIDE_LANES 2
#define CONTACT_KERNELS contactKernelsBaseline
#include "KernelVersion.inl"
