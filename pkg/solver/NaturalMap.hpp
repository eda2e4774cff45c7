// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace contactdynamics {

/// The certificate of a solution, defined here and nowhere else (CertificateLanes.inl evaluates it for several contacts at a time).
///
/// Per contact, with K the Coulomb cone |r_t| <= mu r_n, P_K the Euclidean projection on it and u the relative velocity with the gap velocity
/// added to its normal component, the projection equations (2), (7) of Jean (1999) with rho = 1 / W_nn read F = 0, where
///
///     F = r - P_K( r - (u + mu |u_t| n) / W_nn )                                                         [N s]
///
/// and the residual of the collection is relative, W-weighted by the diagonal blocks, hence an energy ratio that depends on no unit:
///
///     residual = sqrt( sum F^T W_cc F / sum r^T W_cc r )                                                 [-]
///
/// A contact with rolling friction adds F = M - P(M - w / W_w) and its torque M, both with W_w (RollingContact.hpp), to the two sums.
///
/// It is 0 when all F are zero, also when all r are zero, 1 when all r are zero but some F is not, not a number when a sum overflows. An F below the
/// round-off of the velocities it is made of (W_nn |F| <= 16 eps V, V the sum of the speeds that enter u) carries no information and counts as zero:
/// otherwise grains that fly side by side and touch would be iterated for ever.
/// Contacts with W_nn = 0 cannot be influenced by any impulse; they count in maxApproachSpeed only.
class ResidualSum {
public:
	/// @param mapNorm2      F^T W F  [J]
	/// @param impulseNorm2  r^T W r  [J]
	void add(double mapNorm2, double impulseNorm2)
	{
		map += mapNorm2;
		impulse += impulseNorm2;
	}
	void add(const ResidualSum& other) { add(other.map, other.impulse); }

	double value() const
	{
		if (!std::isfinite(map) || !std::isfinite(impulse)) return std::numeric_limits<double>::quiet_NaN(); // overflow is no zero
		if (map == 0) return 0;
		return impulse > 0 ? std::sqrt(map / impulse) : 1;
	}

private:
	double map = 0, impulse = 0;
};

/// A vector split at the contact: normal component and tangential vector in any orthonormal pair or in global axes (T is a vector type).
template <class T> struct Split {
	double n;
	T t;
};

/// |t|; in two dimensions without a square root.
template <class T> inline double lengthOf(const T& t)
{
	if constexpr (T::SizeAtCompileTime == 1)
		return std::abs(t[0]);
	else
		return std::sqrt(t.squaredNorm());
}

/// Euclidean projection on the Coulomb cone |t| <= mu n.
template <class T> inline Split<T> projectOnCone(const Split<T>& z, double mu)
{
	const double tangential = lengthOf(z.t);
	if (z.n >= 0 && tangential <= mu * z.n) return z;
	if (mu * tangential <= -z.n) return {0, T::Zero()};
	const double n = (z.n + mu * tangential) / (1 + mu * mu);
	return {n, z.t * (mu * n / tangential)};
}

/// Round-off of a velocity that is a sum of terms of these sizes.
inline double roundOffOf(double speeds) { return 16 * std::numeric_limits<double>::epsilon() * speeds; }

/// F of the class comment.
/// @param r    impulse [N s];  @param u  relative velocity, gap velocity added to the normal component [m/s]
/// @param Wnn  normal mobility > 0 [1/kg];  @param speeds  sum of the speeds that enter u, for the round-off threshold [m/s]
template <class T> inline Split<T> naturalMap(const Split<T>& r, const Split<T>& u, double mu, double Wnn, double speeds)
{
	const Split<T> z{r.n - (u.n + mu * lengthOf(u.t)) / Wnn, r.t - u.t / Wnn};
	const Split<T> p = projectOnCone(z, mu);
	Split<T> F{r.n - p.n, r.t - p.t};
	if (Wnn * std::sqrt(F.n * F.n + F.t.squaredNorm()) <= roundOffOf(speeds)) return {0, T::Zero()};
	return F;
}

} // namespace contactdynamics
