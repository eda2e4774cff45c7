// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "BallPack.hpp"
#include "BlockProblem.hpp"
#include "CrushedContacts.hpp"
#include "NaturalMap.hpp"
#include "OneContact.hpp"
#include "OneContact2D.hpp"

#include <type_traits>

namespace contactdynamics {

/// An explicit W of D x D blocks as signoriniCoulombLoop() uses it. All contacts are awake: a visit is cheap beside its row of W.
template <int D> class BlockOperator {
public:
	using Vector = Eigen::Matrix<double, D, 1>;
	using Block = Eigen::Matrix<double, D, D>;
	using Tangent = Eigen::Matrix<double, D - 1, 1>;
	using Local = std::conditional_t<D == 2, OneContact2D, OneContact>;
	static constexpr int firstCheck = 5; ///< gauges the increments against a measure they need not resemble

	BlockOperator(BlockProblem& given, Measure measureOfResidual) : problem(given), measure(measureOfResidual)
	{
		const std::size_t count = problem.contacts();
		diagonal.resize(count);
		impulse.resize(count);
		increment.assign(count, Vector::Zero());
		direction.assign(count, Vector::Zero());
		for (std::size_t i = 0; i < count; ++i) {
			for (int k = problem.rowStart[i]; k < problem.rowStart[i + 1]; ++k)
				if (std::size_t(problem.column[k]) == i) diagonal[i] = block(k);
			// The visit works with the increments of u, so that a symmetric local operator leaves the solution of the whole as it is.
			diagonal[i] = 0.5 * (diagonal[i] + diagonal[i].transpose()).eval();
			impulse[i] = projected({problem.impulse[D * i], at(problem.impulse, i).template tail<D - 1>()}, problem.friction[i]);
		}
	}

	bool anyAwake() const { return !impulse.empty(); }
	bool mend() { return false; }

	SweepNorms sweep(Extrapolation by)
	{
		prepare();
		SweepNorms norms;
		for (std::size_t i = 0; i < impulse.size(); ++i) {
			const Vector ahead = by.relax * increment[i] + by.momentum * direction[i];
			direction[i] = increment[i] + ahead;
			impulse[i] += ahead;
		}
		for (std::size_t i = 0; i < impulse.size(); ++i) {
			const Vector r = local[i].solve(velocityAt(i) - diagonal[i] * impulse[i], problem.friction[i]);
			increment[i] = r - impulse[i];
			impulse[i] = r;
			norms.increment2 += increment[i].dot(diagonal[i] * increment[i]);
			norms.impulse2 += r.dot(diagonal[i] * r);
		}
		return norms;
	}

	double certificate() const
	{
		ResidualSum relative;
		double error2 = 0, q2 = 0, r2 = 0, u2 = 0;
		for (std::size_t i = 0; i < impulse.size(); ++i) {
			const Vector u = velocityAt(i), q = at(problem.q, i), &r = impulse[i];
			const double mu = problem.friction[i], Wnn = diagonal[i](0, 0);
			const Split<Tangent> rSplit{r[0], r.template tail<D - 1>()}, uSplit{u[0], u.template tail<D - 1>()};
			if (measure == Measure::siconos) {
				const auto F = naturalMap<Tangent>(rSplit, uSplit, mu, 1, 0);
				error2 += F.n * F.n + F.t.squaredNorm();
				q2 += q.squaredNorm();
				r2 += r.squaredNorm();
				u2 += u.squaredNorm();
			} else if (Wnn > 0) {
				const auto F = naturalMap<Tangent>(rSplit, uSplit, mu, Wnn, q.norm() + (u - q).norm());
				Vector f;
				f << F.n, F.t;
				relative.add(f.dot(diagonal[i] * f), r.dot(diagonal[i] * r));
			}
		}
		if (measure != Measure::siconos) return relative.value();
		const double scale = std::sqrt(std::max({q2, r2, u2}));
		return scale > 2.2e-16 ? std::sqrt(error2) / scale : std::sqrt(error2);
	}

	void finish(SolveReport& report)
	{
		if constexpr (D == 2) prepare();
		problem.velocity.resize(problem.q.size());
		for (std::size_t i = 0; i < impulse.size(); ++i) {
			const Vector u = velocityAt(i);
			Eigen::Map<Vector>(&problem.velocity[D * i]) = u;
			Eigen::Map<Vector>(&problem.impulse[D * i]) = impulse[i];
			report.maxApproachSpeed = std::max(report.maxApproachSpeed, -u[0]);
			report.activeContacts += impulse[i][0] > 0;
			if constexpr (D == 2) report.ambiguousContacts += !local[i].isUnique(problem.friction[i]);
		}
	}

	/// Contacts that impulses, however large, do not stop.
	CrushedContacts crushed(double tolerance) const
	{
		CrushedContacts contacts(tolerance);
		for (std::size_t i = 0; i < impulse.size(); ++i)
			if (problem.q[D * i] < 0) contacts.add(problem.q[D * i], velocityAt(i)[0], impulse[i][0], diagonal[i](0, 0));
		return contacts;
	}

	const std::vector<Vector>& impulses() const { return impulse; }

	/// Continues from these impulses, brought into their cones, without momentum.
	void setImpulses(const std::vector<Vector>& given)
	{
		for (std::size_t i = 0; i < impulse.size(); ++i) {
			impulse[i] = projected({given[i][0], given[i].template tail<D - 1>()}, problem.friction[i]);
			increment[i].setZero();
			direction[i].setZero();
		}
	}

	/// The same without a look at the cones: for trial points of a line search.
	void setRaw(const std::vector<Vector>& given) { impulse = given; }

	/// u = W r + q [m/s] at the present impulses.
	void velocities(std::vector<Vector>& u) const
	{
		u.resize(impulse.size());
		for (std::size_t i = 0; i < impulse.size(); ++i) u[i] = velocityAt(i);
	}

	/// Starts from the impulses as they are, also outside their cones: for residualOf().
	void takeImpulsesAsGiven()
	{
		for (std::size_t i = 0; i < impulse.size(); ++i) impulse[i] = at(problem.impulse, i);
	}

private:
	BlockProblem& problem;
	Measure measure;
	std::vector<Block> diagonal;
	std::vector<Local> local;
	std::vector<Vector> impulse, increment, direction; // as in BallPack

	/// The eigenvectors of the local operators, when the first visit needs them: a start that solves the problem does without.
	void prepare()
	{
		if (local.size() == diagonal.size()) return;
		local.clear();
		for (const Block& W : diagonal) local.emplace_back(W);
	}

	Block block(int k) const { return Eigen::Map<const Eigen::Matrix<double, D, D, Eigen::RowMajor>>(&problem.blocks[D * D * k]); }
	Eigen::Map<const Vector> at(const std::vector<double>& values, std::size_t i) const { return Eigen::Map<const Vector>(&values[D * i]); }

	static Vector projected(const Split<Tangent>& r, double mu)
	{
		const Split<Tangent> inside = projectOnCone(r, mu);
		Vector result;
		result << inside.n, inside.t;
		return result;
	}

	Vector velocityAt(std::size_t i) const
	{
		Vector u = at(problem.q, i);
		for (int k = problem.rowStart[i]; k < problem.rowStart[i + 1]; ++k) {
			const double* w = &problem.blocks[D * D * k];
			const Vector& r = impulse[problem.column[k]];
			// The products of a block are added up before they meet u: one addition a block in the chain that the processor waits for.
			for (int row = 0; row < D; ++row) {
				if constexpr (D == 2)
					u[row] += w[D * row] * r[0] + w[D * row + 1] * r[1];
				else
					u[row] += (w[D * row] * r[0] + w[D * row + 1] * r[1]) + w[D * row + 2] * r[2];
			}
		}
		return u;
	}
};

} // namespace contactdynamics
