// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "BlockProblem.hpp"

#include <Eigen/Core>

#include <limits>
#include <vector>

namespace contactdynamics {

/// Contacts of a block problem on which no other one acts: one visit from no impulse at all solves them for good, whatever the others do.
/// Where all are, BlocksApart.hpp does without an operator.
template <int D> struct ContactsApart {
	std::vector<std::size_t> apart, others; ///< both empty until sortOut(), and where it is not worth while

	void sortOut(const BlockProblem& problem)
	{
		for (std::size_t i = 0; i < problem.contacts(); ++i) (isApart(problem, i) ? apart : others).push_back(i);
		if (8 * apart.size() >= problem.contacts()) return;
		apart.clear(); // gaps in the order of the visits cost more than they save
		others.clear();
	}

private:
	/// Its block must be symmetric to round-off: a visit uses the symmetric part and is otherwise a step only, see BlockOperator::diagonalBlock().
	static bool isApart(const BlockProblem& problem, std::size_t i)
	{
		if (problem.rowStart[i + 1] - problem.rowStart[i] > 1) return false;
		const Eigen::Map<const Eigen::Matrix<double, D, D>> W(&problem.blocks[D * D * std::size_t(problem.rowStart[i])]);
		return (W - W.transpose()).cwiseAbs().maxCoeff() <= 4 * std::numeric_limits<double>::epsilon() * W.cwiseAbs().maxCoeff();
	}
};

} // namespace contactdynamics
