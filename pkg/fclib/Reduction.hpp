// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <pkg/solver/BlockProblem.hpp>

namespace contactdynamics::fclib {

using Sparse = Eigen::SparseMatrix<double>;

/// W and q after the elimination of other unknowns: u = W r + q.
struct Reduced {
	Sparse W;
	Eigen::VectorXd q;
};

/// K x = B r + c,  u = C^T x + w   gives   W = C^T K^-1 B,  q = C^T K^-1 c + w.
/// By sparse LU and not Cholesky: M may be unsymmetric (gyroscopic terms), and with equality constraints K is indefinite.
/// @throws std::domain_error  K is singular
Reduced eliminate(const Sparse& K, const Sparse& B, const Eigen::VectorXd& c, const Sparse& C, const Eigen::VectorXd& w);

/// (top left, top right; bottom left, bottom right)
Sparse bordered(const Sparse& topLeft, const Sparse& topRight, const Sparse& bottomLeft);

/// W in blocks of dimension x dimension; a diagonal block is made where W has none.
BlockProblem blocksOf(int dimension, const Sparse& W, const Eigen::VectorXd& q, std::vector<double> friction);

/// The inverse of blocksOf().
Sparse matrixOf(const BlockProblem& problem);

} // namespace contactdynamics::fclib
