// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <lib/base/Math.hpp>
#include <pkg/solver/SignoriniCoulombSolver.hpp>
#include <vector>

namespace yade {

class ContactDynamicsPhys;

/// Rolling and twisting friction: a torque impulse M on body 2, the opposite on body 1, with
///
///     |M_T| <= l r_N, |M_N| <= m r_N, against the relative angular velocity w at the end of the step, and on the limit unless that is zero.
///
/// Two nested block Gauss-Seidel loops: with the torques held they are external to the Signorini-Coulomb loop, which so does not know them; with
/// its r_N held each torque is the projection of M - w / W_w on its discs. Repeated from the last step's torques until they change by less than
/// the tolerance. Nothing lags: r_N and w are those of the same step. Rejected: a bound from the last step's r_N, which lets a ball that lands
/// roll freely for a step, and torques from the velocity at the start of the step, under which balls creep on a slope they should rest on.
class RollingFriction {
public:
	void clear() { rows.clear(); }
	bool empty() const { return rows.empty(); }
	/// @param drive  angular velocity of body 2 relative to body 1 that comes from bodies which turn, but are not moved [rad/s]
	void add(int contact, ContactDynamicsPhys& phys, bool swapped, Real warmStart, const Vector3r& drive);

	contactdynamics::SolveReport solve(contactdynamics::SignoriniCoulombSolver& solver, contactdynamics::GrainProblem& problem,
									   const contactdynamics::SolverOptions& options);

	/// Stores the impulses of the last solve with the contacts.
	void remember() const;

	struct Row {
		int contact;
		ContactDynamicsPhys* phys;
		bool swapped;
		Vector3r impulse; // on body 2 of the contact, global axes [N m s]
		Vector3r drive;
	};
	const std::vector<Row>& all() const { return rows; }

private:
	Real improve(const contactdynamics::GrainProblem& problem);

	std::vector<Row> rows;
	std::vector<Vector3r> improved, spin; // by row; by body
	std::vector<contactdynamics::Body> free;
	std::optional<contactdynamics::MeanField> freeField;
};

} // namespace yade
