// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace contactdynamics {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;

/// One rigid body of the solve. A clump is one body.
struct Body {
	Vector3 velocity;		 ///< in: free velocity, without contact impulses; out: velocity at the end of the step [m/s]
	Vector3 angularVelocity; ///< likewise, global axes [rad/s]
	Vector3 inverseMass;	 ///< per global axis, 0 where the degree of freedom is blocked [1/kg]
	Matrix3 inverseInertia;	 ///< global axes, symmetric, rows and columns 0 where blocked [1/(kg m2)]
};

enum class ContactStatus : std::int8_t { none, sticking, sliding };

/// One contact candidate between body 1 (antagonist) and body 2 (candidate).
/// U is the velocity of body 2 relative to body 1 at the contact point, U_N = U.n > 0 separates. R acts on body 2, minus R on body 1.
struct Contact {
	std::int32_t body1 = 0, body2 = 0;			///< indices into GrainProblem::bodies, different from each other
	bool ball = false;							///< arms parallel to the normal and isotropic mobilities: W = diag(Wn, Wt, Wt)
	Vector3 normal = Vector3::UnitX();			///< unit vector from body 1 to body 2
	Vector3 arm1 = Vector3::Zero();				///< contact point minus mass centre of body 1 [m]
	Vector3 arm2 = Vector3::Zero();				///< contact point minus mass centre of body 2 [m]
	double friction = 0;						///< Coulomb coefficient mu >= 0
	double gapVelocity = 0;						///< s in 0 <= U_N + s _|_ R_N >= 0: max(0,g)/h (25), g/h (24), 0 (23) [m/s]
	Vector3 imageVelocity = Vector3::Zero();	///< added to the velocity of body 2 (periodic image), zero otherwise [m/s]
	double normalCompliance = 0;				///< c in 0 <= U_N + s + c R_N _|_ R_N >= 0: added to the diagonal of W (mortar), >= 0 [1/kg]
	double tangentialCompliance = 0;			///< likewise for both tangents; a contact with either takes the general solution [1/kg]
	Vector3 impulse = Vector3::Zero();			///< in: start of the iteration (warm start or zero); out: solution, global axes [N s]
	Vector3 relativeVelocity = Vector3::Zero(); ///< out: U at the solution, imageVelocity included, gapVelocity and compliance not, global axes [m/s]
	ContactStatus status = ContactStatus::none; ///< out
};

/// The Signorini-Coulomb problem of a collection of rigid bodies, matrix-free: W = H^T M^-1 H (28)-(30) of Jean (1999) is never assembled.
/// Filled by the caller every step; the vectors are meant to be kept, so that no memory is allocated once warm.
struct GrainProblem {
	std::vector<Body> bodies;
	std::vector<Contact> contacts;
};

} // namespace contactdynamics
