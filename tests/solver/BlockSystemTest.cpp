// SPDX-License-Identifier: GPL-2.0-or-later
#include <pkg/solver/BlockSystem.hpp>

#include <gtest/gtest.h>

#include <random>

using namespace contactdynamics;

namespace {

// Rows of blocks in no order, the diagonal among them, some blocks in two parts; and the same matrix densely.
template <int D> struct Case {
	using Block = Eigen::Matrix<double, D, D>;
	std::vector<std::int32_t> rowStart{0}, column;
	std::vector<Block> blocks;
	Eigen::MatrixXd dense;

	/// @param shift  added to the diagonal: large ones keep the determinant positive
	Case(int count, double filled, double shift, unsigned seed) : dense(Eigen::MatrixXd::Zero(D * count, D * count))
	{
		std::mt19937 random(seed);
		std::uniform_real_distribution<double> uniform(-1, 1);
		for (int i = 0; i < count; ++i) {
			std::vector<int> columns{i};
			for (int j = 0; j < count; ++j)
				if (j != i && std::abs(uniform(random)) < filled) columns.push_back(j);
			columns.push_back(columns[columns.size() / 2]);
			std::shuffle(columns.begin(), columns.end(), random);
			for (const int j : columns) add(i, j, Block::NullaryExpr([&] { return uniform(random); }) + (i == j ? shift : 0) * Block::Identity());
			rowStart.push_back(int(column.size()));
		}
	}

	void add(int i, int j, const Block& block)
	{
		column.push_back(j);
		blocks.push_back(block);
		dense.block<D, D>(D * i, D * j) += block;
	}

	void put(BlockSystem<D>& system) const
	{
		system.layOut(rowStart, column);
		for (std::size_t k = 0; k < blocks.size(); ++k) system.add(k, blocks[k]);
	}
};

// Returns the sign.
template <int D> double expectSolution(int count, double filled, double shift, unsigned seed)
{
	const Case<D> given(count, filled, shift, seed);
	BlockSystem<D> system;
	given.put(system);
	EXPECT_TRUE(system.factorise());
	const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(D * count, -1, 2), b = given.dense * x;
	// Backward stable up to the growth that pivots of a hundredth of their column allow, for which there is a factor of 450 over round-off.
	const Eigen::VectorXd singular = given.dense.bdcSvd().singularValues();
	EXPECT_LE((system.solve(b) - x).norm(), 1e-13 * singular[0] / singular[D * count - 1] * x.norm()) << count << ' ' << seed;
	EXPECT_EQ(system.signOfDeterminant(), given.dense.fullPivLu().determinant() < 0 ? -1 : 1) << count << ' ' << seed;
	return system.signOfDeterminant();
}

} // namespace

TEST(BlockSystem, SolvesAndTellsTheSignOfTheDeterminant)
{
	double small = 0, sparse = 0, flat = 0, full = 0;
	for (unsigned seed = 1; seed <= 20; ++seed) {
		small += expectSolution<2>(7, 0.4, 0, seed);
		sparse += expectSolution<3>(60, 0.05, 0, seed);
		flat += expectSolution<2>(80, 0.04, 0, seed);
		full += expectSolution<3>(40, 1, 0, seed);
		expectSolution<3>(60, 0.05, 4, seed);
	}
	for (const double sum : {small, sparse, flat, full}) EXPECT_LT(std::abs(sum), 20) << "both signs must occur";
}

TEST(BlockSystem, FactorisesAfterAMatrixThatHasNoFactors)
{
	const Case<3> given(60, 0.05, 4, 2);
	BlockSystem<3> system;
	system.layOut(given.rowStart, given.column);
	EXPECT_EQ(system.operations(), 0);
	EXPECT_FALSE(system.factorise()) << "all zero";
	EXPECT_EQ(system.operations(), 0);
	for (std::size_t k = 0; k < given.blocks.size(); ++k) system.add(k, given.blocks[k]);
	ASSERT_TRUE(system.factorise());
	EXPECT_GT(system.operations(), 0);
	const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(180, -1, 2);
	const Eigen::VectorXd singular = given.dense.bdcSvd().singularValues();
	EXPECT_LE((system.solve(given.dense * x) - x).norm(), 1e-13 * singular[0] / singular[179] * x.norm());
}

TEST(BlockSystem, AddsToTheDiagonalAndStartsAnewFromZero)
{
	const Case<3> given(50, 0.1, 4, 3);
	BlockSystem<3> system;
	given.put(system);
	system.setZero();
	for (std::size_t i = 0; i < 50; ++i) system.addToDiagonal(i, 2 * Eigen::Matrix3d::Identity());
	ASSERT_TRUE(system.factorise());
	const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(150, 1, 9);
	EXPECT_EQ(system.solve(b), 0.5 * b);
	system.addToDiagonal(7, -2 * Eigen::Matrix3d::Identity());
	EXPECT_FALSE(system.factorise());
}

// A hub that touches all others, numbered first: eliminated last it fills nothing in. Eliminated early (the permutation taken for its inverse) it
// fills the whole matrix.
TEST(BlockSystem, EliminatesWithLittleFill)
{
	constexpr int count = 100;
	std::vector<std::int32_t> rowStart{0}, column;
	for (int i = 0; i < count; ++i) {
		column.push_back(i);
		if (i > 0) column.push_back(0);
		for (int j = 1; i == 0 && j < count; ++j) column.push_back(j);
		rowStart.push_back(int(column.size()));
	}
	BlockSystem<3> system;
	system.layOut(rowStart, column);
	for (std::size_t k = 0; k < column.size(); ++k) system.add(k, Eigen::Matrix3d::Constant(0.01));
	for (int i = 0; i < count; ++i) system.addToDiagonal(i, 4 * Eigen::Matrix3d::Identity());
	ASSERT_TRUE(system.factorise());
	// Each factor holds a triangle of every diagonal block and one full block a row; operations() is twice their product over the unknowns.
	// Half more for the zeros that supernodes store.
	const double factor = 6.0 * count + 9.0 * (count - 1);
	EXPECT_LE(system.operations(), 1.5 * 2 * factor * factor / (3 * count)) << "a full factor has " << 4.5 * count * count << " numbers";
}
