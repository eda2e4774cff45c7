// SPDX-License-Identifier: GPL-2.0-or-later
// Problems that several tests use.
#pragma once

#include "pkg/solver/GrainProblem.hpp"

#include <Eigen/Geometry>
#include <random>

namespace contactdynamics::scenes {

inline Body wall()
{
	Body body;
	body.velocity.setZero();
	body.angularVelocity.setZero();
	body.inverseMass.setZero();
	body.inverseInertia.setZero();
	return body;
}

inline Body ball(double mass, double radius, const Vector3& velocity = Vector3::Zero(), const Vector3& angularVelocity = Vector3::Zero())
{
	Body body = wall();
	body.velocity = velocity;
	body.angularVelocity = angularVelocity;
	body.inverseMass.setConstant(1 / mass);
	body.inverseInertia.diagonal().setConstant(2.5 / (mass * radius * radius));
	return body;
}

/// Radius 0 stands for a wall: its arm is of no account.
inline Contact touch(int body1, double radius1, int body2, double radius2, const Vector3& normal, double friction, double gapVelocity = 0)
{
	Contact contact;
	contact.body1 = body1;
	contact.body2 = body2;
	contact.ball = true;
	contact.normal = normal;
	contact.arm1 = radius1 * normal;
	contact.arm2 = -radius2 * normal;
	contact.friction = friction;
	contact.gapVelocity = gapVelocity;
	return contact;
}

/// Column of n balls (unit mass, unit radius) on a floor, each with the velocity that gravity gives in one step.
inline GrainProblem column(int n, double gravityStep, double friction = 0.3)
{
	GrainProblem problem;
	problem.bodies.push_back(wall());
	for (int i = 0; i < n; ++i) {
		problem.bodies.push_back(ball(1, 1, {0, 0, -gravityStep}));
		problem.contacts.push_back(touch(i, i ? 1 : 0, i + 1, 1, Vector3::UnitZ(), friction));
	}
	return problem;
}

/// A heap of spheres on a jittered lattice with a floor and four walls: neighbours within reach touch or nearly touch, and move at random.
/// One body in ten is a hundred times heavier where wanted; general makes every contact a non-ball one with random arms and inertia.
inline GrainProblem heap(int side, unsigned seed, double friction = 0.3, bool heavy = false, bool general = false)
{
	std::mt19937_64 random(seed);
	std::uniform_real_distribution<double> uniform(0, 1);
	std::normal_distribution<double> normal;
	GrainProblem problem;
	problem.bodies.push_back(wall());
	std::vector<Vector3> centre(1);
	std::vector<double> radius(1);
	for (int i = 0; i < side * side * side; ++i) {
		const double r = 0.4 + 0.15 * uniform(random), mass = 4 * r * r * r * (heavy && uniform(random) < 0.1 ? 100 : 1);
		const Vector3 jitter = 0.1 * Vector3(normal(random), normal(random), normal(random));
		centre.push_back(Vector3(i % side, (i / side) % side, i / (side * side)) + jitter);
		radius.push_back(r);
		problem.bodies.push_back(ball(mass, r, 0.2 * Vector3(normal(random), normal(random), normal(random)) - Vector3::UnitZ(),
									  Vector3(normal(random), normal(random), normal(random))));
		problem.bodies.back().centre = centre.back();
		if (general) {
			Matrix3 stretch = Matrix3::Zero();
			stretch.diagonal() << 0.3 + uniform(random), 0.3 + uniform(random), 0.3 + uniform(random);
			const Matrix3 turn = Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random)).normalized().toRotationMatrix();
			problem.bodies.back().inverseInertia = turn * (problem.bodies.back().inverseInertia * stretch) * turn.transpose();
		}
	}
	const auto add = [&](int i, int j, const Vector3& n, double gap) {
		problem.contacts.push_back(touch(i, radius[i], j, radius[j], n, friction, std::max(0.0, gap)));
		if (!general) return;
		Contact& c = problem.contacts.back();
		c.ball = false;
		for (Vector3* arm : {&c.arm1, &c.arm2}) *arm += 0.2 * Vector3(normal(random), normal(random), normal(random));
	};
	const int bodies = int(problem.bodies.size());
	for (int i = 1; i < bodies; ++i) {
		for (int axis = 0; axis < 3; ++axis) {
			if (centre[i][axis] < 0.6) add(0, i, Vector3::Unit(axis), centre[i][axis]);
			if (axis < 2 && centre[i][axis] > side - 1.6) add(0, i, -Vector3::Unit(axis), side - 1 - centre[i][axis]);
		}
		for (int j = i + 1; j < bodies; ++j) {
			const Vector3 d = centre[j] - centre[i];
			const double gap = d.norm() - radius[i] - radius[j];
			if (gap < 0.3) add(i, j, d.normalized(), gap);
		}
	}
	return problem;
}

/// Rolling friction on all contacts but every fifth, with twisting friction on two thirds of these, and a drive on some.
inline void addRollingFriction(GrainProblem& problem, double arm)
{
	std::mt19937_64 random(1);
	std::normal_distribution<double> normal;
	for (std::size_t i = 0; i < problem.contacts.size(); ++i) {
		if (i % 5 == 4) continue;
		RollingFriction one;
		one.contact = std::int32_t(i);
		one.rollingArm = arm;
		one.twistingArm = i % 3 == 0 ? 0 : 0.5 * arm;
		if (i % 7 == 0) one.drive = 0.1 * Vector3(normal(random), normal(random), normal(random));
		problem.rolling.push_back(one);
	}
}

inline double kineticEnergy(const GrainProblem& problem)
{
	double energy = 0;
	for (const Body& body : problem.bodies) {
		for (int k = 0; k < 3; ++k)
			if (body.inverseMass[k] > 0) energy += 0.5 * body.velocity[k] * body.velocity[k] / body.inverseMass[k];
		if (body.inverseInertia.determinant() > 0) energy += 0.5 * body.angularVelocity.dot(body.inverseInertia.inverse() * body.angularVelocity);
	}
	return energy;
}

} // namespace contactdynamics::scenes
