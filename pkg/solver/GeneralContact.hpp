// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "BallPack.hpp"
#include "GrainProblem.hpp"
#include "OneContact.hpp"
#include "RollingContact.hpp"

namespace contactdynamics {

/// A contact with any W: non-spherical bodies, clumps, blocked degrees of freedom. Impulses and velocities in the local frame, normal first.
struct GeneralContact {
	std::int32_t id;		   ///< index of the contact in the problem
	std::int32_t body1, body2; ///< places of the bodies in the state of the sweep, complemented as in BallPack when the body cannot move
	Matrix3 frame;			   ///< rows n, t1, t2
	Vector3 arm1, arm2;		   ///< [m]
	Vector3 offset;			   ///< image velocity in the frame, plus the gap velocity on the normal [m/s]
	Vector3 compliance;		   ///< on the diagonal of W: what the bodies' velocities do not know [1/kg]
	Matrix3 W;				   ///< local Delassus operator, compliance included [1/kg]
	double friction;
	const Body *mobility1, *mobility2; ///< inverse masses and inertias of the bodies
	OneContact local;
	double slidingRate;					   ///< of the last visit, 0: unknown
	Vector3 impulse, increment, direction; ///< as in BallPack
	RollingContact* rolling;			   ///< null: none
};

/// Rows n, t1, t2 of a right-handed frame, a function of the normal alone: t1 is the axis least aligned with it, made orthogonal to it.
Matrix3 contactFrame(const Vector3& normal);

/// W = H^T M^-1 H of one contact (29), in the frame.
Matrix3 localDelassus(const Body& body1, const Body& body2, const Contact& contact, const Matrix3& frame);

/// One visit, as BallSweep does it for balls.
/// @param bodies  state of the sweep;  @param field  null: no mean field
SweepNorms visit(GeneralContact& contact, BodyState* bodies, Extrapolation extrapolation, FieldPass* field);

} // namespace contactdynamics
