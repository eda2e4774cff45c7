// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "BallPack.hpp"
#include "BlockProblem.hpp"
#include "BlockResidual.hpp"
#include "BlockRows.hpp"
#include "BlockSqueeze.hpp"
#include "ContactsApart.hpp"
#include "OneContact.hpp"
#include "OneContact2D.hpp"
#include "ProblemBlocks.hpp"

#include <algorithm>
#include <type_traits>

namespace contactdynamics {

/// An explicit W of D x D blocks as signoriniCoulombLoop() uses it. All contacts are awake, because a visit is cheap beside its row of W, but for
/// those on which no other one acts: one visit solves them.
template <int D> class BlockOperator {
public:
	using Vector = Eigen::Matrix<double, D, 1>;
	using Block = Eigen::Matrix<double, D, D>;
	using Tangent = Eigen::Matrix<double, D - 1, 1>;
	using Local = std::conditional_t<D == 2, OneContact2D, OneContact>;

	/// A certificate gauges the increments against a measure they need not resemble; early where that costs nothing.
	const int firstCheck;

	/// Starts from the impulses of the problem, brought into their cones.
	BlockOperator(BlockProblem& given, Measure measureOfResidual)
		: firstCheck(given.contacts() < 64 ? 1 : 5), problem(given), measure(measureOfResidual),
		  product(selectBlockProduct<D>()), rows{given.rowStart.data(), given.column.data(), given.blocks.data(), given.q.data()},
		  lanes(given.contacts())
	{
		start();
	}

	void start()
	{
		visitedAll = false;
		atZero = std::all_of(problem.impulse.begin(), problem.impulse.end(), [](double r) { return r == 0; });
		if (atZero)
			std::fill(lanes.begin(), lanes.end(), ImpulseLanes());
		else
			for (std::size_t i = 0; i < lanes.size(); ++i) put(i, projected(at(problem.impulse, i), problem.friction[i]));
	}

	static constexpr bool startsPlainly = false; ///< BlockSolver sees to that
	bool anyAwake() const { return !lanes.empty(); }
	bool mend() { return false; }

	SweepNorms sweep(Extrapolation by)
	{
		prepare();
		if (visitedAll && !sortedOut) {
			sortedOut = true;
			contacts.sortOut(problem);
			settleApart();
		}
		if (by.relax != 0 || by.momentum != 0) {
			for (std::size_t i = 0; i < lanes.size(); ++i) {
				const Vector ahead = by.relax * visited[i].increment + by.momentum * visited[i].direction;
				visited[i].direction = visited[i].increment + ahead;
				put(i, impulse(i) + ahead);
			}
		} else
			for (Visited& contact : visited) contact.direction = contact.increment;
		atZero = false;
		SweepNorms norms;
		if (knowsApart()) {
			norms = visit<false>();
			norms.impulse2 += apartImpulse2;
		} else {
			norms = visit<true>();
			settleApart();
		}
		visitedAll = true;
		return norms;
	}

	double certificate()
	{
		if (measure == Measure::naturalMap) prepare();
		BlockResidual<D> residual = knowsApart() ? apartResidual : BlockResidual<D>(measure);
		if (knowsApart())
			for (const std::size_t i : contacts.others) addTo(residual, i);
		else
			for (std::size_t i = 0; i < lanes.size(); ++i) addTo(residual, i);
		return residual.value();
	}

	void finish(SolveReport& report)
	{
		problem.velocity.resize(problem.q.size());
		for (std::size_t i = 0; i < lanes.size(); ++i) {
			const Vector u = velocityAt(i);
			Eigen::Map<Vector>(&problem.velocity[D * i]) = u;
			Eigen::Map<Vector>(&problem.impulse[D * i]) = impulse(i);
			report.maxApproachSpeed = std::max(report.maxApproachSpeed, -u[0]);
			report.activeContacts += lanes[i].lane[0] > 0;
		}
		if constexpr (D == 2)
			for (std::size_t i = 0; i < lanes.size(); ++i) report.ambiguousContacts += !OneContact2D(diagonalBlock(i)).isUnique(problem.friction[i]);
	}

	/// The factor of BlockSqueeze.hpp, of the present impulses or of what they have that others lack.
	double squeeze(const std::vector<Vector>* others = nullptr)
	{
		std::vector<Vector> r, u;
		impulses(r);
		velocities(u);
		return squeezeFactor<D>(problem, r, u, others);
	}

	/// Approach at the present point over the largest without any impulse [-]; 0 where nothing approaches.
	double approachLeft()
	{
		double left = 0;
		for (std::size_t i = 0; i < lanes.size(); ++i) left = std::max(left, -velocityAt(i)[0]);
		return left > 0 ? left / largestFreeApproach<D>(problem) : 0;
	}

	/// Whether a contact closes with a tenth of the largest approach without impulses though its own is a thousand times what stops that alone. Where
	/// there is no solution Newton's method goes to infinity and leaves velocities of any size, on which squeeze() says nothing.
	bool isLost()
	{
		prepare();
		const double largest = largestFreeApproach<D>(problem);
		for (std::size_t i = 0; i < lanes.size(); ++i) {
			if (!(lanes[i].lane[0] > 0 && visited[i].W(0, 0) * lanes[i].lane[0] >= 1000 * largest)) continue;
			if (const double approach = -velocityAt(i)[0]; approach > 0 && approach >= 0.1 * largest) return true;
		}
		return false;
	}

	void impulses(std::vector<Vector>& r) const
	{
		r.resize(lanes.size());
		for (std::size_t i = 0; i < lanes.size(); ++i) r[i] = impulse(i);
	}

	/// Continues from these impulses, brought into their cones, without momentum.
	void setImpulses(const std::vector<Vector>& given)
	{
		prepare();
		visitedAll = false;
		for (std::size_t i = 0; i < lanes.size(); ++i) {
			put(i, projected(given[i], problem.friction[i]));
			visited[i].increment.setZero();
			visited[i].direction.setZero();
		}
	}

	/// The impulses as they are, also outside the cones: for Newton's method. Not to be swept from.
	void setRaw(const std::vector<Vector>& given)
	{
		visitedAll = false;
		for (std::size_t i = 0; i < lanes.size(); ++i) put(i, given[i]);
	}

	/// u = W r + q [m/s] at the present impulses.
	void velocities(std::vector<Vector>& u)
	{
		u.resize(lanes.size());
		for (std::size_t i = 0; i < lanes.size(); ++i) u[i] = velocityAt(i);
	}

	/// Starts from the impulses as they are, also outside their cones: for residualOf().
	void takeImpulsesAsGiven()
	{
		visitedAll = false;
		for (std::size_t i = 0; i < lanes.size(); ++i) put(i, at(problem.impulse, i));
	}

private:
	/// What the visits of a contact keep.
	struct Visited {
		Local local;
		Block W; // symmetric part of the diagonal block
		Vector increment = Vector::Zero(), direction = Vector::Zero();
		double slidingRate = 0;
		bool known = false; // the eigenvectors of the local operator, when it first closes

		/// Exact solution of this contact when its impulse x goes with the velocity u. Inlined, because a call costs 5 % of a sweep in two
		/// dimensions.
		[[gnu::always_inline]] Vector visit(const Vector& x, const Vector& u, double mu)
		{
			const double bn = u[0] - W.row(0).dot(x);
			if (!(bn < 0)) return Vector::Zero();
			if (!known) {
				local = Local(W);
				known = true;
			}
			if constexpr (D == 2)
				return local.solve(u - W * x, mu);
			else
				return local.solve(u - W * x, mu, slidingRate);
		}
	};

	BlockProblem& problem;
	Measure measure;
	BlockProduct product;
	BlockRows rows;
	std::vector<ImpulseLanes> lanes;
	bool atZero = false;		  // all impulses are zero
	std::vector<Visited> visited; // empty until the first visit: a start that solves the problem does without

	bool visitedAll = false;   // since impulses were last given
	bool sortedOut = false;	   // in the second sweep, because many small problems need one only
	ContactsApart<D> contacts; // those apart are not visited any more once visitedAll
	double apartImpulse2 = 0;
	const Block none = Block::Zero();		 // where the measure does not use W
	BlockResidual<D> apartResidual{measure}; // where they are solved

	bool knowsApart() const { return visitedAll && !contacts.apart.empty(); }

	/// All contacts one after the other, or those that are not apart.
	template <bool all> SweepNorms visit()
	{
		SweepNorms norms;
		Vector r;						 // of the last contact visited, stored by the next product
		std::size_t last = lanes.size(); // that contact
		const std::size_t count = all ? lanes.size() : contacts.others.size();
		for (std::size_t k = 0; k < count; ++k) {
			const std::size_t i = all ? k : contacts.others[k];
			const bool follows = all ? k > 0 : last + 1 == i;
			if (!all && !follows && k > 0) put(last, r);
			Visited& contact = visited[i];
			Vector u;
			product(rows, lanes.data(), i, i + 1, u.data(), follows ? r.data() : nullptr);
			last = i;
			const Vector x = impulse(i);
			r = contact.visit(x, u, problem.friction[i]);
			contact.increment = r - x;
			if (r[0] == 0 && contact.increment[0] == 0) continue; // stays open
			norms.increment2 += contact.increment.dot(contact.W * contact.increment);
			norms.impulse2 += r.dot(contact.W * r);
		}
		if (count > 0) put(last, r);
		return norms;
	}

	/// Solves the contacts apart for good, and what they add to the sums.
	void settleApart()
	{
		apartImpulse2 = 0;
		apartResidual = BlockResidual<D>(measure);
		for (const std::size_t i : contacts.apart) {
			// From nothing: the visit in the sweep has the round-off of the impulse that it started from.
			visited[i].slidingRate = 0;
			put(i, visited[i].visit(Vector::Zero(), at(problem.q, i), problem.friction[i]));
			visited[i].increment.setZero();
			visited[i].direction.setZero();
			apartImpulse2 += impulse(i).dot(visited[i].W * impulse(i));
			addTo(apartResidual, i);
		}
	}

	[[gnu::always_inline]] void addTo(BlockResidual<D>& residual, std::size_t i)
	{
		residual.add(impulse(i), velocityAt(i), at(problem.q, i), problem.friction[i], measure == Measure::naturalMap ? visited[i].W : none);
	}

	void prepare()
	{
		if (!visited.empty()) return;
		visited.resize(lanes.size());
		for (std::size_t i = 0; i < visited.size(); ++i) visited[i].W = diagonalBlock(i);
	}

	/// Its symmetric part: the visit works with the increments of u, so that a symmetric local operator leaves the solution of the whole as it is.
	Block diagonalBlock(std::size_t i) const
	{
		const Block W = diagonalBlockOf<D>(problem, i);
		return 0.5 * (W + W.transpose());
	}

	Eigen::Map<const Vector> at(const std::vector<double>& values, std::size_t i) const { return Eigen::Map<const Vector>(&values[D * i]); }
	static Split<Tangent> split(const Vector& a) { return {a[0], a.template tail<D - 1>()}; }

	static Vector projected(const Vector& r, double mu)
	{
		const Split<Tangent> inside = projectOnCone(split(r), mu);
		Vector result;
		result << inside.n, inside.t;
		return result;
	}

	Vector impulse(std::size_t i) const { return Eigen::Map<const Vector>(lanes[i].lane); }

	void put(std::size_t i, const Vector& r)
	{
		atZero = false;
		if constexpr (D == 2)
			lanes[i] = {{r[0], r[1], r[0], r[1]}};
		else
			lanes[i] = {{r[0], r[1], r[2], 0}};
	}

	Vector velocityAt(std::size_t i)
	{
		if (atZero) return at(problem.q, i);
		Vector u;
		product(rows, lanes.data(), i, i + 1, u.data(), nullptr);
		return u;
	}
};

} // namespace contactdynamics
