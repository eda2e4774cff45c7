// SPDX-License-Identifier: GPL-2.0-or-later
#include "NewtonStep.hpp"

#include "ProblemBlocks.hpp"

#include <algorithm>

namespace contactdynamics {

namespace {
constexpr double assembly = 50; // sweeps: building, ordering, and what of the elimination goes with the size of the matrix; measured
} // namespace

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

	if (position != positionBefore) layOut(active);
	system.setZero();
	right.resize(D * active);
	std::size_t kept = 0; // blocks
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
			system.add(kept++, scaled);
		}
		system.addToDiagonal(std::size_t(position[i]), B);
		right.template segment<D>(D * position[i]) = -value;
	}
	if (active > 0) {
		if (!system.factorise()) return false;
		solution = system.solve(right);
		if (!solution.allFinite()) return false;
	}
	next.resize(count);
	for (std::size_t i = 0; i < count; ++i)
		next[i] = position[i] < 0 ? Vector(Vector::Zero()) : Vector(r[i] + solution.template segment<D>(D * position[i]));
	return true;
}

template <int D> double NewtonStep<D>::cost() const
{
	const int count = int(problem.contacts());
	const double blocks = double(problem.column.size());
	double pairs = count * (count + 1.0) * (2.0 * count + 1) / 6;
	if (!nearlyFull(blocks, count)) {
		// Column counts of the Cholesky factor of the block pattern, by a walk up the elimination tree from every entry of a row.
		const Eigen::PermutationMatrix<Eigen::Dynamic> place = minimumDegree(problem.rowStart, problem.column).inverse();
		std::vector<std::vector<int>> before(count); // entries of a row, of the pattern and its transpose
		for (int i = 0; i < count; ++i)
			for (int k = problem.rowStart[i]; k < problem.rowStart[i + 1]; ++k) {
				const auto [first, second] = std::minmax(place.indices()[i], place.indices()[problem.column[k]]);
				before[second].push_back(first);
			}
		std::vector<int> parent(count, -1), seen(count, -1), below(count, 0);
		for (int row = 0; row < count; ++row) {
			seen[row] = row;
			for (int column : before[row])
				for (; seen[column] != row; column = parent[column]) {
					if (parent[column] < 0) parent[column] = row;
					++below[column];
					seen[column] = row;
				}
		}
		pairs = 0;
		for (const int entries : below) pairs += (entries + 1.0) * (entries + 1.0);
	}
	return 2 * D * D * (assembly * blocks + D * pairs);
}

template <int D> void NewtonStep<D>::layOut(int active)
{
	std::vector<std::int32_t> rowStart{0}, column;
	rowStart.reserve(active + 1);
	for (std::size_t i = 0; i < problem.contacts(); ++i) {
		if (position[i] < 0) continue;
		for (int k = problem.rowStart[i]; k < problem.rowStart[i + 1]; ++k)
			if (const int j = position[problem.column[k]]; j >= 0) column.push_back(j);
		rowStart.push_back(int(column.size()));
	}
	system.layOut(rowStart, column);
}

template class NewtonStep<2>;
template class NewtonStep<3>;

} // namespace contactdynamics
