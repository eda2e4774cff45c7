// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "BlockProblem.hpp"
#include "BlockSystem.hpp"

namespace contactdynamics {

/// The equations of the central path, one D-vector z for each contact, at any t > 0:
///
///     F(z, t) = u(z, t) - W r(z, t) - q - s n - t f = 0,    s = sqrt(|u_T|^2 + t^2)
///
/// in scaled components, where the cones of all contacts have 45 degrees (r_N times mu, u_N by mu) and the diagonal of each block W_ii has the
/// mean 1. r and u are those of SmoothedContact.hpp, s n is the change of variable of De Saxce and Feng (1998) with its kink rounded: t = 0 is
/// Coulomb's law with Signorini's condition. f makes a given point one of the path. A contact without friction (mu < 1e-100) has r_T = 0 and u_T =
/// -z_T instead, one that nothing moves along its normal has r = 0.
template <int D> class CentralPathSystem {
public:
	using Vector = Eigen::Matrix<double, D, 1>;
	using Block = Eigen::Matrix<double, D, D>;

	explicit CentralPathSystem(const BlockProblem& problem);

	int unknowns() const { return int(D * scale.size()); }

	/// Makes this a point of the path.
	void startAt(const Eigen::VectorXd& z, double logT);

	/// Sets value, rate and the matrix of the linear system. @param logT  tau = log t
	void evaluate(const Eigen::VectorXd& z, double logT);

	const Eigen::VectorXd& value() const { return F; }		  ///< F(z, t)
	const Eigen::VectorXd& rate() const { return rateOfLog; } ///< dF/dtau

	/// Whether F of the last evaluate() is round-off of its terms.
	bool atRoundOff() const { return excess <= 0; }

	/// dF/dz of the last evaluate(), to be factorised.
	BlockSystem<D>& jacobian() { return system; }
	const BlockSystem<D>& jacobian() const { return system; }

	/// r(z, t) in the units of the problem [N s]: inside the cones.
	void impulses(const Eigen::VectorXd& z, double logT, std::vector<Vector>& r) const;

private:
	enum class Law : unsigned char { coulomb, frictionless, none };

	std::vector<Law> law;
	std::vector<Vector> scale; // of r: given = scale * scaled
	double size = 1;		   // of q, scaled
	double excess = 0;		   // of |F| over the round-off of its terms
	std::vector<Block> W;	   // of each block of the problem, scaled
	std::vector<std::int32_t> rowStart, column;
	Eigen::VectorXd q, f, r, F, terms, rateOfR, rateOfLog;
	std::vector<Block> slope; // dr/dz of each contact

	BlockSystem<D> system;

	/// A contact at z, by its law.
	struct Contact {
		Vector r = Vector::Zero(), u, rateOfR = Vector::Zero(), rateOfU = Vector::Zero(); // rates: d/dt; u less s n
		Block slopeOfR = Block::Zero(), slopeOfU = -Block::Identity();					  // d/dz
	};
	Contact contact(std::size_t i, const Eigen::VectorXd& z, double t) const;

	void describe(const BlockProblem& problem);
};

} // namespace contactdynamics
