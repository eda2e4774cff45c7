// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <Eigen/Dense>
#include <Eigen/SparseLU>

#include <cstdint>
#include <vector>

namespace contactdynamics {

/// Order of elimination with little fill for rows of blocks as BlockProblem has them: indices()[k] is eliminated k-th.
Eigen::PermutationMatrix<Eigen::Dynamic> minimumDegree(const std::vector<std::int32_t>& rowStart, const std::vector<std::int32_t>& column);

/// Whether a matrix with so many blocks or entries is factorised faster as a dense one, from a hundred unknowns on.
inline bool nearlyFull(double entries, double rows) { return entries > 0.8 * rows * rows; }

/// A square matrix of D x D blocks with its LU factors: sparse, or dense where it has less than a hundred unknowns or is nearly full.
///
/// It is kept in the order of minimum degree. Eigen::SparseLU with Eigen::AMDOrdering was rejected: it takes the permutation for its inverse, which
/// fills the factors of a packing of 761 contacts with 1,380,000 instead of 180,000 numbers (342 instead of 8 ms).
template <int D> class BlockSystem {
public:
	using Block = Eigen::Matrix<double, D, D>;

	/// The blocks of row i are in the columns column[rowStart[i]] ... column[rowStart[i + 1] - 1], in any order, a diagonal block among them, those
	/// in the same place are summed. All are zero.
	void layOut(const std::vector<std::int32_t>& rowStart, const std::vector<std::int32_t>& column);

	void setZero();
	void add(std::size_t k, const Block& block) { addAt(place[k], block); } ///< to block k of the rows
	void addToDiagonal(std::size_t i, const Block& block) { addAt(diagonal[i], block); }

	bool factorise(); ///< @return false where a pivot is zero or no number; there are no factors then

	Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
	double signOfDeterminant() const { return sign; } ///< of the last factorise()
	double operations() const { return cost; }		  ///< of the last factorise(), an estimate by the size of its factors; 0 before

private:
	struct Place {
		int first;	// number of the block among the values of the matrix
		int stride; // to its next column
	};

	std::vector<int> position; // of a row and column of blocks in the matrix
	std::vector<Place> place, diagonal;
	Eigen::SparseMatrix<double> matrix;
	Eigen::SparseLU<Eigen::SparseMatrix<double>, Eigen::NaturalOrdering<int>> factor;
	Eigen::PartialPivLU<Eigen::MatrixXd> denseFactor;
	double sign = 1, cost = 0;

	bool isDense() const;

	void addAt(Place to, const Block& block)
	{
		double* values = matrix.valuePtr() + to.first;
		for (int b = 0; b < D; ++b, values += to.stride)
			for (int a = 0; a < D; ++a) values[a] += block(a, b);
	}

	Eigen::VectorXd reordered(const Eigen::VectorXd& b, bool back) const;
};

} // namespace contactdynamics
