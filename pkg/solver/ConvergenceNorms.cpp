// SPDX-License-Identifier: GPL-2.0-or-later
#include "ConvergenceNorms.hpp"

#include "OneContact.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace contactdynamics {

ConvergenceNorms convergenceNorms(const BlockProblem& problem)
{
	if (problem.dimension != 3) throw std::invalid_argument("convergenceNorms: the problem must have dimension 3");
	using Row = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;
	const auto at = [](const std::vector<double>& values, std::size_t i) { return Eigen::Map<const Vector3>(&values[3 * i]); };
	ConvergenceNorms norms;
	norms.naturalMap = residualOf(problem, Measure::naturalMap);
	norms.siconos = residualOf(problem, Measure::siconos);
	double dV2 = 0, WR2 = 0, dV2R2 = 0, RWR = 0, RdV = 0, dR2 = 0, R2 = 0, largest2 = 0;
	for (std::size_t i = 0; i < problem.contacts(); ++i) {
		Vector3 u = at(problem.q, i);
		Matrix3 W = Matrix3::Zero();
		for (std::int32_t k = problem.rowStart[i]; k < problem.rowStart[i + 1]; ++k) {
			const Row block(&problem.blocks[9 * std::size_t(k)]);
			u += block * at(problem.impulse, std::size_t(problem.column[k]));
			if (std::size_t(problem.column[k]) == i) W += block;
		}
		const Vector3 R = at(problem.impulse, i), dR = OneContact(W).solve(u - W * R, problem.friction[i]) - R;
		if (R.isZero(0) && dR.isZero(0)) continue;
		++norms.active;
		const Vector3 WR = W * R, dV = W * dR;
		dV2 += dV.squaredNorm();
		WR2 += WR.squaredNorm();
		dV2R2 += dV.squaredNorm() * R.squaredNorm();
		RWR += R.dot(WR);
		RdV += R.dot(dV);
		dR2 += dR.squaredNorm();
		R2 += R.squaredNorm();
		largest2 = std::max(largest2, dR.squaredNorm());
	}
	if (norms.active == 0) return norms;
	const auto over = [](double above, double below) { return below > 0 ? above / below : above; };
	norms.quadDV = std::sqrt(over(dV2, WR2));
	norms.quadDVR = over(std::sqrt(dV2R2 / norms.active), RWR / norms.active);
	norms.meanDVoR = over(RdV, RWR);
	norms.quadraticAccuracy = std::sqrt(over(dR2, R2));
	norms.largestAccuracy = std::sqrt(over(largest2, R2 / norms.active));
	return norms;
}

} // namespace contactdynamics
