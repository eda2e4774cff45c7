// SPDX-License-Identifier: GPL-2.0-or-later
#include "GeneralContact.hpp"

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

namespace {
/// How far the extrapolation goes from the point of the last visit; keeps the search direction for the next one.
Vector3 stepAhead(const Vector3& increment, Vector3& direction, const Extrapolation& by)
{
	Vector3 ahead = by.relax * increment + by.momentum * direction;
	direction = increment + ahead;
	return ahead;
}
} // namespace

SweepNorms visit(GeneralContact& c, BodyState* bodies, Extrapolation extrapolation, FieldPass* field)
{
	using Map = Eigen::Map<Vector3>;
	using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
	const std::int32_t i1 = c.body1 < 0 ? ~c.body1 : c.body1, i2 = c.body2 < 0 ? ~c.body2 : c.body2;
	Map v1(bodies[i1].velocity), w1(bodies[i1].angularVelocity), v2(bodies[i2].velocity), w2(bodies[i2].angularVelocity);

	const Vector3 x = c.impulse + stepAhead(c.increment, c.direction, extrapolation);
	Vector3 U = v2 - v1 + w2.cross(c.arm2) - w1.cross(c.arm1);
	if (field) U += Eigen::Map<const Matrix>(field->gradient) * (c.arm1 - c.arm2);
	const Vector3 u = c.frame * U + c.offset;
	const Vector3 r = c.local.solve(u + c.compliance.cwiseProduct(x) - c.W * x, c.friction, c.slidingRate), dr = r - x;
	c.impulse = r;
	c.increment = dr;

	const Vector3 push = c.frame.transpose() * dr;
	if (field) Eigen::Map<Matrix>(field->moment) += push * (c.arm1 - c.arm2).transpose();
	if (c.body1 >= 0) {
		v1 -= c.mobility1->inverseMass.cwiseProduct(push);
		w1 -= c.mobility1->inverseInertia * c.arm1.cross(push);
	}
	if (c.body2 >= 0) {
		v2 += c.mobility2->inverseMass.cwiseProduct(push);
		w2 += c.mobility2->inverseInertia * c.arm2.cross(push);
	}
	SweepNorms norms{dr.dot(c.W * dr), r.dot(c.W * r)};
	if (!c.rolling) return norms;

	RollingContact& roll = *c.rolling;
	const Vector3 before = roll.torque + stepAhead(roll.increment, roll.direction, extrapolation);
	roll.torque = roll.improved(before, w2 - w1, c.frame.row(0), r[0]);
	const Vector3 dm = roll.increment = roll.torque - before;
	if (c.body1 >= 0) w1 -= c.mobility1->inverseInertia * dm;
	if (c.body2 >= 0) w2 += c.mobility2->inverseInertia * dm;
	norms.increment2 += roll.mobility * dm.squaredNorm();
	norms.impulse2 += roll.mobility * roll.torque.squaredNorm();
	return norms;
}

} // namespace contactdynamics
