// SPDX-License-Identifier: GPL-2.0-or-later
#include "LocalDelassus.hpp"

#include <Eigen/Geometry>

namespace contactdynamics {

Matrix3 contactFrame(const Vector3& normal)
{
	int axis;
	normal.cwiseAbs().minCoeff(&axis);
	const Vector3 t1 = (Vector3::Unit(axis) - normal[axis] * normal).normalized();
	Matrix3 frame;
	frame.row(0) = normal;
	frame.row(1) = t1;
	frame.row(2) = normal.cross(t1);
	return frame;
}

Matrix3 localDelassus(const Body& body1, const Body& body2, const Contact& contact, const Matrix3& frame)
{
	// Columns: what a unit impulse along n, t1, t2 does to the velocities; W is the energy product of these, symmetric by construction.
	Matrix3 turn1, turn2;
	for (int k = 0; k < 3; ++k) {
		turn1.col(k) = contact.arm1.cross(frame.row(k).transpose());
		turn2.col(k) = contact.arm2.cross(frame.row(k).transpose());
	}
	Matrix3 W = frame * (body1.inverseMass + body2.inverseMass).asDiagonal() * frame.transpose();
	W += turn1.transpose() * body1.inverseInertia * turn1 + turn2.transpose() * body2.inverseInertia * turn2;
	return 0.5 * (W + W.transpose());
}

} // namespace contactdynamics
