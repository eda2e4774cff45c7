// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

namespace contactdynamics {

// Plain data only, as in BallPack.hpp.

/// W of one contact when the tangents are the eigenvectors of A = W_tt - w w^T / W_nn, w = W_tn: five numbers, see OneContact.hpp.
struct PrincipalContact {
	double Wnn = 0;							   ///< [1/kg]
	double wLarge = 0, wSmall = 0;			   ///< w along the eigenvectors [1/kg]
	double largeEigen = 0, smallEigen = 0;	   ///< of A, >= 0; 0 means that nothing can move along it [1/kg]
	double roundOff = 0;					   ///< of A [1/kg]
	double inverseWnn = 0;					   ///< [kg]
	double inverseLarge = 0, inverseSmall = 0; ///< of the eigenvalues, 0 for 0 [kg]
};

/// b with r_n eliminated by u_n = 0: (A + k I) r_t = (large, small).
struct PrincipalPush {
	double normal;		 ///< b_n [m/s]
	double large, small; ///< w b_n / W_nn - b_t [m/s]
};

/// The contact law, exactly.
/// @param mu    Coulomb coefficient >= 0
/// @param r     out: impulse along normal and eigenvectors [N s]
/// @param rate  in: sliding rate k [1/kg] of the last visit, where the search begins, 0: unknown; out: that of this visit, left alone unless it
/// slides
void solve(const PrincipalContact& W, const PrincipalPush& push, double mu, double& rate, double* r);

} // namespace contactdynamics
