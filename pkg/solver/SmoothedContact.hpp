// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <Eigen/Dense>

#include <cmath>

namespace contactdynamics {

/// Complementarity on a cone of half-angle 45 degrees, smoothed: the pair r - u = z, r o u = t e of a contact, both inside the cone, for any z and
/// t > 0 (Fukushima, Luo and Tseng 2001, the Chen-Harker-Kanzow-Smale function). r o u = (r.u, r_N u_T + u_N r_T) is the product of the Jordan
/// algebra of the cone and e = (1, 0) its unit, so that t = 0 gives r.u = 0 with both in the cone.
///
/// With the spectral values l = z_N +- |z_T| and p(l) = (l + sqrt(l^2 + 4 t)) / 2, r has the spectral values p(l), u has p(-l).
template <int D> struct SmoothedContact {
	using Vector = Eigen::Matrix<double, D, 1>;
	using Block = Eigen::Matrix<double, D, D>;

	Vector r, u;
	Vector rate; ///< dr/dt = du/dt
	Block slope; ///< dr/dz, symmetric with eigenvalues between 0 and 1; du/dz = slope - identity

	SmoothedContact(const Vector& z, double t)
	{
		using Tangent = Eigen::Matrix<double, D - 1, 1>;
		const double length = z.template tail<D - 1>().norm();
		const Tangent along = length > 0 ? Tangent(z.template tail<D - 1>() / length) : Tangent(Tangent::Unit(0));
		const double high = z[0] + length, low = z[0] - length;
		const double rootHigh = std::sqrt(high * high + 4 * t), rootLow = std::sqrt(low * low + 4 * t);
		const auto fromSpectrum = [&](double atHigh, double atLow) {
			Vector a;
			a << 0.5 * (atHigh + atLow), 0.5 * (atHigh - atLow) * along;
			return a;
		};
		const double pHigh = positive(high, rootHigh, t), pLow = positive(low, rootLow, t);
		r = fromSpectrum(pHigh, pLow);
		u = fromSpectrum(positive(-high, rootHigh, t), positive(-low, rootLow, t));
		rate = fromSpectrum(1 / rootHigh, 1 / rootLow);
		const double slopeHigh = pHigh / rootHigh, slopeLow = pLow / rootLow;
		const double mean = 0.5 * (slopeHigh + slopeLow), half = 0.5 * (slopeHigh - slopeLow);
		const double across = 0.5 * (1 + (high + low) / (rootHigh + rootLow)); // (p(high) - p(low)) / (high - low)
		slope(0, 0) = mean;
		slope.template topRightCorner<1, D - 1>() = half * along.transpose();
		slope.template bottomLeftCorner<D - 1, 1>() = half * along;
		slope.template bottomRightCorner<D - 1, D - 1>() = (mean - across) * (along * along.transpose());
		slope.diagonal().template tail<D - 1>().array() += across;
	}

	/// p(l) without cancellation; root = sqrt(l^2 + 4 t).
	static double positive(double l, double root, double t) { return l > 0 ? 0.5 * (l + root) : 2 * t / (root - l); }
};

} // namespace contactdynamics
