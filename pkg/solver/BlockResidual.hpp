// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "BlockProblem.hpp"
#include "NaturalMap.hpp"

#include <Eigen/Core>

namespace contactdynamics {

/// The residual of a block problem in either measure, contact by contact.
template <int D> class BlockResidual {
public:
	using Vector = Eigen::Matrix<double, D, 1>;
	using Block = Eigen::Matrix<double, D, D>;
	using Tangent = Eigen::Matrix<double, D - 1, 1>;

	explicit BlockResidual(Measure wanted) : measure(wanted) {}

	/// @param r, u  impulse and velocity;  @param q  velocity without any impulse;  @param W  diagonal block, for the natural map only
	void add(const Vector& r, const Vector& u, const Vector& q, double mu, const Block& W)
	{
		if (measure == Measure::siconos) {
			q2 += q.squaredNorm();
			r2 += r.squaredNorm();
			u2 += u.squaredNorm();
			if (r[0] == 0 && u[0] >= 0 && r.template tail<D - 1>().isZero(0)) return;
			const Split<Tangent> F = naturalMap<Tangent>(split(r), split(u), mu, 1, 0);
			error2 += F.n * F.n + F.t.squaredNorm();
		} else if (const double Wnn = W(0, 0); Wnn > 0) {
			const Split<Tangent> F = naturalMap<Tangent>(split(r), split(u), mu, Wnn, q.norm() + (u - q).norm());
			Vector f;
			f << F.n, F.t;
			relative.add(f.dot(W * f), r.dot(W * r));
		}
	}

	double value() const
	{
		if (measure == Measure::naturalMap) return relative.value();
		const double scale = std::sqrt(std::max({q2, r2, u2}));
		return scale > 2.2e-16 ? std::sqrt(error2) / scale : std::sqrt(error2);
	}

private:
	Measure measure;
	ResidualSum relative;
	double error2 = 0, q2 = 0, r2 = 0, u2 = 0;

	static Split<Tangent> split(const Vector& a) { return {a[0], a.template tail<D - 1>()}; }
};

} // namespace contactdynamics
