// SPDX-License-Identifier: GPL-2.0-or-later
#include "CentralPath.hpp"

namespace contactdynamics {

namespace {

// Measured on the problems of doc/solver.rst; "relative" as in CentralPath.hpp.
constexpr double firstLogT = 0, mostLogT = 3;				 // free velocities have the size one; a path that goes back beyond its start is lost
constexpr double firstLength = 0.5, longest = 2, grow = 1.5; // of a step, relative
constexpr double shortest = 1e-10;
constexpr double farthest = 0.5; // a correction, relative: beyond it the step was too long
constexpr double leastContraction = 0.5;
constexpr int mostCorrections = 7;
constexpr double ofStep = 0.1;				  // the last correction, of the step
constexpr double coarse = 0.01, finer = 0.01; // the last correction, relative, and from start to start
constexpr int mostStarts = 3;
constexpr double leastCosine = 0.7, straight = 0.95, bent = 0.85; // of the angle between two tangents
constexpr double leastLogT = -70;								  // exp(-70) = 4e-31: complementarity far below round-off

} // namespace

template <int D> CentralPath<D>::CentralPath(const BlockProblem& problem) : system(problem) {}

template <int D> void CentralPath<D>::start()
{
	over = starts == mostStarts;
	if (over) return;
	accuracy = coarse * std::pow(finer, starts++);
	length = firstLength;
	at.z = Eigen::VectorXd::Zero(system.unknowns());
	at.logT = firstLogT;
	system.startAt(at.z, at.logT);
	system.evaluate(at.z, at.logT);
	over = !system.jacobian().factorise();
	++solved;
	if (over) return;
	at.slope = system.jacobian().solve(-system.rate());
	at.sign = firstSign = system.jacobian().signOfDeterminant();
}

template <int D> int CentralPath<D>::follow(int most, const std::function<bool(const std::vector<Vector>&)>& reached)
{
	const int before = solved;
	std::vector<Vector> impulses;
	while (!over && solved - before < most) {
		if (starts == 0 || !step() || at.logT > mostLogT) {
			start();
			continue;
		}
		system.impulses(at.z, at.logT, impulses);
		if (reached(impulses)) break;
		over = at.logT < leastLogT;
	}
	return solved - before;
}

template <int D> bool CentralPath<D>::step()
{
	const Eigen::VectorXd squared = weights();
	const Tangent along = tangent(at, squared);
	for (; length >= shortest; length *= 0.5) {
		Point next{at.z + length * along.z, at.logT + length * along.logT, {}, 1, 0};
		const double moved = std::max(relative(length * along.z, at), std::abs(length * along.logT));
		if (!correct(next, along, moved)) continue;
		const Tangent then = tangent(next, squared);
		const double cosine = then.z.dot(along.weighted) + then.logT * along.logT;
		if (!(cosine >= leastCosine)) continue;
		if (next.corrections <= 3 && cosine > straight)
			length = std::min(grow * length, longest);
		else if (cosine < bent)
			length *= 0.7;
		at = std::move(next);
		return true;
	}
	return false;
}

template <int D> typename CentralPath<D>::Tangent CentralPath<D>::tangent(const Point& point, const Eigen::VectorXd& squared) const
{
	const double norm = std::sqrt(point.slope.cwiseAbs2().dot(squared) + 1);
	const double onward = point.sign == firstSign ? -1 : 1;
	const Eigen::VectorXd z = onward / norm * point.slope;
	return {z, onward / norm, squared.cwiseProduct(z)};
}

/// Newton's method in the plane across the tangent. The matrix is bordered by elimination: its own determinant vanishes at a fold only.
template <int D> bool CentralPath<D>::correct(Point& next, const Tangent& across, double moved)
{
	double before = 1;
	while (next.corrections < mostCorrections) {
		system.evaluate(next.z, next.logT);
		if (!system.jacobian().factorise()) return false;
		++solved;
		++next.corrections;
		next.slope = system.jacobian().solve(-system.rate());
		next.sign = system.jacobian().signOfDeterminant();
		const Eigen::VectorXd toCurve = system.jacobian().solve(-system.value());
		const double changeOfLogT = -across.weighted.dot(toCurve) / (across.weighted.dot(next.slope) + across.logT);
		const Eigen::VectorXd change = toCurve + changeOfLogT * next.slope;
		if (!change.allFinite()) return false;
		const double size = std::max(relative(change, next), std::abs(changeOfLogT));
		const bool done = size < std::min(accuracy, ofStep * moved) || system.atRoundOff();
		if (!done && !(size <= farthest && (size <= accuracy || size <= leastContraction * before))) return false;
		next.z += change;
		next.logT += changeOfLogT;
		if (done) return true;
		before = size;
	}
	return false;
}

template <int D> Eigen::VectorXd CentralPath<D>::weights() const
{
	const int count = system.unknowns() / D;
	Eigen::VectorXd squared(system.unknowns());
	for (int i = 0; i < count; ++i) squared.segment<D>(D * i).setConstant(1 / (count * squaredReach(at, i)));
	return squared;
}

template <int D> double CentralPath<D>::relative(const Eigen::VectorXd& change, const Point& point) const
{
	double largest = 0;
	for (int i = 0; i < system.unknowns() / D; ++i) largest = std::max(largest, change.segment<D>(D * i).squaredNorm() / squaredReach(point, i));
	return std::sqrt(largest);
}

template <int D> double CentralPath<D>::squaredReach(const Point& point, int i)
{
	const Vector z = point.z.template segment<D>(D * i);
	return z.squaredNorm() + 4 * std::exp(point.logT);
}

template class CentralPath<2>;
template class CentralPath<3>;

} // namespace contactdynamics
