// SPDX-License-Identifier: GPL-2.0-or-later
#define BLOCK_PRODUCT_2 blockProduct2Baseline
#define BLOCK_PRODUCT_3 blockProduct3Baseline
#include "BlockRows.inl"
