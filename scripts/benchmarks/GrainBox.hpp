// SPDX-License-Identifier: GPL-2.0-or-later
// Spheres that fall into a box, step by step, with the solver and without YADE: realistic problems for benchmarks of the solver alone.
#pragma once

#include "pkg/solver/SignoriniCoulombSolver.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <unordered_map>
#include <vector>

namespace contactdynamics {

/// Spheres of radius 0.8 to 1.2 (of the mean, 1 mm) on a loose lattice over the floor of a box with a square base, thrown at random. Same seed, same
/// grains.
class GrainBox {
public:
	struct Setup {
		int grains = 1000;
		double friction = 0.3;
		double heavyShare = 0; ///< of the grains have a hundred times the mass
		unsigned seed = 1;
		int width = 0;		///< grains along a side of the base; 0: the cube root of their number
		double pitch = 2.6; ///< of the lattice, in mean radii; below 1.6 all neighbours overlap from the start
	};
	static constexpr double radius = 1e-3, gravity = 9.81;

	explicit GrainBox(const Setup& setup) : friction(setup.friction)
	{
		std::mt19937_64 random(setup.seed);
		std::uniform_real_distribution<double> uniform(0, 1);
		std::normal_distribution<double> normal;
		const int side = setup.width > 0 ? setup.width : std::max(1, int(std::lround(std::cbrt(double(setup.grains)))));
		const double pitch = setup.pitch * radius;
		width = side * pitch;
		bodies.push_back(fixedBody());
		grains.push_back({Vector3::Zero(), 0});
		for (int i = 0; i < setup.grains; ++i) {
			const double r = radius * (0.8 + 0.4 * uniform(random));
			const double mass = 4.0 / 3 * M_PI * 2500 * r * r * r * (uniform(random) < setup.heavyShare ? 100 : 1);
			const Vector3 jitter = 0.1 * radius * Vector3(uniform(random) - 0.5, uniform(random) - 0.5, uniform(random) - 0.5);
			grains.push_back({pitch * (Vector3(i % side, i / side % side, i / (side * side)) + Vector3::Constant(0.5)) + jitter, r});
			Body body = fixedBody();
			body.velocity = 0.1 * Vector3(normal(random), normal(random), normal(random));
			body.inverseMass.setConstant(1 / mass);
			body.inverseInertia.diagonal().setConstant(2.5 / (mass * r * r));
			bodies.push_back(body);
		}
	}

	double timeStep() const { return 0.05 * std::sqrt(radius / gravity); }

	/// The problem of the coming step, started from the impulses of the last one.
	const GrainProblem& next()
	{
		const double h = timeStep();
		problem.bodies = bodies;
		for (std::size_t i = 1; i < bodies.size(); ++i) {
			problem.bodies[i].velocity[2] -= gravity * h;
			problem.bodies[i].centre = grains[i].centre;
		}
		findContacts(h);
		return problem;
	}

	/// Moves by a solution of next().
	void advance(const GrainProblem& solved)
	{
		const double h = timeStep();
		impulses.clear();
		for (const Contact& c : solved.contacts)
			if (!c.impulse.isZero(0)) impulses[keyOf(c)] = c.impulse;
		for (std::size_t i = 1; i < bodies.size(); ++i) {
			bodies[i] = solved.bodies[i];
			grains[i].centre += h * bodies[i].velocity;
		}
	}

	double kineticEnergyPerGrain() const ///< over m g r [-]
	{
		double sum = 0;
		for (std::size_t i = 1; i < bodies.size(); ++i) sum += 0.5 * bodies[i].velocity.squaredNorm();
		return sum / double(bodies.size() - 1) / (gravity * radius);
	}

private:
	struct Grain {
		Vector3 centre;
		double radius;
	};
	double friction, width;
	std::vector<Grain> grains; // number 0: floor and walls
	std::vector<Body> bodies;
	GrainProblem problem;
	std::unordered_map<std::uint64_t, Vector3> impulses;

	static Body fixedBody() { return {Vector3::Zero(), Vector3::Zero(), Vector3::Zero(), Matrix3::Zero()}; }

	/// A grain meets the box at several faces: told apart by the direction.
	static std::uint64_t keyOf(const Contact& c)
	{
		std::uint64_t face = 0;
		if (c.body1 == 0)
			for (int axis = 0; axis < 3; ++axis) face = c.normal[axis] > 0.5 ? 2 * axis + 1 : c.normal[axis] < -0.5 ? 2 * axis + 2 : face;
		return (std::uint64_t(c.body1) << 35) | (std::uint64_t(c.body2) << 3) | face;
	}

	void add(int i, int j, const Vector3& normal, double gap, double h)
	{
		Contact c;
		c.body1 = i;
		c.body2 = j;
		c.ball = true;
		c.normal = normal;
		if (i > 0) c.arm1 = (grains[i].radius + 0.5 * gap) * normal;
		c.arm2 = -(grains[j].radius + 0.5 * gap) * normal;
		c.friction = friction;
		c.gapVelocity = std::max(0.0, gap) / h;
		const auto before = impulses.find(keyOf(c));
		if (before != impulses.end()) c.impulse = before->second;
		problem.contacts.push_back(c);
	}

	/// Pairs that may close within the step: cells as wide as the largest reach, each pair met once, in the order of the numbers.
	void findContacts(double h)
	{
		problem.contacts.clear();
		std::vector<double> reach(grains.size());
		double widest = 0;
		for (std::size_t i = 1; i < grains.size(); ++i) {
			reach[i] = grains[i].radius * 1.02 + h * problem.bodies[i].velocity.norm();
			widest = std::max(widest, reach[i]);
		}
		const double cell = 2 * widest;
		const auto hash = [](int x, int y, int z) {
			return (std::uint64_t(x + 1000) << 42) | (std::uint64_t(y + 1000) << 21) | std::uint64_t(z + 1000);
		};
		const auto at = [&](double x) { return int(std::floor(x / cell)); };
		std::unordered_map<std::uint64_t, std::vector<int>> cells;
		for (std::size_t i = 1; i < grains.size(); ++i) {
			const Vector3& p = grains[i].centre;
			cells[hash(at(p[0]), at(p[1]), at(p[2]))].push_back(int(i));
		}
		std::vector<int> near;
		for (int i = 1; i < int(grains.size()); ++i) {
			const Vector3& p = grains[i].centre;
			for (int axis = 0; axis < 3; ++axis) {
				const double low = p[axis] - grains[i].radius, high = width - p[axis] - grains[i].radius;
				if (low < reach[i]) add(0, i, Vector3::Unit(axis), low, h);
				if (axis < 2 && high < reach[i]) add(0, i, -Vector3::Unit(axis), high, h);
			}
			near.clear();
			for (int dx = -1; dx <= 1; ++dx)
				for (int dy = -1; dy <= 1; ++dy)
					for (int dz = -1; dz <= 1; ++dz) {
						const auto found = cells.find(hash(at(p[0]) + dx, at(p[1]) + dy, at(p[2]) + dz));
						if (found == cells.end()) continue;
						for (const int j : found->second)
							if (j > i && (grains[j].centre - p).squaredNorm() < (reach[i] + reach[j]) * (reach[i] + reach[j])) near.push_back(j);
					}
			std::sort(near.begin(), near.end());
			for (const int j : near) {
				const Vector3 d = grains[j].centre - p;
				const double distance = d.norm();
				add(i, j, d / distance, distance - grains[i].radius - grains[j].radius, h);
			}
		}
	}
};

} // namespace contactdynamics
