// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <Eigen/Dense>
#include <Eigen/SparseLU>

namespace contactdynamics {

/// A square matrix with its LU factors: sparse, ordered by minimum degree, from a hundred unknowns on, dense below, where that is quicker.
class SquareSystem {
public:
	Eigen::SparseMatrix<double> matrix;

	void analyse();	  ///< after the pattern of the matrix has changed
	bool factorise(); ///< @return false when the matrix is singular to machine precision; there are no factors then

	Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
	double signOfDeterminant() const { return sign; } ///< of the last factorise()
	double operations() const;						  ///< of the last factorise(), an estimate by the size of its factors; 0 before

private:
	Eigen::SparseLU<Eigen::SparseMatrix<double>, Eigen::AMDOrdering<int>> factor;
	Eigen::PartialPivLU<Eigen::MatrixXd> denseFactor;
	double sign = 1;

	bool dense() const { return matrix.rows() < 100; }
};

} // namespace contactdynamics
