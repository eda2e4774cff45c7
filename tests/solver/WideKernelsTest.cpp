// SPDX-License-Identifier: GPL-2.0-or-later
// Kernels that exist for wide and for plain instructions: the same bits from both, and nothing that is not finite gets lost in a mask.
#include "pkg/solver/BlockRows.hpp"
#include "pkg/solver/ContactKernels.hpp"
#include "pkg/solver/LocalDelassus.hpp"
#include "pkg/solver/OneContact.hpp"

#include <Eigen/Geometry>
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
	return contactKernelsBaseline.certify(balls.bodies.data(), balls.packs.data(), rolls ? balls.rolling.data() : nullptr, balls.packs.size(),
										  roundOff, nullptr);
}

struct Kind {
	bool withField, rolls;
	FieldPass* field(Balls& balls) const { return withField ? &balls.field : nullptr; }
	RollingPack* rolling(Balls& balls) const { return rolls ? balls.rolling.data() : nullptr; }
};
constexpr Kind kinds[] = {{false, false}, {true, false}, {false, true}, {true, true}};

/// General contacts of bodies with any inertia in packs like those of Balls; in two packs all move in the plane x, y. Random velocities, so that some
/// open, some stick, and some slide, with a guess of the rate and without.
struct Generals {
	Balls balls;
	std::vector<Body> given = std::vector<Body>(bodyCount + 1);
	std::vector<BodyMobility> mobilities = std::vector<BodyMobility>(bodyCount + 1);
	std::vector<GeneralPack> packs = std::vector<GeneralPack>(packCount);

	explicit Generals(unsigned seed) : balls(seed)
	{
		std::mt19937_64 random(seed);
		std::normal_distribution<double> normal;
		const auto vector = [&] { return Vector3(normal(random), normal(random), normal(random)); };
		std::memset(static_cast<void*>(packs.data()), 0, packs.size() * sizeof(GeneralPack)); // padding, too
		for (std::size_t i = 0; i < bodyCount; ++i) {
			const Matrix3 root = Matrix3::NullaryExpr([&] { return normal(random); });
			given[i] = {Vector3::Zero(), Vector3::Zero(), vector().cwiseAbs(), root * root.transpose()};
			if (isPlane(i / (2 * packLanes))) {
				given[i].inverseMass[2] = 0;
				given[i].inverseInertia.setZero();
				given[i].inverseInertia(2, 2) = 1;
				balls.bodies[i].velocity[2] = balls.bodies[i].angularVelocity[0] = balls.bodies[i].angularVelocity[1] = 0;
			}
			const Matrix3& inertia = given[i].inverseInertia;
			balls.bodies[i].inverseMass = given[i].inverseMass[0];
			balls.bodies[i].inverseInertia = inertia(0, 0);
			mobilities[i] = {given[i].inverseMass[1], given[i].inverseMass[2], {inertia(0, 0), inertia(1, 1), inertia(2, 2)},
							 inertia(1, 2),			  inertia(2, 0),		   inertia(0, 1)};
		}
		for (std::size_t i = 0; i < packs.size(); ++i)
			for (int lane = 0; lane < packLanes; ++lane) {
				GeneralPack& p = packs[i];
				p.id[lane] = balls.packs[i].id[lane];
				p.body1[lane] = balls.packs[i].body1[lane];
				p.body2[lane] = balls.packs[i].body2[lane];
				if (p.id[lane] < 0) continue;
				Contact c;
				c.normal = vector();
				c.arm1 = vector();
				c.arm2 = vector();
				if (isPlane(i)) c.normal[2] = c.arm1[2] = c.arm2[2] = 0;
				c.normal.normalize();
				const Vector3 compliance = lane == 3 ? Vector3(0.2, 0.1, 0.1) : Vector3(Vector3::Zero());
				Matrix3 frame = contactFrame(c.normal), W = localDelassus(body(p.body1[lane]), body(p.body2[lane]), c, frame);
				W.diagonal() += compliance;
				const OneContact one(W);
				frame = one.principalFrame(frame);
				for (int k = 0; k < 3; ++k) {
					p.normal[k][lane] = frame(0, k);
					p.tangent[k][lane] = frame(1, k);
					p.arm1[k][lane] = c.arm1[k];
					p.arm2[k][lane] = c.arm2[k];
					p.offset[k][lane] = isPlane(i) && k == 2 ? 0 : normal(random);
					p.impulse[k][lane] = lane == 2 && i % 3 ? 0 : normal(random);
					p.increment[k][lane] = normal(random);
					p.direction[k][lane] = normal(random);
				}
				p.normalCompliance[lane] = compliance[0];
				p.tangentialCompliance[lane] = compliance[1];
				p.Wnn[lane] = one.principal().Wnn;
				p.wLarge[lane] = one.principal().wLarge;
				p.wSmall[lane] = one.principal().wSmall;
				p.largeEigen[lane] = one.principal().largeEigen;
				p.smallEigen[lane] = one.principal().smallEigen;
				p.roundOff[lane] = one.principal().roundOff;
				p.friction[lane] = i % 4 ? 2 * std::abs(normal(random)) : 0;
				p.slidingRate[lane] = lane % 2 ? std::abs(normal(random)) : 0;
			}
	}

	static bool isPlane(std::size_t pack) { return pack % 5 == 3; }
	/// One that cannot move has no mobilities in W.
	Body body(std::int32_t index) const
	{
		return index < 0 ? Body{Vector3::Zero(), Vector3::Zero(), Vector3::Zero(), Matrix3::Zero()} : given[index];
	}

	SweepNorms sweep(const ContactKernels& kernels, const Kind& kind, Extrapolation by = {0.4, 0.2})
	{
		return kernels.sweepGeneral(balls.bodies.data(), mobilities.data(), packs.data(), kind.rolling(balls), packs.size(), by, kind.field(balls));
	}
	void rebuild(const ContactKernels& kernels, const Kind& kind)
	{
		kernels.rebuildGeneral(balls.bodies.data(), mobilities.data(), packs.data(), kind.rolling(balls), packs.size(), kind.field(balls));
	}
	CertificateSums certified(const ContactKernels& kernels, const Kind& kind)
	{
		return kernels.certifyGeneral(balls.bodies.data(), mobilities.data(), packs.data(), kind.rolling(balls), packs.size(), roundOff,
									  kind.withField ? balls.field.gradient : nullptr);
	}
	/// What the velocity below is made of: sum of sizes.
	double speedsOf(const GeneralPack& p, int lane) const
	{
		double sum = 0;
		const auto add = [&](std::int32_t index, const double(&arm)[3][packLanes]) {
			const BodyState& b = balls.bodies[index < 0 ? ~index : index];
			double turning = 0, reach = 0;
			for (int k = 0; k < 3; ++k) {
				sum += std::abs(b.velocity[k]) + 0.5 * std::abs(p.offset[k][lane]);
				turning += std::abs(b.angularVelocity[k]);
				reach += std::abs(arm[k][lane]);
			}
			sum += turning * reach;
		};
		add(p.body1[lane], p.arm1);
		add(p.body2[lane], p.arm2);
		return sum;
	}
	/// Velocity of body 2 relative to body 1 at the contact, along the rows of its frame, with what is added to it.
	Vector3 velocityOf(const GeneralPack& p, int lane) const
	{
		const auto column = [lane](const double(&of)[3][packLanes]) { return Vector3(of[0][lane], of[1][lane], of[2][lane]); };
		const auto at = [&](std::int32_t index, const Vector3& arm) -> Vector3 {
			const BodyState& b = balls.bodies[index < 0 ? ~index : index];
			const Vector3 v(b.velocity[0], b.velocity[1], b.velocity[2]), w(b.angularVelocity[0], b.angularVelocity[1], b.angularVelocity[2]);
			return v + w.cross(arm);
		};
		const Vector3 n = column(p.normal), t = column(p.tangent);
		Matrix3 frame;
		frame << n.transpose(), t.transpose(), n.cross(t).transpose();
		const Vector3 compliance(p.normalCompliance[lane], p.tangentialCompliance[lane], p.tangentialCompliance[lane]);
		return frame * (at(p.body2[lane], column(p.arm2)) - at(p.body1[lane], column(p.arm1))) + column(p.offset) +
			   compliance.cwiseProduct(column(p.impulse));
	}
};

/// Calls check(kernels) for all versions but the plainest that this machine can run.
template <class Check> void forWiderKernels(const Check& check)
{
	for (int version = 1; version < contactKernelVersions; ++version) {
		SCOPED_TRACE("version " + std::to_string(version));
		if (const ContactKernels* kernels = contactKernels(version)) check(*kernels);
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
	forWiderKernels([](const ContactKernels& kernels) {
		for (const Kind& kind : kinds) {
			Balls one(9), two = one;
			const auto sweep = [&](BallSweep kernel, Balls& of) {
				return kernel(of.bodies.data(), of.packs.data(), kind.rolling(of), of.packs.size(), {0.4, 0.2}, kind.field(of));
			};
			const SweepNorms plain = sweep(contactKernelsBaseline.sweep, one), wide = sweep(kernels.sweep, two);
			EXPECT_TRUE(sameBytes(plain, wide));
			EXPECT_GT(plain.increment2, 0);
			EXPECT_TRUE(sameBytes(one.field, two.field));
			EXPECT_TRUE(sameBytes(one.bodies, two.bodies) && sameBytes(one.packs, two.packs) && sameBytes(one.rolling, two.rolling));
		}
	});
}

TEST(WideKernels, BallCertificateHasTheBitsOfThePlainOne)
{
	forWiderKernels([](const ContactKernels& kernels) {
		for (const Kind& kind : kinds) {
			Balls one(10), two = one;
			const auto rebuild = [&](BallRebuild kernel, Balls& of) {
				kernel(of.bodies.data(), of.packs.data(), kind.rolling(of), of.packs.size(), kind.field(of));
			};
			rebuild(contactKernelsBaseline.rebuild, one);
			rebuild(kernels.rebuild, two);
			EXPECT_TRUE(sameBytes(one.field, two.field));
			EXPECT_TRUE(sameBytes(one.bodies, two.bodies));
			const auto certify = [&](BallCertify kernel) {
				const double* gradient = kind.withField ? one.field.gradient : nullptr;
				return kernel(one.bodies.data(), one.packs.data(), kind.rolling(one), one.packs.size(), roundOff, gradient);
			};
			const CertificateSums plain = certify(contactKernelsBaseline.certify), wide = certify(kernels.certify);
			EXPECT_TRUE(sameBytes(plain, wide));
			EXPECT_GT(plain.map2, 0);
		}
	});
}

TEST(WideKernels, GeneralContactsHaveTheBitsOfThePlainOnes)
{
	forWiderKernels([](const ContactKernels& kernels) {
		for (const Kind& kind : kinds) {
			Generals one(9), two = one;
			const SweepNorms plain = one.sweep(contactKernelsBaseline, kind), wide = two.sweep(kernels, kind);
			EXPECT_TRUE(sameBytes(plain, wide));
			EXPECT_GT(plain.increment2, 0);
			one.rebuild(contactKernelsBaseline, kind);
			two.rebuild(kernels, kind);
			EXPECT_TRUE(sameBytes(one.balls.field, two.balls.field) && sameBytes(one.balls.rolling, two.balls.rolling));
			EXPECT_TRUE(sameBytes(one.balls.bodies, two.balls.bodies) && sameBytes(one.packs, two.packs));
			const CertificateSums sums = one.certified(contactKernelsBaseline, kind);
			EXPECT_TRUE(sameBytes(sums, two.certified(kernels, kind)));
			EXPECT_GT(sums.map2, 0);
		}
	});
}

// After its visit a contact obeys Signorini's condition and Coulomb's law.
//
// Round-off: u is a sum of some ten products of speeds and arms, and the impulses are so good that W times them is round-off of W |r| and W |x|.
// Search: its last step was at most 1e-4 k, of Newton's method on 1/(mu r_n) - 1/|r_t|. At the root, q = |w| |r_t| / (W_nn r_n), the relative
// derivatives by log k are at most 1 and q of |r_t| and mu r_n, the second ones at most 2 and 2 q, those of the reciprocals at most 4 and 2 q + 2
// q^2. So |r_t| - mu r_n is left at 1e-8 (1 + q)^2 2 |r_t| at most, and u_n at W_nn / mu times that; u_t turns by w u_n / W_nn.
TEST(WideKernels, VisitOfAGeneralContactObeysTheLaw)
{
	int open = 0, stick = 0, slide = 0;
	for (unsigned seed = 0; seed < 100; ++seed) {
		Generals generals(seed);
		generals.sweep(contactKernelsBaseline, {});
		if (seed % 2) { // once more, not far from there: the rates found are good guesses
			for (BodyState& body : generals.balls.bodies)
				for (int k = 0; k < 2; ++k) body.velocity[k] *= 1.1;
			generals.sweep(contactKernelsBaseline, {}, {});
		}
		for (const GeneralPack& p : generals.packs)
			for (int lane = 0; lane < packLanes; ++lane) {
				if (p.id[lane] < 0) continue;
				const Vector3 u = generals.velocityOf(p, lane);
				const double rn = p.impulse[0][lane], rt = std::hypot(p.impulse[1][lane], p.impulse[2][lane]), limit = p.friction[lane] * rn;
				const double Wnn = p.Wnn[lane], w = std::hypot(p.wLarge[lane], p.wSmall[lane]);
				const Vector3 r(rn, p.impulse[1][lane], p.impulse[2][lane]), dr(p.increment[0][lane], p.increment[1][lane], p.increment[2][lane]);
				const double trace = Wnn + w * w / Wnn + p.largeEigen[lane] + p.smallEigen[lane];
				const double round =
						64 * std::numeric_limits<double>::epsilon() * (generals.speedsOf(p, lane) + trace * (r.norm() + (r - dr).norm()));
				const double q = rn > 0 ? w * rt / (Wnn * rn) : 0, ofSearch = 2e-8 * (1 + q) * (1 + q) * Wnn * rn;
				if (rn == 0) {
					++open;
					EXPECT_GE(u[0], -round);
					EXPECT_EQ(rt, 0);
					continue;
				}
				EXPECT_GT(rn, 0);
				EXPECT_NEAR(u[0], 0, round + ofSearch);
				if (rt < limit * (1 - 1e-9)) {
					++stick;
					EXPECT_NEAR(u.tail<2>().norm(), 0, round);
					continue;
				}
				++slide;
				EXPECT_NEAR(rt, limit, 8 * std::numeric_limits<double>::epsilon() * limit);
				// Against the impulse: u_t = -k r_t.
				EXPECT_NEAR(u[1] * r[1] + u[2] * r[2], -u.tail<2>().norm() * rt, 2 * (round + w / Wnn * (round + ofSearch)) * rt);
			}
	}
	EXPECT_GT(open, 100);
	EXPECT_GT(stick, 100);
	EXPECT_GT(slide, 100);
}

TEST(WideKernels, BodyAdvanceHasTheBitsOfThePlainOne)
{
	forWiderKernels([](const ContactKernels& kernels) {
		Balls one(11), start(12), direction(13), two = one, sameStart = start, sameDirection = direction;
		const auto advance = [](BodyAdvance kernel, Balls& now, Balls& before, Balls& along) {
			kernel(now.bodies.data(), before.bodies.data(), along.bodies.data(), now.bodies.size(), {0.4, 0.2});
		};
		advance(contactKernelsBaseline.advance, one, start, direction);
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

TEST(WideKernels, WhatIsNotFiniteNeverPassesAsSmallAmongGeneralContacts)
{
	constexpr Kind plain{}, rolls{false, true};
	const ContactKernels& kernels = widestContactKernels();
	ASSERT_TRUE(std::isfinite(Generals(14).certified(kernels, plain).map2) && std::isfinite(Generals(14).certified(kernels, rolls).map2));
	for (const double poison : {std::nan(""), std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()})
		for (int k = 0; k < 3; ++k)
			for (int pack = 0; pack < packCount; ++pack)
				for (int lane = 0; lane < packLanes; ++lane) {
					if (isEmptyLane(std::size_t(pack), lane)) continue;
					for (double(BodyState::*part)[3] : {&BodyState::velocity, &BodyState::angularVelocity})
						for (int side = 0; side < 2; ++side) {
							Generals generals(14);
							(generals.balls.bodies[2 * (packLanes * pack + lane) + side].*part)[k] = poison;
							EXPECT_FALSE(std::isfinite(generals.certified(kernels, plain).map2)) << poison << ", side " << side << " of " << lane;
						}
					Generals generals(14);
					generals.packs[pack].impulse[k][lane] = poison;
					EXPECT_FALSE(std::isfinite(generals.certified(kernels, plain).map2)) << poison << ", contact " << lane << " of pack " << pack;
					generals = Generals(14);
					generals.balls.rolling[pack].torque[k][lane] = poison;
					EXPECT_FALSE(std::isfinite(generals.certified(kernels, rolls).map2)) << poison << ", torque " << lane << " of pack " << pack;
				}
}
