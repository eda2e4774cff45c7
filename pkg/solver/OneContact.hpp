// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "GrainProblem.hpp"
#include "PrincipalContact.hpp"

namespace contactdynamics {

/// One frictional contact in its local frame (normal first), with everything that depends on W alone worked out once.
///
///     u = W r + b,   0 <= u_n _|_ r_n >= 0,   |r_t| <= mu r_n,   u_t = -k r_t with k >= 0, and k = 0 inside the cone    (31) of Jean (1999)
///
/// W is symmetric positive semi-definite. Elimination of r_n by u_n = 0 leaves A = W_tt - w w^T / W_nn (w = W_tn) and
/// c = -(b_t - w b_n / W_nn), so that (A + k I) r_t = c: k = 0 sticks, k > 0 slides. A is diagonalised once; the sliding k is the
/// root of a scalar function that always has a sign change, so that the solution cannot fail. (Only where A is singular and a wall drives the contact
/// against it need there be none; the impulse stays finite then.)
/// Local Newton on (2), (7) with fall-backs was rejected: it needs the same enumeration behind it and is no faster.
class OneContact {
public:
	OneContact() = default;

	/// @param W  local Delassus operator [1/kg], only the upper triangle is read; the eigenvalues of A below round-off are taken as zero
	explicit OneContact(const Matrix3& W);

	/// @param b   relative velocity without this contact, gap velocity added to the normal component [m/s]
	/// @param mu  Coulomb coefficient >= 0
	/// @return    impulse [N s]; zero when b_n >= 0, and when W_nn = 0 (nothing can move along the normal)
	Vector3 solve(const Vector3& b, double mu) const;

	/// The same, for visits that follow each other.
	/// @param rate  see solve() of PrincipalContact.hpp
	Vector3 solve(const Vector3& b, double mu, double& rate) const;

	/// W along the eigenvectors of A.
	const PrincipalContact& principal() const { return along; }
	/// The frame turned about its normal: the tangents are the eigenvectors, that of the larger eigenvalue first.
	Matrix3 principalFrame(const Matrix3& frame) const;

private:
	PrincipalContact along;
	double cosine = 1, sine = 0; // eigenvectors of A: (cosine, sine), (-sine, cosine)
};

} // namespace contactdynamics
