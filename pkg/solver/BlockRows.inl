// SPDX-License-Identifier: GPL-2.0-or-later
// Body of one version of the products; included by BlockRowsBaseline.cpp and BlockRowsAvx2.cpp after BLOCK_PRODUCT_2 and _3 name the functions.
#include "BlockRows.hpp"

namespace contactdynamics {

namespace {

typedef double Wide __attribute__((vector_size(32)));
typedef double Unaligned __attribute__((vector_size(32), aligned(8), may_alias));

inline Wide load(const double* p) { return *reinterpret_cast<const Unaligned*>(p); }
inline void store(double* p, Wide a) { *reinterpret_cast<Unaligned*>(p) = a; }

} // namespace

void BLOCK_PRODUCT_2(const BlockRows& rows, ImpulseLanes* r, std::size_t from, std::size_t to, double* u, const double* before)
{
	if (before) store(r[from - 1].lane, Wide{before[0], before[1], before[0], before[1]});
	for (std::size_t i = from; i < to; ++i, u += 2) {
		Wide even{0, 0, 0, 0}, odd = even; // two chains of sums, because the processor waits for each addition
		std::int32_t k = rows.rowStart[i];
		const std::int32_t end = rows.rowStart[i + 1];
		for (; k + 1 < end; k += 2) {
			even += load(rows.blocks + 4 * std::size_t(k)) * load(r[rows.column[k]].lane);
			odd += load(rows.blocks + 4 * std::size_t(k) + 4) * load(r[rows.column[k + 1]].lane);
		}
		if (k < end) even += load(rows.blocks + 4 * std::size_t(k)) * load(r[rows.column[k]].lane);
		even += odd;
		u[0] = rows.q[2 * i] + (even[0] + even[1]);
		u[1] = rows.q[2 * i + 1] + (even[2] + even[3]);
	}
}

void BLOCK_PRODUCT_3(const BlockRows& rows, ImpulseLanes* r, std::size_t from, std::size_t to, double* u, const double* before)
{
	if (before) store(r[from - 1].lane, Wide{before[0], before[1], before[2], 0});
	for (std::size_t i = from; i < to; ++i, u += 3) {
		Wide n{0, 0, 0, 0}, s = n, t = n, n1 = n, s1 = n, t1 = n;
		// Lanes 0 to 2 of the first two rows, 1 to 3 of the third: so nothing is read beyond the block. The lane left over is not used.
		const auto add = [&](std::int32_t k, Wide& first, Wide& second, Wide& third) {
			const double* w = rows.blocks + 9 * std::size_t(k);
			const Wide x = load(r[rows.column[k]].lane), shifted = __builtin_shufflevector(x, x, 3, 0, 1, 2);
			first += load(w) * x;
			second += load(w + 3) * x;
			third += load(w + 5) * shifted;
		};
		std::int32_t k = rows.rowStart[i];
		const std::int32_t end = rows.rowStart[i + 1];
		for (; k + 1 < end; k += 2) {
			add(k, n, s, t);
			add(k + 1, n1, s1, t1);
		}
		if (k < end) add(k, n, s, t);
		n += n1;
		s += s1;
		t += t1;
		u[0] = rows.q[3 * i] + ((n[0] + n[1]) + n[2]);
		u[1] = rows.q[3 * i + 1] + ((s[0] + s[1]) + s[2]);
		u[2] = rows.q[3 * i + 2] + ((t[1] + t[2]) + t[3]);
	}
}

} // namespace contactdynamics
