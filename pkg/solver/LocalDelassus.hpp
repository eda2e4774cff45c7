// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "GrainProblem.hpp"

namespace contactdynamics {

/// Rows n, t1, t2 of a right-handed frame, a function of the normal alone: t1 is the axis least aligned with it, made orthogonal to it.
Matrix3 contactFrame(const Vector3& normal);

/// W = H^T M^-1 H of one contact (29), in the frame.
Matrix3 localDelassus(const Body& body1, const Body& body2, const Contact& contact, const Matrix3& frame);

} // namespace contactdynamics
