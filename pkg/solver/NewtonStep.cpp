// SPDX-License-Identifier: GPL-2.0-or-later
#include "NewtonStep.hpp"

#include "ProblemBlocks.hpp"

namespace contactdynamics {

template <int D> NewtonStep<D>::NewtonStep(const BlockProblem& given) : problem(given)
{
	for (std::size_t i = 0; i < problem.contacts(); ++i) {
		const Block diagonal = diagonalBlockOf<D>(problem, i);
		const double tangential = diagonal.diagonal().template tail<D - 1>().sum() / (D - 1);
		normalScale.push_back(diagonal(0, 0) > 0 ? 1 / diagonal(0, 0) : 0);
		tangentScale.push_back(tangential > 0 ? 1 / tangential : 0);
	}
}

template <int D> bool NewtonStep<D>::compute(const std::vector<Vector>& r, const std::vector<Vector>& u, double damping, std::vector<Vector>& next)
{
	const std::size_t count = problem.contacts();
	positionBefore.swap(position);
	position.assign(count, -1);
	int active = 0;
	for (std::size_t i = 0; i < count; ++i)
		if (normalScale[i] > 0 && r[i][0] - normalScale[i] * u[i][0] > 0) position[i] = active++;

	right.resize(D * active);
	std::vector<Eigen::Triplet<double>> entries;
	for (std::size_t i = 0; i < count; ++i) {
		if (position[i] < 0) continue;
		// The row of contact i reads  B dr_i + A du_i = -value.
		const double pN = normalScale[i], pT = tangentScale[i], mu = problem.friction[i];
		Block A = Block::Zero(), B = damping * Block::Identity();
		Vector value;
		A(0, 0) = pN;
		value[0] = pN * u[i][0];
		using Tangent = Eigen::Matrix<double, D - 1, 1>;
		using TangentBlock = Eigen::Matrix<double, D - 1, D - 1>;
		const Tangent rT = r[i].template tail<D - 1>(), uT = u[i].template tail<D - 1>(), zT = rT - pT * uT;
		const double zN = r[i][0] - pN * u[i][0], length = zT.norm();
		if (mu > 0 && pT > 0 && length <= mu * zN) {
			A.diagonal().template tail<D - 1>().setConstant(pT);
			value.template tail<D - 1>() = pT * uT;
		} else if (mu > 0 && length > 0) {
			const Tangent t = zT / length;
			const TangentBlock across = (mu * zN / length) * (TangentBlock::Identity() - t * t.transpose());
			value.template tail<D - 1>() = rT - mu * zN * t;
			B.template bottomRightCorner<D - 1, D - 1>() += TangentBlock::Identity() - across;
			A.template bottomRightCorner<D - 1, D - 1>() = pT * across;
			B.template bottomLeftCorner<D - 1, 1>() = -mu * t;
			A.template bottomLeftCorner<D - 1, 1>() = mu * pN * t;
		} else {
			B.diagonal().template tail<D - 1>().setOnes();
			value.template tail<D - 1>() = rT;
		}
		for (int k = problem.rowStart[i]; k < problem.rowStart[i + 1]; ++k) {
			const std::size_t j = problem.column[k];
			const Block W = blockOf<D>(problem, k);
			const Block scaled = A * W;
			if (position[j] < 0) {
				value -= scaled * r[j]; // it opens: its impulse goes
				continue;
			}
			for (int row = 0; row < D; ++row)
				for (int col = 0; col < D; ++col) entries.emplace_back(D * position[i] + row, D * position[j] + col, scaled(row, col));
		}
		for (int row = 0; row < D; ++row)
			for (int col = 0; col < D; ++col) entries.emplace_back(D * position[i] + row, D * position[i] + col, B(row, col));
		right.template segment<D>(D * position[i]) = -value;
	}
	if (active > 0 && !factorAndSolve(D * active, position == positionBefore, entries)) return false;
	if (active > 0 && !solution.allFinite()) return false;
	next.resize(count);
	for (std::size_t i = 0; i < count; ++i)
		next[i] = position[i] < 0 ? Vector(Vector::Zero()) : Vector(r[i] + solution.template segment<D>(D * position[i]));
	return true;
}

template <int D> double NewtonStep<D>::cost() const
{
	// Column counts of the Cholesky factor of the block pattern, by a walk up the elimination tree from every entry of a row.
	const int count = int(problem.contacts());
	std::vector<Eigen::Triplet<double>> entries;
	for (int i = 0; i < count; ++i)
		for (int k = problem.rowStart[i]; k < problem.rowStart[i + 1]; ++k) {
			entries.emplace_back(i, problem.column[k], 1);
			entries.emplace_back(problem.column[k], i, 1);
		}
	Eigen::SparseMatrix<double> pattern(count, count);
	pattern.setFromTriplets(entries.begin(), entries.end());
	Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
	Eigen::AMDOrdering<int>()(pattern, order);
	Eigen::SparseMatrix<double> ordered;
	ordered = pattern.twistedBy(order.inverse());
	std::vector<int> parent(count, -1), seen(count, -1), below(count, 0);
	for (int row = 0; row < count; ++row) {
		seen[row] = row;
		for (Eigen::SparseMatrix<double>::InnerIterator entry(ordered, row); entry; ++entry)
			for (int column = int(entry.row()); column < row && seen[column] != row; column = parent[column]) {
				if (parent[column] < 0) parent[column] = row;
				++below[column];
				seen[column] = row;
			}
	}
	double pairs = 0;
	for (const int blocks : below) pairs += (blocks + 1.0) * (blocks + 1.0);
	constexpr double overhead = 10; // measured: assembly, ordering and indirect addressing, against the straight products of a sweep
	return overhead * 2 * D * D * D * pairs;
}

template <int D> bool NewtonStep<D>::factorAndSolve(int size, bool samePattern, const std::vector<Eigen::Triplet<double>>& entries)
{
	system.matrix.resize(size, size);
	system.matrix.setFromTriplets(entries.begin(), entries.end());
	if (!samePattern) system.analyse();
	if (!system.factorise()) {
		position.clear(); // no pattern to keep
		return false;
	}
	solution = system.solve(right);
	return true;
}

template class NewtonStep<2>;
template class NewtonStep<3>;

} // namespace contactdynamics
