// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <lib/base/Math.hpp>

namespace yade {

/// Rows: the normal and the two tangents that ContactDynamicsPhys.localVelocity documents; right-handed.
inline Matrix3r localFrame(const Vector3r& normal)
{
	int axis;
	normal.cwiseAbs().minCoeff(&axis);
	const Vector3r tangent1 = (Vector3r::Unit(axis) - normal[axis] * normal).normalized();
	Matrix3r frame;
	frame.row(0) = normal;
	frame.row(1) = tangent1;
	frame.row(2) = normal.cross(tangent1);
	return frame;
}

} // namespace yade
