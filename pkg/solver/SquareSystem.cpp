// SPDX-License-Identifier: GPL-2.0-or-later
#include "SquareSystem.hpp"

namespace contactdynamics {

void SquareSystem::analyse()
{
	if (dense()) return;
	factor.isSymmetric(true);
	factor.analyzePattern(matrix);
}

bool SquareSystem::factorise()
{
	if (dense()) {
		denseFactor.compute(Eigen::MatrixXd(matrix));
		sign = double(denseFactor.permutationP().determinant());
		const Eigen::VectorXd pivots = denseFactor.matrixLU().diagonal();
		for (const double pivot : pivots) sign *= pivot < 0 ? -1 : 1;
		return pivots.allFinite() && (pivots.array() != 0).all();
	}
	factor.factorize(matrix);
	if (factor.info() != Eigen::Success) return false;
	sign = factor.signDeterminant();
	return true;
}

Eigen::VectorXd SquareSystem::solve(const Eigen::VectorXd& b) const
{
	return dense() ? Eigen::VectorXd(denseFactor.solve(b)) : Eigen::VectorXd(factor.solve(b));
}

double SquareSystem::operations() const
{
	const double n = double(matrix.rows());
	return dense() ? double(denseFactor.rows()) * n * n : 2.0 * double(factor.nnzL()) * double(factor.nnzU()) / n;
}

} // namespace contactdynamics
