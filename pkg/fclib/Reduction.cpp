// SPDX-License-Identifier: GPL-2.0-or-later
#include "Reduction.hpp"

#include <Eigen/SparseLU>
#include <algorithm>
#include <stdexcept>

namespace contactdynamics::fclib {

namespace {

void add(std::vector<Eigen::Triplet<double>>& entries, const Sparse& part, Eigen::Index row, Eigen::Index column)
{
	for (Eigen::Index j = 0; j < part.outerSize(); ++j)
		for (Sparse::InnerIterator entry(part, j); entry; ++entry)
			entries.emplace_back(int(entry.row() + row), int(entry.col() + column), entry.value());
}

} // namespace

Sparse bordered(const Sparse& topLeft, const Sparse& topRight, const Sparse& bottomLeft)
{
	std::vector<Eigen::Triplet<double>> entries;
	add(entries, topLeft, 0, 0);
	add(entries, topRight, 0, topLeft.cols());
	add(entries, bottomLeft, topLeft.rows(), 0);
	Sparse whole(topLeft.rows() + bottomLeft.rows(), topLeft.cols() + topRight.cols());
	whole.setFromTriplets(entries.begin(), entries.end());
	return whole;
}

Reduced eliminate(const Sparse& K, const Sparse& B, const Eigen::VectorXd& c, const Sparse& C, const Eigen::VectorXd& w)
{
	Eigen::SparseLU<Sparse> lu;
	lu.compute(K);
	if (lu.info() != Eigen::Success) throw std::domain_error("is singular");
	const Sparse X = lu.solve(B), Ct = C.transpose();
	const Eigen::VectorXd x = lu.solve(c);
	Reduced reduced{Ct * X, Ct * x + w};
	// Round-off lets a singular matrix through the factorisation now and then; its solution is not finite.
	if (!reduced.q.allFinite() || !reduced.W.coeffs().allFinite()) throw std::domain_error("is singular");
	return reduced;
}

BlockProblem blocksOf(int dimension, const Sparse& W, const Eigen::VectorXd& q, std::vector<double> friction)
{
	BlockProblem problem;
	problem.dimension = dimension;
	problem.friction = std::move(friction);
	problem.q.assign(q.data(), q.data() + q.size());
	problem.impulse.assign(problem.q.size(), 0);
	problem.velocity = problem.q;
	problem.rowStart.push_back(0);
	const Eigen::SparseMatrix<double, Eigen::RowMajor> rows = W;
	const int contacts = int(problem.contacts());
	std::vector<int> place(problem.contacts(), -1), neighbours; // where the block of a contact lies in the row at work
	for (int i = 0; i < contacts; ++i) {
		neighbours.assign(1, i);
		place[i] = 0;
		for (int row = dimension * i; row < dimension * (i + 1); ++row)
			for (decltype(rows)::InnerIterator entry(rows, row); entry; ++entry) {
				const int j = int(entry.col()) / dimension;
				if (place[j] >= 0) continue;
				place[j] = 0;
				neighbours.push_back(j);
			}
		std::sort(neighbours.begin(), neighbours.end());
		for (const int j : neighbours) {
			place[j] = int(problem.column.size());
			problem.column.push_back(j);
		}
		problem.blocks.resize(std::size_t(dimension) * dimension * problem.column.size(), 0);
		for (int row = 0; row < dimension; ++row)
			for (decltype(rows)::InnerIterator entry(rows, dimension * i + row); entry; ++entry) {
				const int j = int(entry.col()) / dimension, column = int(entry.col()) % dimension;
				problem.blocks[std::size_t(dimension) * (std::size_t(dimension) * place[j] + row) + column] = entry.value();
			}
		for (const int j : neighbours) place[j] = -1;
		problem.rowStart.push_back(int(problem.column.size()));
	}
	return problem;
}

Sparse matrixOf(const BlockProblem& problem)
{
	const int d = problem.dimension;
	std::vector<Eigen::Triplet<double>> entries;
	for (std::size_t i = 0; i < problem.contacts(); ++i)
		for (int k = problem.rowStart[i]; k < problem.rowStart[i + 1]; ++k)
			for (int e = 0; e < d * d; ++e)
				entries.emplace_back(int(d * i) + e / d, d * problem.column[k] + e % d, problem.blocks[std::size_t(d) * d * k + e]);
	Sparse W(Eigen::Index(problem.q.size()), Eigen::Index(problem.q.size()));
	W.setFromTriplets(entries.begin(), entries.end());
	return W;
}

} // namespace contactdynamics::fclib
