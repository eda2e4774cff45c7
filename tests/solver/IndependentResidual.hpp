// SPDX-License-Identifier: GPL-2.0-or-later
// The residual written a second time, from the definition alone: dense matrices, global axes, projection on the generatrix. Shares nothing with
// pkg/solver.
#pragma once

#include "pkg/solver/GrainProblem.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <vector>

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

using Velocities = std::vector<Eigen::Matrix<double, 6, 1>>;

/// What the impulses lead to, by body.
/// @param free  the problem before the solve (free velocities);  @param solved  after it (impulses)
inline Velocities velocities(const GrainProblem& free, const GrainProblem& solved)
{
	Velocities velocity;
	for (const Body& body : free.bodies) {
		velocity.emplace_back();
		velocity.back() << body.velocity, body.angularVelocity;
	}
	for (const Contact& c : solved.contacts) {
		velocity[c.body1] -= inverseMassMatrix(free.bodies[c.body1]) * lever(c.arm1) * c.impulse;
		velocity[c.body2] += inverseMassMatrix(free.bodies[c.body2]) * lever(c.arm2) * c.impulse;
	}
	for (const RollingFriction& one : solved.rolling) {
		const Contact& c = solved.contacts[one.contact];
		velocity[c.body1].tail<3>() -= free.bodies[c.body1].inverseInertia * one.torque;
		velocity[c.body2].tail<3>() += free.bodies[c.body2].inverseInertia * one.torque;
	}
	return velocity;
}

/// Arguments as those of velocities().
inline double residual(const GrainProblem& free, const GrainProblem& solved)
{
	const Velocities velocity = velocities(free, solved);
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
	for (const RollingFriction& one : solved.rolling) {
		const Contact& c = solved.contacts[one.contact];
		const Matrix3 W = free.bodies[c.body1].inverseInertia + free.bodies[c.body2].inverseInertia;
		const double arm = std::max(one.rollingArm, one.twistingArm),
					 turns = std::max({W.row(0).lpNorm<1>(), W.row(1).lpNorm<1>(), W.row(2).lpNorm<1>()});
		const double bound = turns > 0 ? turns : arm > 0 ? c.normal.dot(delassus(free, c) * c.normal) / (arm * arm) : 0;
		if (bound == 0) continue;
		const double rn = c.impulse.dot(c.normal);
		const Vector3 w = velocity[c.body2].tail<3>() - velocity[c.body1].tail<3>() + one.drive, z = one.torque - w / bound;
		const Vector3 zt = z - z.dot(c.normal) * c.normal;
		const Vector3 nearest = std::clamp(z.dot(c.normal), -one.twistingArm * rn, one.twistingArm * rn) * c.normal +
								(zt.norm() > one.rollingArm * rn ? Vector3(one.rollingArm * rn * zt.normalized()) : zt);
		const Vector3 F = one.torque - nearest;
		above += bound * F.squaredNorm();
		below += bound * one.torque.squaredNorm();
	}
	return above == 0 ? 0 : below > 0 ? std::sqrt(above / below) : 1;
}

/// Two solutions of one problem, the contacts in any order, by what their residuals leave open: kinetic energy of the difference of their velocities.
struct Agreement {
	double energy = 0; ///< what it is
	double bound = 0;  ///< what it may be
};

/// The bound follows from the definition of the residual (NaturalMap.hpp). Of contact c let p = r - F be the projection of z = r - V / W_nn with
/// V = u + mu |u_t| n. Since z - p = F - V / W_nn is normal to the cone at p, for two solutions (p1 - p2).(z1 - p1 - z2 + p2) >= 0. Times W_nn and
/// summed, with D a difference of both and E the energy sought,
///
///     2 E = sum Dr.Du <= sum W_nn Dp.DF + DF.Du = sum W_nn (Dr - DF).DF + DF.Du <= |DF| (|Dr| + |DF| + |Du|')
///
/// where |x|^2 = sum W_nn x^2 and |u|'^2 = sum u^2 / W_nn. A residual below the tolerance is |F| <= tolerance |r|, and |Dr| <= |r1| + |r2| is all
/// that is known of impulses that need not be unique. So far without friction; F and r have normal components only, for which the norm of the
/// residual is this one. With friction the left side has the term mu sum Dr_n D|u_t| besides, which may be negative: there may be several velocities.
/// A test that asserts the bound with friction says that its problem has one; |r| is then taken with all of W_cc, which makes it no smaller for
/// balls.
inline Agreement agreement(const GrainProblem& free, const GrainProblem& one, const GrainProblem& two, double tolerance)
{
	Velocities difference = velocities(free, one);
	const Velocities other = velocities(free, two);
	Agreement result;
	for (std::size_t i = 0; i < difference.size(); ++i) {
		difference[i] -= other[i];
		const auto twist = difference[i];
		for (int k = 0; k < 3; ++k)
			if (free.bodies[i].inverseMass[k] > 0) result.energy += 0.5 * twist[k] * twist[k] / free.bodies[i].inverseMass[k];
		if (free.bodies[i].inverseInertia.determinant() > 0)
			result.energy += 0.5 * twist.tail<3>().dot(free.bodies[i].inverseInertia.inverse() * twist.tail<3>());
	}
	double size1 = 0, size2 = 0, speeds = 0;
	for (const Contact& c : one.contacts) {
		const Matrix3 W = delassus(free, c);
		const double Wnn = c.normal.dot(W * c.normal);
		size1 += c.impulse.dot(W * c.impulse);
		if (Wnn > 0)
			speeds += (lever(c.arm2).transpose() * difference[c.body2] - lever(c.arm1).transpose() * difference[c.body1]).squaredNorm() / Wnn;
	}
	for (const Contact& c : two.contacts) size2 += c.impulse.dot(delassus(free, c) * c.impulse);
	const double impulses = std::sqrt(size1) + std::sqrt(size2);
	result.bound = 0.5 * tolerance * impulses * ((1 + tolerance) * impulses + std::sqrt(speeds));
	return result;
}

} // namespace contactdynamics::independent
