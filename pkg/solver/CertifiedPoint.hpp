// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "BlockOperator.hpp"

namespace contactdynamics {

/// Impulses inside their cones, and the certificate there.
template <int D> struct CertifiedPoint {
	double residual = 0;
	std::vector<Eigen::Matrix<double, D, 1>> impulses;
};

/// Keeps the operator's impulses as the best point where its certificate says so; not where it is lost. @return  the certificate
template <int D> double certify(BlockOperator<D>& blocks, CertifiedPoint<D>& best)
{
	const double residual = blocks.certificate();
	if (!(residual < best.residual) || blocks.isLost()) return residual;
	best.residual = residual;
	blocks.impulses(best.impulses);
	return residual;
}

} // namespace contactdynamics
