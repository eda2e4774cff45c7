// SPDX-License-Identifier: GPL-2.0-or-later
// Kernels that exist for wide and for plain instructions: the same bits from both, and nothing that is not finite gets lost in a mask.
#include "pkg/solver/BallPack.hpp"
#include "pkg/solver/BlockRows.hpp"

#include <gtest/gtest.h>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

using namespace contactdynamics;

namespace {

template <class T> bool sameBytes(const std::vector<T>& a, const std::vector<T>& b)
{
	return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

template <class T> bool sameBytes(const T& a, const T& b) { return sameBytes(std::vector<T>{a}, std::vector<T>{b}); }

/// Ten packs; of each the last lane lies against a body that cannot move, and in every second one lane is empty. Impulses inside, on and outside of
/// their cones, some of them zero; likewise torques and their limits.
struct Balls {
	std::vector<BodyState> bodies = std::vector<BodyState>(81);
	std::vector<BallPack> packs = std::vector<BallPack>(10);
	std::vector<RollingPack> rolling = std::vector<RollingPack>(10);
	FieldPass field{};

	explicit Balls(unsigned seed)
	{
		std::mt19937_64 random(seed);
		std::normal_distribution<double> normal;
		std::memset(static_cast<void*>(packs.data()), 0, packs.size() * sizeof(BallPack)); // padding, too
		for (double& L : field.gradient) L = normal(random);
		for (std::size_t i = 0; i < 80; ++i)
			bodies[i] = {{normal(random), normal(random), normal(random)},
						 std::abs(normal(random)),
						 {normal(random), normal(random), normal(random)},
						 std::abs(normal(random))};
		for (std::size_t i = 0; i < packs.size(); ++i)
			for (int lane = 0; lane < 4; ++lane) {
				BallPack& p = packs[i];
				const bool empty = i % 2 && lane == 1;
				p.id[lane] = empty ? -1 : int(4 * i) + lane;
				p.body1[lane] = empty ? ~80 : int(8 * i) + 2 * lane;
				p.body2[lane] = empty ? ~80 : lane == 3 ? ~(p.body1[lane] + 1) : p.body1[lane] + 1;
				if (empty) continue;
				double n[3], length = 0;
				for (double& x : n) x = normal(random), length += x * x;
				for (int k = 0; k < 3; ++k) {
					p.normal[k][lane] = n[k] / std::sqrt(length);
					p.impulse[k][lane] = lane == 2 && i % 3 ? 0 : n[k] + 0.3 * normal(random);
					p.increment[k][lane] = normal(random);
					p.direction[k][lane] = normal(random);
				}
				p.gapVelocity[lane] = normal(random);
				p.friction[lane] = i % 4 ? std::abs(normal(random)) : 0;
				p.arm1[lane] = 1, p.arm2[lane] = -0.5;
				p.inverseWn[lane] = p.inverseWt[lane] = 0.3;
				RollingPack& roll = rolling[i];
				if ((4 * i + lane) % 5 == 0) continue; // without
				roll.rollingArm[lane] = std::abs(normal(random));
				roll.twistingArm[lane] = lane % 2 ? 0 : std::abs(normal(random));
				roll.mobility[lane] = 3;
				roll.inverseMobility[lane] = 0.3;
				for (int k = 0; k < 3; ++k) {
					roll.drive[k][lane] = i % 3 ? 0 : normal(random);
					roll.torque[k][lane] = normal(random);
					roll.increment[k][lane] = normal(random);
					roll.direction[k][lane] = normal(random);
				}
			}
	}
};

constexpr RoundOff roundOff{16 * std::numeric_limits<double>::epsilon(), 1e-10};

CertificateSums certified(const Balls& balls, bool rolls = false)
{
	return ballCertifyBaseline(balls.bodies.data(), balls.packs.data(), rolls ? balls.rolling.data() : nullptr, balls.packs.size(), roundOff,
							   nullptr);
}

struct Kind {
	bool withField, rolls;
	FieldPass* field(Balls& balls) const { return withField ? &balls.field : nullptr; }
	RollingPack* rolling(Balls& balls) const { return rolls ? balls.rolling.data() : nullptr; }
};
constexpr Kind kinds[] = {{false, false}, {true, false}, {false, true}, {true, true}};

/// Rows of W with 0 to 8 blocks beside the diagonal.
template <int D> void expectSameProducts(BlockProduct plain, BlockProduct wide)
{
	std::mt19937_64 random(4);
	std::normal_distribution<double> normal;
	constexpr int contacts = 40;
	std::vector<std::int32_t> rowStart{0}, column;
	for (int i = 0; i < contacts; ++i) {
		column.push_back(i);
		for (int k = i % 9; k > 0; --k) column.push_back(int(random() % contacts));
		rowStart.push_back(int(column.size()));
	}
	std::vector<double> blocks(D * D * column.size()), q(D * contacts);
	for (std::vector<double>* numbers : {&blocks, &q})
		for (double& x : *numbers) x = normal(random);
	std::vector<ImpulseLanes> r(contacts);
	for (ImpulseLanes& one : r)
		for (int lane = 0; lane < (D == 2 ? 4 : 3); ++lane) one.lane[lane] = lane < D ? normal(random) : one.lane[lane - 2];
	const double before[]{normal(random), normal(random), normal(random)};
	const BlockRows rows{rowStart.data(), column.data(), blocks.data(), q.data()};
	for (const int from : {0, 1, 17})
		for (const double* stored : {static_cast<const double*>(nullptr), before}) {
			if (from == 0 && stored) continue;
			std::vector<ImpulseLanes> one = r, two = r;
			std::vector<double> u(D * contacts, 0), v = u;
			plain(rows, one.data(), from, contacts, u.data(), stored);
			wide(rows, two.data(), from, contacts, v.data(), stored);
			EXPECT_TRUE(sameBytes(one, two) && sameBytes(u, v)) << D << ' ' << from;
			// And it is W r + q, to the round-off of a dozen sums.
			for (int i = from; i < contacts; ++i)
				for (int k = 0; k < D; ++k) {
					double sum = q[D * i + k], size = std::abs(sum);
					for (int b = rowStart[i]; b < rowStart[i + 1]; ++b)
						for (int j = 0; j < D; ++j) {
							const double term = blocks[D * D * b + D * k + j] * one[column[b]].lane[j];
							sum += term;
							size += std::abs(term);
						}
					EXPECT_NEAR(u[D * (i - from) + k], sum, 32 * std::numeric_limits<double>::epsilon() * size);
				}
		}
}

} // namespace

TEST(WideKernels, BallSweepHasTheBitsOfThePlainOne)
{
	for (const Kind& kind : kinds) {
		Balls one(9), two = one;
		const auto sweep = [&](BallSweep kernel, Balls& of) {
			return kernel(of.bodies.data(), of.packs.data(), kind.rolling(of), of.packs.size(), {0.4, 0.2}, kind.field(of));
		};
		const SweepNorms plain = sweep(ballSweepBaseline, one), wide = sweep(selectBallSweep(), two);
		EXPECT_TRUE(sameBytes(plain, wide));
		EXPECT_TRUE(sameBytes(one.field, two.field));
		EXPECT_TRUE(sameBytes(one.bodies, two.bodies) && sameBytes(one.packs, two.packs) && sameBytes(one.rolling, two.rolling));
	}
}

TEST(WideKernels, BallCertificateHasTheBitsOfThePlainOne)
{
	for (const Kind& kind : kinds) {
		Balls one(10), two = one;
		const auto rebuild = [&](BallRebuild kernel, Balls& of) {
			kernel(of.bodies.data(), of.packs.data(), kind.rolling(of), of.packs.size(), kind.field(of));
		};
		rebuild(ballRebuildBaseline, one);
		rebuild(selectBallRebuild(), two);
		EXPECT_TRUE(sameBytes(one.field, two.field));
		EXPECT_TRUE(sameBytes(one.bodies, two.bodies));
		const auto certify = [&](BallCertify kernel) {
			const double* gradient = kind.withField ? one.field.gradient : nullptr;
			return kernel(one.bodies.data(), one.packs.data(), kind.rolling(one), one.packs.size(), roundOff, gradient);
		};
		const CertificateSums plain = certify(ballCertifyBaseline), wide = certify(selectBallCertify());
		EXPECT_TRUE(sameBytes(plain, wide));
		EXPECT_GT(plain.map2, 0);
	}
}

TEST(WideKernels, BodyAdvanceHasTheBitsOfThePlainOne)
{
	Balls one(11), start(12), direction(13), two = one, sameStart = start, sameDirection = direction;
	bodyAdvanceBaseline(one.bodies.data(), start.bodies.data(), direction.bodies.data(), one.bodies.size(), {0.4, 0.2});
	selectBodyAdvance()(two.bodies.data(), sameStart.bodies.data(), sameDirection.bodies.data(), two.bodies.size(), {0.4, 0.2});
	EXPECT_TRUE(sameBytes(one.bodies, two.bodies) && sameBytes(start.bodies, sameStart.bodies) && sameBytes(direction.bodies, sameDirection.bodies));
}

TEST(WideKernels, BlockProductsHaveTheBitsOfThePlainOnes)
{
	expectSameProducts<2>(blockProduct2Baseline, selectBlockProduct<2>());
	expectSameProducts<3>(blockProduct3Baseline, selectBlockProduct<3>());
}

TEST(WideKernels, WhatIsNotFiniteNeverPassesAsSmall)
{
	ASSERT_TRUE(std::isfinite(certified(Balls(14)).map2) && std::isfinite(certified(Balls(14), true).map2));
	for (const double poison : {std::nan(""), std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()})
		for (int k = 0; k < 3; ++k) {
			for (std::size_t i = 0; i < 80; ++i) { // all are in some contact but those of the empty lanes
				if (i / 8 % 2 && i % 8 / 2 == 1) continue;
				for (double(BodyState::*part)[3] : {&BodyState::velocity, &BodyState::angularVelocity}) {
					Balls balls(14);
					(balls.bodies[i].*part)[k] = poison;
					EXPECT_FALSE(std::isfinite(certified(balls).map2)) << poison << ", body " << i;
				}
			}
			for (int i = 0; i < 40; ++i) {
				Balls balls(14);
				balls.packs[i / 4].impulse[k][i % 4] = poison;
				EXPECT_FALSE(std::isfinite(certified(balls).map2)) << poison << ", contact " << i;
				balls = Balls(14);
				balls.rolling[i / 4].torque[k][i % 4] = poison;
				EXPECT_FALSE(std::isfinite(certified(balls, true).map2)) << poison << ", torque " << i;
			}
		}
}
