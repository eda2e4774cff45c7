// SPDX-License-Identifier: GPL-2.0-or-later
// The residual written a second time, from the definition alone: dense matrices, global axes, projection on the generatrix. Shares nothing with
// pkg/solver.
#pragma once

#include "pkg/solver/GrainProblem.hpp"

#include <Eigen/Dense>

#include <algorithm>

namespace contactdynamics::independent {

/// Nearest point of the cone |r_t| <= mu r_n on the generatrix that faces z.
inline Vector3 nearestInCone(const Vector3& z, const Vector3& n, double mu)
{
	const double zn = z.dot(n);
	const Vector3 zt = z - zn * n;
	if (zn >= 0 && zt.norm() <= mu * zn) return z;
	const Vector3 generatrix = zt.norm() > 1e-14 * z.norm() ? Vector3(n + mu * zt.normalized()) : n;
	return std::max(0.0, z.dot(generatrix) / generatrix.squaredNorm()) * generatrix;
}

/// 6 x 3 map of an impulse at the contact to the impulse and its moment at the mass centre.
inline Eigen::Matrix<double, 6, 3> lever(const Vector3& arm)
{
	Eigen::Matrix<double, 6, 3> h;
	h.topRows<3>().setIdentity();
	for (int k = 0; k < 3; ++k) h.block<3, 1>(3, k) = arm.cross(Vector3(Vector3::Unit(k)));
	return h;
}

inline Eigen::Matrix<double, 6, 6> inverseMassMatrix(const Body& body)
{
	Eigen::Matrix<double, 6, 6> m = Eigen::Matrix<double, 6, 6>::Zero();
	m.topLeftCorner<3, 3>().diagonal() = body.inverseMass;
	m.bottomRightCorner<3, 3>() = body.inverseInertia;
	return m;
}

/// Delassus operator of one contact, global axes.
inline Matrix3 delassus(const GrainProblem& problem, const Contact& c)
{
	const auto h1 = lever(c.arm1), h2 = lever(c.arm2);
	return h1.transpose() * inverseMassMatrix(problem.bodies[c.body1]) * h1 + h2.transpose() * inverseMassMatrix(problem.bodies[c.body2]) * h2;
}

/// @param free  the problem before the solve (free velocities);  @param solved  after it (impulses)
inline double residual(const GrainProblem& free, const GrainProblem& solved)
{
	std::vector<Eigen::Matrix<double, 6, 1>> velocity;
	for (const Body& body : free.bodies) {
		velocity.emplace_back();
		velocity.back() << body.velocity, body.angularVelocity;
	}
	for (const Contact& c : solved.contacts) {
		velocity[c.body1] -= inverseMassMatrix(free.bodies[c.body1]) * lever(c.arm1) * c.impulse;
		velocity[c.body2] += inverseMassMatrix(free.bodies[c.body2]) * lever(c.arm2) * c.impulse;
	}
	// The mean field: L changes by the symmetric part of the moment over its inertia, within its limit.
	Matrix3 L = Matrix3::Zero();
	if (free.meanField) {
		const MeanField& field = *free.meanField;
		L = field.gradient;
		Matrix3 moment = Matrix3::Zero();
		for (const Contact& c : solved.contacts) moment += c.impulse * (c.arm1 - c.arm2).transpose();
		for (int i = 0; i < 3; ++i)
			for (int j = 0; j < 3; ++j) {
				const double spin = (field.gradient(i, j) - field.gradient(j, i)) / 2, stretch = (field.gradient(i, j) + field.gradient(j, i)) / 2;
				const double pushed = stretch + field.inverseMass(i, j) * (moment(i, j) + moment(j, i)) / 2;
				if (field.inverseMass(i, j) != 0) L(i, j) = spin + std::clamp(pushed, -field.limit, field.limit);
			}
	}
	double above = 0, below = 0;
	for (const Contact& c : solved.contacts) {
		const auto h1 = lever(c.arm1), h2 = lever(c.arm2);
		const Matrix3 W = delassus(free, c);
		const double Wnn = c.normal.dot(W * c.normal);
		if (Wnn == 0) continue;
		Vector3 u = h2.transpose() * velocity[c.body2] - h1.transpose() * velocity[c.body1] + c.imageVelocity;
		u += c.gapVelocity * c.normal + L * (c.arm1 - c.arm2);
		const Vector3 ut = u - u.dot(c.normal) * c.normal;
		const Vector3 F = c.impulse - nearestInCone(c.impulse - (u + c.friction * ut.norm() * c.normal) / Wnn, c.normal, c.friction);
		above += F.dot(W * F);
		below += c.impulse.dot(W * c.impulse);
	}
	return above == 0 ? 0 : below > 0 ? std::sqrt(above / below) : 1;
}

} // namespace contactdynamics::independent
