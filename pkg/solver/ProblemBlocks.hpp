// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "BlockProblem.hpp"

#include <Eigen/Dense>
#include <algorithm>

namespace contactdynamics {

template <int D> using ConstBlock = Eigen::Map<const Eigen::Matrix<double, D, D, Eigen::RowMajor>>;

/// Block k of the problem [1/kg].
template <int D> ConstBlock<D> blockOf(const BlockProblem& problem, int k) { return ConstBlock<D>(&problem.blocks[D * D * std::size_t(k)]); }

/// Sum of the blocks of row i in column i [1/kg]: one block may be given in parts.
template <int D> Eigen::Matrix<double, D, D> diagonalBlockOf(const BlockProblem& problem, std::size_t i)
{
	Eigen::Matrix<double, D, D> W = Eigen::Matrix<double, D, D>::Zero();
	for (int k = problem.rowStart[i]; k < problem.rowStart[i + 1]; ++k)
		if (std::size_t(problem.column[k]) == i) W += blockOf<D>(problem, k);
	return W;
}

/// The largest approach without any impulse, of all contacts; 0 where none closes [m/s].
template <int D> double largestFreeApproach(const BlockProblem& problem)
{
	double largest = 0;
	for (std::size_t i = 0; i < problem.contacts(); ++i) largest = std::max(largest, -problem.q[D * i]);
	return largest;
}

} // namespace contactdynamics
