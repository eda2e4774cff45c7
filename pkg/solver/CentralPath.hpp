// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "CentralPathSystem.hpp"

#include <functional>

namespace contactdynamics {

/// Follows the central path of a block problem (CentralPathSystem.hpp) from z = 0, t = 1, which is made one of its points, to t = 0, where it is a
/// solution: the last resort for problems on which sweeps and Newton steps stall. It needs no start and does not depend on one.
///
/// Coulomb's friction is not the derivative of a potential, so the path need not fall in t all the way: it turns back where two solutions of
/// F(z, t) = 0 meet, and must be followed through. So it is parametrised by its length (Keller 1977): a step along the tangent, then Newton's method
/// in the plane across it. Which way is onward the sign of det dF/dz says: t falls where it is as at the start, and grows where it is not. A tangent
/// by its angle with the last one was rejected: on a problem of 463 contacts it took a fold for a turn back and returned to the start.
///
/// All lengths are relative to what a contact can move without a change of its kind, sqrt(|z|^2 + 4 t): the largest of all contacts for a correction,
/// the root of their mean square for a step. With one length for all, light contacts jump to another branch. A path that is lost, because its
/// corrections were too coarse for a sharp fold, is followed anew from the start with finer ones, twice.
template <int D> class CentralPath {
public:
	using Vector = Eigen::Matrix<double, D, 1>;

	explicit CentralPath(const BlockProblem& problem); ///< with at least one contact

	double systemCost() const { return system.jacobian().operations(); } ///< operations, of the last system solved; 0 before

	/// Goes on along the path. @param most  linear systems to solve, and as many more as end the step that is under way
	/// @param reached  is given the impulses of each point, inside the cones [N s], and returns true where they will do
	/// @return linear systems solved; none where it could not be followed to a point that will do from any of its starts
	int follow(int most, const std::function<bool(const std::vector<Vector>&)>& reached);

private:
	struct Point {
		Eigen::VectorXd z;
		double logT;
		Eigen::VectorXd slope; // dz/dlogT along the path
		double sign;		   // of det dF/dz
		int corrections;
	};
	struct Tangent {
		Eigen::VectorXd z; // and in log t:
		double logT;
		Eigen::VectorXd weighted; // z times the squared weights
	};

	CentralPathSystem<D> system;
	Point at;
	double firstSign = 1, length = 0.5; // of the next step
	double accuracy = 0;				// of the corrections
	int starts = 0;
	bool over = false;
	int solved = 0;

	void start();
	bool step();
	Tangent tangent(const Point& point, const Eigen::VectorXd& weights) const;
	bool correct(Point& next, const Tangent& across, double moved);
	Eigen::VectorXd weights() const;
	double relative(const Eigen::VectorXd& change, const Point& point) const; // the largest of a contact
	static double squaredReach(const Point& point, int contact);
};

} // namespace contactdynamics
