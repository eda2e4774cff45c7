// SPDX-License-Identifier: GPL-2.0-or-later
// Compiled with -mavx2 (but without fused multiply-add, which would change the bits); called only where the processor has it.
#define BLOCK_PRODUCT_2 blockProduct2Avx2
#define BLOCK_PRODUCT_3 blockProduct3Avx2
#include "BlockRows.inl"
