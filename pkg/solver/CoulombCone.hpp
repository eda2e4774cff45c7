// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "GrainProblem.hpp"

namespace contactdynamics {

/// Brings an impulse inside the cone: negative normal parts vanish, the friction is shortened to its limit.
inline Vector3 insideCone(const Vector3& impulse, const Vector3& n, double mu)
{
	const double rn = impulse.dot(n);
	if (!(rn > 0)) return rn <= 0 ? Vector3(Vector3::Zero()) : impulse; // not finite stays visible
	const Vector3 rt = impulse - rn * n;
	const double length = rt.norm();
	return length > mu * rn ? Vector3(rn * n + (mu * rn / length) * rt) : impulse;
}

} // namespace contactdynamics
