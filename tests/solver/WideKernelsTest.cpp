// SPDX-License-Identifier: GPL-2.0-or-later
// Kernels that exist for wide and for plain instructions: the same bits from both, and nothing that is not finite gets lost in a mask.
#include "pkg/solver/BallKernels.hpp"
#include "pkg/solver/BlockRows.hpp"

#include <gtest/gtest.h>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

using namespace contactdynamics;

namespace {

template <class T> bool sameBytes(const std::vector<T>& a, const std::vector<T>& b)
{
	return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

template <class T> bool sameBytes(const T& a, const T& b) { return sameBytes(std::vector<T>{a}, std::vector<T>{b}); }

constexpr int packCount = 10, bodyCount = 2 * packLanes * packCount;

/// Lanes are filled in order: all, five, half, one.
bool isEmptyLane(std::size_t pack, int lane)
{
	constexpr int filled[]{packLanes, packLanes / 2 + 1, packLanes / 2, 1};
	return lane >= filled[pack % 4];
}

/// Packs; of each the first and the fourth lane lie against a body that cannot move. Impulses inside, on and outside of their cones, some of them
/// zero; likewise torques and their limits.
struct Balls {
	std::vector<BodyState> bodies = std::vector<BodyState>(bodyCount + 1);
	std::vector<BallPack> packs = std::vector<BallPack>(packCount);
	std::vector<RollingPack> rolling = std::vector<RollingPack>(packCount);
	FieldPass field{};

	explicit Balls(unsigned seed)
	{
		std::mt19937_64 random(seed);
		std::normal_distribution<double> normal;
		std::memset(static_cast<void*>(packs.data()), 0, packs.size() * sizeof(BallPack)); // padding, too
		for (double& L : field.gradient) L = normal(random);
		for (std::size_t i = 0; i < bodyCount; ++i)
			bodies[i] = {{normal(random), normal(random), normal(random)},
						 std::abs(normal(random)),
						 {normal(random), normal(random), normal(random)},
						 std::abs(normal(random))};
		for (std::size_t i = 0; i < packs.size(); ++i)
			for (int lane = 0; lane < packLanes; ++lane) {
				BallPack& p = packs[i];
				const bool empty = isEmptyLane(i, lane);
				p.id[lane] = empty ? -1 : packLanes * int(i) + lane;
				p.body1[lane] = empty ? ~bodyCount : 2 * (packLanes * int(i) + lane);
				p.body2[lane] = empty ? ~bodyCount : lane % 3 == 0 ? ~(p.body1[lane] + 1) : p.body1[lane] + 1;
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
				if ((packLanes * i + std::size_t(lane)) % 5 == 0) continue; // without
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
	return ballKernelsBaseline.certify(balls.bodies.data(), balls.packs.data(), rolls ? balls.rolling.data() : nullptr, balls.packs.size(), roundOff,
									   nullptr);
}

struct Kind {
	bool withField, rolls;
	FieldPass* field(Balls& balls) const { return withField ? &balls.field : nullptr; }
	RollingPack* rolling(Balls& balls) const { return rolls ? balls.rolling.data() : nullptr; }
};
constexpr Kind kinds[] = {{false, false}, {true, false}, {false, true}, {true, true}};

/// Calls check(kernels) for all versions but the plainest that this machine can run.
template <class Check> void forWiderKernels(const Check& check)
{
	for (int version = 1; version < ballKernelVersions; ++version) {
		SCOPED_TRACE("version " + std::to_string(version));
		if (const BallKernels* kernels = ballKernels(version)) check(*kernels);
	}
}

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
	forWiderKernels([](const BallKernels& kernels) {
		for (const Kind& kind : kinds) {
			Balls one(9), two = one;
			const auto sweep = [&](BallSweep kernel, Balls& of) {
				return kernel(of.bodies.data(), of.packs.data(), kind.rolling(of), of.packs.size(), {0.4, 0.2}, kind.field(of));
			};
			const SweepNorms plain = sweep(ballKernelsBaseline.sweep, one), wide = sweep(kernels.sweep, two);
			EXPECT_TRUE(sameBytes(plain, wide));
			EXPECT_GT(plain.increment2, 0);
			EXPECT_TRUE(sameBytes(one.field, two.field));
			EXPECT_TRUE(sameBytes(one.bodies, two.bodies) && sameBytes(one.packs, two.packs) && sameBytes(one.rolling, two.rolling));
		}
	});
}

TEST(WideKernels, BallCertificateHasTheBitsOfThePlainOne)
{
	forWiderKernels([](const BallKernels& kernels) {
		for (const Kind& kind : kinds) {
			Balls one(10), two = one;
			const auto rebuild = [&](BallRebuild kernel, Balls& of) {
				kernel(of.bodies.data(), of.packs.data(), kind.rolling(of), of.packs.size(), kind.field(of));
			};
			rebuild(ballKernelsBaseline.rebuild, one);
			rebuild(kernels.rebuild, two);
			EXPECT_TRUE(sameBytes(one.field, two.field));
			EXPECT_TRUE(sameBytes(one.bodies, two.bodies));
			const auto certify = [&](BallCertify kernel) {
				const double* gradient = kind.withField ? one.field.gradient : nullptr;
				return kernel(one.bodies.data(), one.packs.data(), kind.rolling(one), one.packs.size(), roundOff, gradient);
			};
			const CertificateSums plain = certify(ballKernelsBaseline.certify), wide = certify(kernels.certify);
			EXPECT_TRUE(sameBytes(plain, wide));
			EXPECT_GT(plain.map2, 0);
		}
	});
}

TEST(WideKernels, BodyAdvanceHasTheBitsOfThePlainOne)
{
	forWiderKernels([](const BallKernels& kernels) {
		Balls one(11), start(12), direction(13), two = one, sameStart = start, sameDirection = direction;
		const auto advance = [](BodyAdvance kernel, Balls& now, Balls& before, Balls& along) {
			kernel(now.bodies.data(), before.bodies.data(), along.bodies.data(), now.bodies.size(), {0.4, 0.2});
		};
		advance(ballKernelsBaseline.advance, one, start, direction);
		advance(kernels.advance, two, sameStart, sameDirection);
		EXPECT_TRUE(sameBytes(one.bodies, two.bodies) && sameBytes(start.bodies, sameStart.bodies));
		EXPECT_TRUE(sameBytes(direction.bodies, sameDirection.bodies));
	});
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
			for (std::size_t i = 0; i < bodyCount; ++i) { // those of some contact
				if (isEmptyLane(i / (2 * packLanes), int(i % (2 * packLanes)) / 2)) continue;
				for (double(BodyState::*part)[3] : {&BodyState::velocity, &BodyState::angularVelocity}) {
					Balls balls(14);
					(balls.bodies[i].*part)[k] = poison;
					EXPECT_FALSE(std::isfinite(certified(balls).map2)) << poison << ", body " << i;
				}
			}
			for (int pack = 0; pack < packCount; ++pack)
				for (int lane = 0; lane < packLanes; ++lane) {
					if (isEmptyLane(std::size_t(pack), lane)) continue;
					Balls balls(14);
					balls.packs[pack].impulse[k][lane] = poison;
					EXPECT_FALSE(std::isfinite(certified(balls).map2)) << poison << ", contact " << lane << " of pack " << pack;
					balls = Balls(14);
					balls.rolling[pack].torque[k][lane] = poison;
					EXPECT_FALSE(std::isfinite(certified(balls, true).map2)) << poison << ", torque " << lane << " of pack " << pack;
				}
		}
}
