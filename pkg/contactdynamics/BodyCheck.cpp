// SPDX-License-Identifier: GPL-2.0-or-later
#include "BodyCheck.hpp"
#include <core/Body.hpp>
#include <core/State.hpp>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace yade {
namespace {
template <class Value> [[noreturn]] void refuse(const Body& body, const char* attribute, const Value& value, const char* allowed)
{
	std::ostringstream message;
	message << "body #" << body.getId() << ": " << attribute << " is " << value << "; " << allowed << ".";
	throw std::runtime_error(message.str());
}

void requireFinite(const Body& body, const char* attribute, const Vector3r& value)
{
	if (!value.allFinite()) refuse(body, attribute, value.transpose(), "it must be finite");
}
} // namespace

void requireUsableState(const Body& body, const Vector3r& force, const Vector3r& torque)
{
	const State& state = *body.state;
	requireFinite(body, "the force (O.forces.f and permanent force)", force);
	requireFinite(body, "the torque (O.forces.t and permanent torque)", torque);
	requireFinite(body, "state.pos", state.pos);
	requireFinite(body, "state.vel", state.vel);
	requireFinite(body, "state.angVel", state.angVel);
	requireFinite(body, "state.angMom", state.angMom);
	if (!state.ori.coeffs().allFinite()) refuse(body, "state.ori", state.ori.coeffs().transpose(), "it must be finite");
	for (int axis = 0; axis < 3; axis++) {
		if (!(state.blockedDOFs & State::axisDOF(axis, false)) && !(state.mass > 0 && std::isfinite(state.mass)))
			refuse(body, "state.mass", state.mass, "it must be positive and finite, or all translations blocked (state.blockedDOFs)");
		if (!(state.blockedDOFs & State::axisDOF(axis, true)) && !(state.inertia[axis] > 0 && std::isfinite(state.inertia[axis])))
			refuse(body, "state.inertia", state.inertia.transpose(),
				   "it must be positive and finite along every rotation that is not blocked (state.blockedDOFs)");
	}
}

void requirePositiveScaling(const Body& body, Real scaling)
{
	if (!(scaling > 0 && std::isfinite(scaling)))
		refuse(body, "state.densityScaling", scaling, "with NewtonIntegrator.densityScaling it must be positive and finite");
}

void requirePositiveRadius(const Body& body, Real radius)
{
	if (!(radius > 0 && std::isfinite(radius))) refuse(body, "shape.radius", radius, "it must be positive and finite");
}

void requireFiniteGradient(const Matrix3r& velGrad)
{
	if (velGrad.allFinite()) return;
	std::ostringstream message;
	message << "O.cell.velGrad is (row by row) " << velGrad.row(0) << ", " << velGrad.row(1) << ", " << velGrad.row(2) << "; it must be finite.";
	throw std::runtime_error(message.str());
}

} // namespace yade
