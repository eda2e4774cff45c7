// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
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
	/// Of mass, in a periodic cell that of any image: tells who is whose neighbour, for the order of the sweeps and for nothing else [m].
	Vector3 centre = Vector3::Zero();

	bool moves() const { return !inverseMass.isZero(0) || !inverseInertia.isZero(0); } ///< by impulses
	/// Parts that no impulse changes; the others are zero.
	Vector3 givenVelocity() const { return (inverseMass.array() == 0).select(velocity, Vector3::Zero()); }
	Vector3 givenAngularVelocity() const { return (inverseInertia.diagonal().array() == 0).select(angularVelocity, Vector3::Zero()); }
};

enum class ContactStatus : std::int8_t { none, sticking, sliding };

/// One contact candidate between body 1 (antagonist) and body 2 (candidate).
/// U is the velocity of body 2 relative to body 1 at the contact point, U_N = U.n > 0 separates. R acts on body 2, minus R on body 1.
struct Contact {
	std::int32_t body1 = 0, body2 = 0;			///< indices into GrainProblem::bodies, different from each other
	bool ball = false;							///< arms parallel to the normal and isotropic mobilities: W = diag(Wn, Wt, Wt)
	ContactStatus status = ContactStatus::none; ///< out
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
};

/// Rolling and twisting friction of a contact: a torque impulse M on body 2, minus M on body 1, against the relative angular velocity w of body 2,
///
///     |M_T| <= l R_N,  |M_N| <= m R_N,  each on its limit, and against its part of w, unless that part is zero.
struct RollingFriction {
	std::int32_t contact = 0;				///< index into GrainProblem::contacts
	double rollingArm = 0, twistingArm = 0; ///< l, m >= 0 [m]
	Vector3 drive = Vector3::Zero();		///< added to w: of bodies that turn, but that the velocities do not show [rad/s]
	Vector3 torque = Vector3::Zero();		///< M; in: start of the iteration; out: solution, global axes [N m s]
};

/// A velocity gradient L that all bodies share, such as that of a periodic cell with inertia of its own: one more body, which every contact sees.
///
/// The velocities of the bodies are those relative to the mean field, and U of a contact gains L b, where b = arm1 - arm2 is the vector between the
/// two mass centres, from body 1 to (the image of) body 2. By virtual work an impulse r then changes L: M dL = sym(r b^T), component by component.
/// Only the symmetric part of L responds: a rotation of everything does no work.
struct MeanField {
	Matrix3 gradient = Matrix3::Zero();	   ///< in: without contact impulses; out: at the solution [1/s]
	Matrix3 inverseMass = Matrix3::Zero(); ///< 1/M, symmetric, 0 where the component is prescribed [1/(kg m2)]
	double limit =
			std::numeric_limits<double>::infinity(); ///< bound on components of sym(L) with inverseMass > 0, held by whatever force it takes [1/s]

	/// L with the contact impulses, given the sum of r b^T over all contacts [kg m2/s].
	Matrix3 gradientWith(const Matrix3& moment) const
	{
		const Matrix3 free = 0.5 * (gradient + gradient.transpose()), push = 0.5 * (moment + moment.transpose());
		Matrix3 L = gradient;
		for (int i = 0; i < 3; ++i)
			for (int j = 0; j < 3; ++j) {
				if (!(inverseMass(i, j) > 0)) continue;
				const double stretch = free(i, j) + inverseMass(i, j) * push(i, j);
				L(i, j) = std::min(limit, std::max(-limit, stretch)) + 0.5 * (gradient(i, j) - gradient(j, i));
			}
		return L;
	}

	/// L when the components that respond are at rest: prescribed ones and the rotation remain [1/s].
	Matrix3 standingStill() const { return (inverseMass.array() > 0).select(0.5 * (gradient - gradient.transpose()), gradient); }
};

/// The Signorini-Coulomb problem of a collection of rigid bodies, matrix-free: W = H^T M^-1 H (28)-(30) of Jean (1999) is never assembled.
/// Filled by the caller every step; the vectors are meant to be kept, so that no memory is allocated once warm.
struct GrainProblem {
	std::vector<Body> bodies;
	std::vector<Contact> contacts;
	std::vector<RollingFriction> rolling; ///< of the contacts that have it, one each
	std::optional<MeanField> meanField;
};

} // namespace contactdynamics
