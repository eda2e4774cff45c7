// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>

// Plain data only, no library header: compiled once for the baseline and once for wide instructions, see BallPack.hpp.
namespace contactdynamics {

/// What a product with rows of W reads; see BlockProblem for the arrays.
struct BlockRows {
	const std::int32_t *rowStart, *column;
	const double *blocks, *q;
};

/// Impulse of a contact as the products read it: three dimensions (N, T1, T2, 0), two (N, T, N, T).
struct alignas(32) ImpulseLanes {
	double lane[4] = {0, 0, 0, 0};
};

/// u = W r + q of the contacts from ... to - 1, one after the other, D numbers each. The blocks are used where they lie: each row of a block times
/// the impulse is one wide product.
using BlockProduct = void (*)(const BlockRows& rows, const ImpulseLanes* r, std::size_t from, std::size_t to, double* u);

/// The widest version this machine can run, D = 2 or 3. All versions give the same bits.
template <int D> BlockProduct selectBlockProduct();

void blockProduct2Baseline(const BlockRows&, const ImpulseLanes*, std::size_t, std::size_t, double*);
void blockProduct3Baseline(const BlockRows&, const ImpulseLanes*, std::size_t, std::size_t, double*);
void blockProduct2Avx2(const BlockRows&, const ImpulseLanes*, std::size_t, std::size_t, double*);
void blockProduct3Avx2(const BlockRows&, const ImpulseLanes*, std::size_t, std::size_t, double*);

} // namespace contactdynamics
