// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <pkg/geometry/Manifold.hpp>

#include <Eigen/Geometry>
#include <random>

namespace bodies {
using contactdynamics::ConvexShape;
using contactdynamics::DecidingFeature;
using contactdynamics::ManifoldPoint;
using contactdynamics::PlacedShape;
using contactdynamics::Separation;
using contactdynamics::Vector3;

/// Own pseudo-random numbers in [-1, 1): std::uniform_real_distribution differs between libraries.
class Random {
public:
	explicit Random(unsigned seed) : engine(seed) {}
	double operator()() { return 2 * (engine() / 4294967296.) - 1; }
	int below(int count) { return static_cast<int>(engine() % static_cast<unsigned>(count)); }
	Vector3 vector()
	{
		const double x = (*this)(), y = (*this)(), z = (*this)();
		return {x, y, z};
	}
	Eigen::Matrix3d rotation()
	{
		const double w = (*this)(), x = (*this)(), y = (*this)(), z = (*this)();
		return Eigen::Quaterniond(w + 2, 3 * x, 3 * y, 3 * z).normalized().toRotationMatrix();
	}

private:
	std::mt19937 engine;
};

inline PlacedShape placed(const ConvexShape& shape, const Vector3& at, const Eigen::Matrix3d& rotation = Eigen::Matrix3d::Identity())
{
	PlacedShape body;
	body.place(shape, rotation, at);
	return body;
}

struct Found {
	Separation separation;
	std::vector<ManifoldPoint> points;
};
inline Found contact(const PlacedShape& one, const PlacedShape& two, double reach, const DecidingFeature& last = {})
{
	Found found;
	found.separation = findManifold(one, two, reach, last, found.points);
	return found;
}
} // namespace bodies
