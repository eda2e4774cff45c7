// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "BlockProblem.hpp"
#include "JoinedGroups.hpp"
#include "ProblemBlocks.hpp"
#include "Squeeze.hpp"

namespace contactdynamics {

/// The factor of what further sweeps add from which on there is no solution.
inline constexpr double certainSqueezeOfBlocks = 1000;

/// The factor of Squeeze.hpp where W is explicit and the bodies are unknown: - sum r_N u_N over r.W r. What is missing to a solution is at least so
/// many times r in the norm of energy, as - sum r_N u_N <= r.W (r* - r) <= |r| |r* - r|. A mass that is a million times that between it and a wall
/// which moves can deceive it. Rejected: the approach times the root of the masses 1 / W_NN instead of |r|. W_NN of a light grain under a heavy one
/// does not know the heavy one, and a column of 30 under a mass of a thousand took it in.
/// @param r, u  impulses and velocities at a point [N s], [m/s];  @param others  impulses to be taken away, or none
template <int D> double squeezeFactor(const BlockProblem& problem, const std::vector<Eigen::Matrix<double, D, 1>>& r,
									  const std::vector<Eigen::Matrix<double, D, 1>>& u,
									  const std::vector<Eigen::Matrix<double, D, 1>>* others = nullptr)
{
	using Vector = Eigen::Matrix<double, D, 1>;
	struct Held { // a group of contacts so far
		double work = 0, energy = 0, total = 0;

		void add(const Held& other)
		{
			work += other.work;
			energy += other.energy;
			total += other.total;
		}
	};
	const std::size_t count = problem.contacts();
	const auto added = [&](std::size_t i) -> Vector { return others ? Vector(r[i] - (*others)[i]) : r[i]; };
	double remains = 0; // of the approach
	for (std::size_t i = 0; i < count; ++i)
		if (r[i][0] > 0) remains = std::max(remains, -u[i][0]);
	if (!(remains > Squeeze::leastApproach * largestFreeApproach<D>(problem))) return 0;
	std::vector<std::int32_t> loaded;
	for (std::size_t i = 0; i < count; ++i)
		if (added(i)[0] > 0) loaded.push_back(std::int32_t(i));
	std::sort(loaded.begin(), loaded.end(), [&](std::int32_t a, std::int32_t b) {
		const double ra = added(a)[0], rb = added(b)[0];
		return ra != rb ? ra > rb : a < b;
	});
	JoinedGroups<Held> groups;
	groups.reset(count);
	std::vector<std::uint8_t> isIn(count, 0);
	double factor = 0;
	for (const std::int32_t i : loaded) {
		isIn[i] = 1;
		const Vector its = added(i);
		double energy = 0;
		for (std::int32_t k = problem.rowStart[i]; k < problem.rowStart[i + 1]; ++k) {
			const std::int32_t j = problem.column[k];
			if (!isIn[j]) continue;
			groups.join(i, j);
			energy += (i == j ? 1 : 2) * its.dot(blockOf<D>(problem, k) * added(j));
		}
		Held& held = groups.of(i);
		held.add({-its[0] * u[i][0], energy, its.dot(diagonalBlockOf<D>(problem, i) * its)});
		const double roundOff = 1e-14 * held.total;
		factor = std::max(factor, held.work / std::max(roundOff, held.energy));
	}
	return factor;
}

} // namespace contactdynamics
