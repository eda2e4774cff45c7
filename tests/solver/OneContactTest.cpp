// SPDX-License-Identifier: GPL-2.0-or-later
// One contact against a brute-force evaluation that shares no formula with it: scan of the sliding direction, refined by bisection.
#include "pkg/solver/OneContact.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <random>

using namespace contactdynamics;

namespace {

/// Violation of Signorini and Coulomb at r, relative to |b| + |W| |r|: what round-off of u = W r + b is measured by (backward error).
double violation(const Matrix3& W, const Vector3& b, double mu, const Vector3& r)
{
	const Vector3 u = W * r + b;
	const double velocity = b.norm() + W.norm() * r.norm(), rt = r.tail<2>().norm(), ut = u.tail<2>().norm();
	if (velocity == 0) return 0;
	double worst = std::max({0.0, -r[0] * W(0, 0) / velocity, -u[0] / velocity});
	worst = std::max(worst, std::min(std::abs(r[0]) * W(0, 0), std::abs(u[0])) / velocity);
	if (rt > 0 || r[0] > 0) worst = std::max(worst, (rt - mu * r[0]) / (rt + mu * r[0] + 1e-300));
	const bool inside = rt < mu * r[0] * (1 - 1e-9);
	if (inside) return std::max(worst, ut / velocity);
	if (rt > 0) { // on the boundary: u_t opposite to r_t, or zero
		const Eigen::Vector2d e = r.tail<2>() / rt, t = u.tail<2>();
		worst = std::max(worst, std::abs(e[0] * t[1] - e[1] * t[0]) / velocity);
		worst = std::max(worst, t.dot(e) / velocity);
	}
	return worst;
}

/// All solutions with a closed contact: sticking by a pivoted factorisation, sliding by a scan over the direction of the friction.
std::vector<Vector3> bruteForce(const Matrix3& W, const Vector3& b, double mu)
{
	std::vector<Vector3> found;
	const Vector3 stick = W.fullPivLu().solve(-b);
	if ((W * stick + b).norm() < 1e-9 * b.norm() && stick.tail<2>().norm() <= mu * stick[0] * (1 + 1e-9)) found.push_back(stick);
	const auto impulse = [&](double angle) -> Vector3 {
		const Vector3 d(1, mu * std::cos(angle), mu * std::sin(angle));
		return d * (-b[0] / W.row(0).dot(d));
	};
	const auto turn = [&](double angle) { // zero where the sliding velocity is parallel to the friction
		const Vector3 u = W * impulse(angle) + b;
		return std::cos(angle) * u[2] - std::sin(angle) * u[1];
	};
	const int steps = 720;
	double last = turn(0);
	for (int i = 1; i <= steps; ++i) {
		double low = 2 * M_PI * (i - 1) / steps, high = 2 * M_PI * i / steps;
		const double now = turn(high);
		if ((last > 0) != (now > 0)) {
			for (int k = 0; k < 60; ++k) {
				const double middle = 0.5 * (low + high);
				((turn(middle) > 0) == (last > 0) ? low : high) = middle;
			}
			const Vector3 r = impulse(low), u = W * r + b;
			if (r[0] > 0 && u[1] * std::cos(low) + u[2] * std::sin(low) <= 0) found.push_back(r);
		}
		last = now;
	}
	return found;
}

struct Generator {
	std::mt19937_64 engine{20230217};
	std::normal_distribution<double> normal;
	std::uniform_real_distribution<double> uniform{0, 1};

	Vector3 vector() { return {normal(engine), normal(engine), normal(engine)}; }
	/// A contact of two bodies with random arms and inertia, mass ratio 10^-6 .. 10^6: anisotropic, coupled.
	Matrix3 rigidPair()
	{
		Matrix3 W = Matrix3::Zero();
		for (int body = 0; body < 2; ++body) {
			const double inverseMass = std::pow(10, -6 * uniform(engine));
			const Vector3 a = vector();
			Matrix3 s, basis;
			s << 0, -a[2], a[1], a[2], 0, -a[0], -a[1], a[0], 0;
			basis = Eigen::Quaterniond(normal(engine), normal(engine), normal(engine), normal(engine)).normalized().toRotationMatrix();
			const Vector3 inertia(uniform(engine) + 0.02, uniform(engine) + 0.02, uniform(engine) + 0.02);
			W += inverseMass * (Matrix3::Identity() + s.transpose() * basis * inertia.asDiagonal() * basis.transpose() * s);
		}
		return W;
	}
	/// Symmetric positive definite with condition number up to 10^8.
	Matrix3 nearlySingular()
	{
		const Matrix3 basis = Eigen::Quaterniond(normal(engine), normal(engine), normal(engine), normal(engine)).normalized().toRotationMatrix();
		const Vector3 e(std::pow(10, -8 * uniform(engine)), std::pow(10, -8 * uniform(engine)), 1);
		return basis * e.asDiagonal() * basis.transpose();
	}
	/// Any velocity, or a degenerate one: no approach or exactly none, no tangential part, along one axis, or on the edge between sticking and
	/// sliding.
	Vector3 freeVelocity(const Matrix3& W, double mu)
	{
		Vector3 b = vector();
		const double kind = uniform(engine);
		if (kind < 0.05)
			b.tail<2>().setZero();
		else if (kind < 0.10)
			b[0] = 0;
		else if (kind < 0.15)
			b[1 + int(2 * uniform(engine))] = 0;
		else if (kind < 0.20) {
			const double angle = 2 * M_PI * uniform(engine);
			b = -W * Vector3(1, mu * std::cos(angle), mu * std::sin(angle));
		} else if (kind < 0.21)
			b.setZero();
		return b;
	}
	double friction() { return uniform(engine) < 0.1 ? 0 : 5 * std::pow(uniform(engine), 2); }
};

} // namespace

TEST(OneContact, SatisfiesTheLawsAndIsFoundByBruteForce)
{
	Generator random;
	int sticking = 0, sliding = 0, unique = 0;
	for (int i = 0; i < 100000; ++i) {
		const bool singular = i % 4 == 3;
		const Matrix3 W = singular ? random.nearlySingular() : random.rigidPair();
		const double scale = std::pow(10, 6 * random.uniform(random.engine) - 3), mu = random.friction();
		const Vector3 b = scale * random.freeVelocity(W, mu);
		const Vector3 r = OneContact(W).solve(b, mu);
		// A hundred operations of 2.2e-16 each, all measured by |b| + |W| |r|.
		ASSERT_LE(violation(W, b, mu, r), 2e-14) << "problem " << i << "\nW\n"
												 << W << "\nb " << b.transpose() << " mu " << mu << " r " << r.transpose();
		if (b[0] >= 0) {
			ASSERT_EQ(r, Vector3::Zero());
			continue;
		}
		(r.tail<2>().norm() < mu * r[0] * (1 - 1e-9) ? sticking : sliding)++;
		if (singular || mu == 0) continue; // the scan would need a step below the width of the roots
		const std::vector<Vector3> all = bruteForce(W, b, mu);
		if (all.size() == 1) ++unique;
		double nearest = 1e300;
		for (const Vector3& other : all) nearest = std::min(nearest, std::sqrt((other - r).dot(W * (other - r)) / r.dot(W * r)));
		// Roots closer than the scan step (half a degree) come in pairs and are missed by the scan: then the laws alone decide.
		if (!all.empty() || mu * W.row(0).tail<2>().norm() < W(0, 0)) {
			ASSERT_LE(nearest, 1e-6) << "problem " << i << ", " << all.size() << " solutions\nW\n"
									 << W << "\nb " << b.transpose() << " mu " << mu << " r " << r.transpose();
		}
	}
	EXPECT_GT(sticking, 10000);
	EXPECT_GT(sliding, 10000);
	EXPECT_GT(unique, 20000);
}
