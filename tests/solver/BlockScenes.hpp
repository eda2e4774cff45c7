// SPDX-License-Identifier: GPL-2.0-or-later
// Block problems made here: walls of bricks, random semi-definite W. Fixed seeds.
#pragma once

#include "IndependentResidual.hpp"
#include "pkg/solver/BlockProblem.hpp"

#include <Eigen/Dense>
#include <random>

namespace contactdynamics::scenes {

using DenseMatrix = Eigen::MatrixXd;

/// u = W r + q from the factors W = H^T B H, q = H^T v; blocks that vanish exactly are left out, except on the diagonal.
inline BlockProblem blockProblem(int dimension, const DenseMatrix& H, const DenseMatrix& inverseMass, const Eigen::VectorXd& v, double friction)
{
	BlockProblem p;
	p.dimension = dimension;
	const int count = int(H.cols()) / dimension;
	const DenseMatrix W = H.transpose() * inverseMass * H;
	const Eigen::VectorXd q = H.transpose() * v;
	p.rowStart.push_back(0);
	for (int i = 0; i < count; ++i) {
		for (int j = 0; j < count; ++j) {
			const DenseMatrix block = W.block(dimension * i, dimension * j, dimension, dimension);
			if (i != j && block.isZero(0)) continue;
			p.column.push_back(j);
			for (int k = 0; k < dimension * dimension; ++k) p.blocks.push_back(block(k / dimension, k % dimension));
		}
		p.rowStart.push_back(int(p.column.size()));
	}
	p.q.assign(q.data(), q.data() + q.size());
	p.friction.assign(count, friction);
	p.impulse.assign(dimension * count, 0);
	return p;
}

/// Two contacts push one body from both sides: u_1 = r_1 - r_2 - 1 and u_2 = r_2 - r_1 - 1 cannot both be >= 0, there is no solution.
inline BlockProblem squeezed()
{
	BlockProblem p;
	p.dimension = 2;
	p.rowStart = {0, 2, 4};
	p.column = {0, 1, 0, 1};
	p.blocks = {1, 0, 0, 1, -1, 0, 0, 1, -1, 0, 0, 1, 1, 0, 0, 1};
	p.q = {-1, 0, -1, 0};
	p.friction = {0.5, 0.5};
	p.impulse.assign(4, 0);
	return p;
}

struct Wall {
	int dimension = 3, rows = 4, bricks = 3; ///< bricks in the lowest row; every other row has one less, shifted by half a brick
	double friction = 0.6;
	double push = 0.05;	   ///< random velocities and spins beside gravity's 0.0981 m/s
	double decades = 0;	   ///< masses spread over this many powers of ten
	double massUnit = 1;   ///< all masses times this
	double gyroscopic = 0; ///< skew part of the inverse inertia, relative: makes W unsymmetric without changing its rank
	unsigned seed = 1;
};

/// Bricks 2 x 1 x 1 on a floor, contacts at the corners of every face they share: 4 in three dimensions, 2 in two. W has rank 6 (3) per brick at
/// most.
inline BlockProblem wall(const Wall& s)
{
	std::mt19937_64 random(s.seed);
	std::uniform_real_distribution<double> uniform(-1, 1);
	std::vector<Vector3> centre;
	std::vector<int> firstOfRow;
	for (int row = 0; row < s.rows; ++row) {
		firstOfRow.push_back(int(centre.size()));
		for (int i = 0; i < s.bricks - row % 2; ++i) centre.emplace_back(2 * i + row % 2, 0, row + 0.5);
	}
	firstOfRow.push_back(int(centre.size()));
	const int bodies = int(centre.size());

	DenseMatrix inverseMass = DenseMatrix::Zero(6 * bodies, 6 * bodies);
	Eigen::VectorXd v = Eigen::VectorXd::Zero(6 * bodies);
	for (int b = 0; b < bodies; ++b) {
		const double mass = s.massUnit * std::pow(10, 0.5 * s.decades * uniform(random));
		const Vector3 inertia = mass / 12 * Vector3(1 + 1, 4 + 1, 4 + 1);
		inverseMass.block<3, 3>(6 * b, 6 * b).diagonal().setConstant(1 / mass);
		inverseMass.block<3, 3>(6 * b + 3, 6 * b + 3).diagonal() = inertia.cwiseInverse();
		const Vector3 spin = s.gyroscopic / inertia[0] * Vector3(uniform(random), uniform(random), uniform(random));
		for (int k = 0; k < 3; ++k) inverseMass.block<3, 1>(6 * b + 3, 6 * b + 3 + k) += spin.cross(Vector3(Vector3::Unit(k)));
		for (int k = 0; k < 6; ++k) v[6 * b + k] = s.push * uniform(random);
		v[6 * b + 2] -= 0.0981;
		if (s.dimension == 2) v[6 * b + 1] = v[6 * b + 3] = v[6 * b + 5] = 0;
	}

	std::vector<Eigen::VectorXd> columns;
	const auto touch = [&](int below, int above, double x, double y, double z) {
		Eigen::Matrix3d frame; // rows n, t1, t2
		frame << 0, 0, 1, 1, 0, 0, 0, 1, 0;
		const Vector3 point(x, y, z);
		for (int k = 0; k < s.dimension; ++k) {
			Eigen::VectorXd column = Eigen::VectorXd::Zero(6 * bodies);
			const Vector3 axis = frame.row(k);
			column.segment<6>(6 * above) << axis, (point - centre[above]).cross(axis);
			if (below >= 0) column.segment<6>(6 * below) << -axis, -(point - centre[below]).cross(axis);
			columns.push_back(column);
		}
	};
	for (int row = 0; row < s.rows; ++row)
		for (int b = firstOfRow[row]; b < firstOfRow[row + 1]; ++b) {
			const int under = row ? firstOfRow[row - 1] : -1, underEnd = row ? firstOfRow[row] : 0;
			for (int c = under; c < underEnd; ++c) {
				const double from = std::max(centre[b].x() - 1, c < 0 ? -1e9 : centre[c].x() - 1),
							 to = std::min(centre[b].x() + 1, c < 0 ? 1e9 : centre[c].x() + 1);
				if (to - from < 1e-9) continue;
				for (const double x : {from, to}) {
					if (s.dimension == 2)
						touch(c, b, x, 0, row);
					else
						for (const double y : {-0.5, 0.5}) touch(c, b, x, y, row);
				}
			}
		}
	DenseMatrix H(6 * bodies, columns.size());
	for (std::size_t i = 0; i < columns.size(); ++i) H.col(i) = columns[i];
	return blockProblem(s.dimension, H, inverseMass, v, s.friction);
}

/// W = H^T H with random H of so many rows, q in its range: a solution exists (u = 0 is reachable).
inline BlockProblem randomProblem(int dimension, int contacts, int rank, double friction, unsigned seed)
{
	std::mt19937_64 random(seed);
	std::normal_distribution<double> normal;
	DenseMatrix H(rank, dimension * contacts);
	for (double& entry : H.reshaped()) entry = normal(random);
	Eigen::VectorXd v(rank);
	for (double& entry : v) entry = normal(random);
	return blockProblem(dimension, H, DenseMatrix::Identity(rank, rank), v, friction);
}

/// Siconos's error once more, from its text.
inline double siconosError(const BlockProblem& p)
{
	const int d = p.dimension;
	double sum = 0, q2 = 0, r2 = 0, u2 = 0;
	for (int i = 0; i < int(p.contacts()); ++i) {
		Vector3 u = Vector3::Zero(), r = Vector3::Zero();
		for (int row = 0; row < d; ++row) {
			r[row] = p.impulse[d * i + row];
			u[row] = p.q[d * i + row];
			q2 += u[row] * u[row];
			for (int k = p.rowStart[i]; k < p.rowStart[i + 1]; ++k)
				for (int col = 0; col < d; ++col) u[row] += p.blocks[d * d * k + d * row + col] * p.impulse[d * p.column[k] + col];
		}
		r2 += r.squaredNorm();
		u2 += u.squaredNorm();
		const Vector3 n = Vector3::UnitX();
		sum += (r - independent::nearestInCone(r - u - p.friction[i] * u.tail<2>().norm() * n, n, p.friction[i])).squaredNorm();
	}
	const double scale = std::sqrt(std::max({q2, r2, u2}));
	return scale > 2.2e-16 ? std::sqrt(sum) / scale : std::sqrt(sum);
}

} // namespace contactdynamics::scenes
