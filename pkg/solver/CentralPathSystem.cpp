// SPDX-License-Identifier: GPL-2.0-or-later
#include "CentralPathSystem.hpp"

#include "ProblemBlocks.hpp"
#include "SmoothedContact.hpp"

#include <limits>

namespace contactdynamics {

namespace {
constexpr double leastFriction = 1e-100; // its inverse squared must be a number
} // namespace

template <int D> CentralPathSystem<D>::CentralPathSystem(const BlockProblem& problem) : rowStart(problem.rowStart), column(problem.column)
{
	describe(problem);
	system.layOut(rowStart, column);
	for (Eigen::VectorXd* vector : {&r, &F, &terms, &rateOfR, &rateOfLog}) vector->resize(unknowns());
	slope.resize(scale.size());
}

template <int D> void CentralPathSystem<D>::describe(const BlockProblem& problem)
{
	const std::size_t count = problem.contacts();
	for (std::size_t i = 0; i < count; ++i) {
		const Block own = diagonalBlockOf<D>(problem, i);
		const double mu = problem.friction[i];
		Vector factors = Vector::Ones();
		const bool rough = mu > leastFriction;
		if (rough) factors[0] = 1 / mu;
		const double mean = rough ? factors.cwiseAbs2().dot(own.diagonal()) / D : own(0, 0);
		law.push_back(!(own(0, 0) > 0 && mean > 0) ? Law::none : rough ? Law::coulomb : Law::frictionless);
		scale.push_back(law.back() == Law::none ? Vector(Vector::Ones()) : Vector(factors / std::sqrt(mean)));
	}
	for (std::size_t i = 0; i < count; ++i)
		for (int k = rowStart[i]; k < rowStart[i + 1]; ++k)
			W.push_back(scale[i].asDiagonal() * Block(blockOf<D>(problem, k)) * scale[std::size_t(column[k])].asDiagonal());
	q.resize(unknowns());
	for (std::size_t i = 0; i < count; ++i) q.segment<D>(D * i) = scale[i].cwiseProduct(Eigen::Map<const Vector>(&problem.q[D * i]));
	size = q.stableNorm() / std::sqrt(double(count));
	if (size > 0) q /= size;
}

template <int D> typename CentralPathSystem<D>::Contact CentralPathSystem<D>::contact(std::size_t i, const Eigen::VectorXd& z, double t) const
{
	Contact result;
	const Vector zi = z.segment<D>(D * i);
	result.u = -zi;
	if (law[i] == Law::coulomb) {
		const SmoothedContact<D> smoothed(zi, t);
		result.r = smoothed.r;
		result.u = smoothed.u;
		result.rateOfR = result.rateOfU = smoothed.rate;
		result.slopeOfR = smoothed.slope;
		result.slopeOfU += smoothed.slope;
		const Eigen::Matrix<double, D - 1, 1> uT = result.u.template tail<D - 1>();
		const double s = std::sqrt(uT.squaredNorm() + t * t);
		result.slopeOfU.row(0) -= (uT / s).transpose() * result.slopeOfU.template bottomRows<D - 1>();
		result.rateOfU[0] -= (uT.dot(result.rateOfU.template tail<D - 1>()) + t) / s;
		result.u[0] -= s;
	} else if (law[i] == Law::frictionless) {
		const double root = std::sqrt(zi[0] * zi[0] + 4 * t);
		result.r[0] = SmoothedContact<D>::positive(zi[0], root, t);
		result.u[0] = SmoothedContact<D>::positive(-zi[0], root, t);
		result.rateOfR[0] = result.rateOfU[0] = 1 / root;
		result.slopeOfR(0, 0) = result.r[0] / root;
		result.slopeOfU(0, 0) += result.slopeOfR(0, 0);
	}
	return result;
}

template <int D> void CentralPathSystem<D>::startAt(const Eigen::VectorXd& z, double logT)
{
	f = Eigen::VectorXd::Zero(unknowns());
	evaluate(z, logT);
	f = F / std::exp(logT);
}

template <int D> void CentralPathSystem<D>::evaluate(const Eigen::VectorXd& z, double logT)
{
	const int count = int(scale.size());
	const double t = std::exp(logT);
	system.setZero();
	for (int i = 0; i < count; ++i) {
		const Contact here = contact(i, z, t);
		const auto qi = q.segment<D>(D * i);
		r.segment<D>(D * i) = here.r;
		rateOfR.segment<D>(D * i) = here.rateOfR;
		slope[i] = here.slopeOfR;
		F.segment<D>(D * i) = here.u - qi;
		terms.segment<D>(D * i) = here.u.cwiseAbs() + qi.cwiseAbs();
		rateOfLog.segment<D>(D * i) = here.rateOfU;
		system.addToDiagonal(i, here.slopeOfU);
	}
	for (int i = 0; i < count; ++i)
		for (int k = rowStart[i]; k < rowStart[i + 1]; ++k) {
			const int j = column[k];
			const Vector given = W[k] * r.segment<D>(D * j);
			F.segment<D>(D * i) -= given;
			terms.segment<D>(D * i) += given.cwiseAbs();
			rateOfLog.segment<D>(D * i) -= W[k] * rateOfR.segment<D>(D * j);
			system.add(k, -W[k] * slope[j]);
		}
	F -= t * f;
	rateOfLog = t * (rateOfLog - f);
	constexpr double units = 4; // in the last place, of a few sums
	excess = (F.cwiseAbs() - units * std::numeric_limits<double>::epsilon() * terms).maxCoeff();
}

template <int D> void CentralPathSystem<D>::impulses(const Eigen::VectorXd& z, double logT, std::vector<Vector>& given) const
{
	given.resize(scale.size());
	for (std::size_t i = 0; i < scale.size(); ++i) given[i] = size * scale[i].cwiseProduct(contact(i, z, std::exp(logT)).r);
}

template class CentralPathSystem<2>;
template class CentralPathSystem<3>;

} // namespace contactdynamics
