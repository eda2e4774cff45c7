// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <pkg/solver/GrainProblem.hpp>
#include <string>

namespace yade {

/// Two-dimensional scenes: bodies that move in a coordinate plane only (State.blockedDOFs such as 'zXY'), and contacts that lie in it.
namespace PlaneOfMotion {
/// Axis normal to the plane (0, 1, 2), or -1 when there is none: every movable body has its translation along the axis and the rotations about the
/// other two blocked, no body has a velocity of that kind, no belt turns out of it, and normals, lever arms and image velocities have no component
/// along the axis. All comparisons are exact.
int axisOf(const contactdynamics::GrainProblem& problem);

/// Plane with the given normal axis: "xy", "yz", "zx", or "" for -1.
std::string nameOf(int axis);

/// Gives a body the mobility out of the plane that a ball would have. In a scene for which axisOf() found a plane nothing ever pushes that way, so no
/// number changes; but W of a contact between such bodies is that of balls, diag(W_N, W_T, W_T), and its closed form is (34) with W_TN = 0.
/// @return  false, with the body as it was, if its two mobilities in the plane differ
bool completeAsBall(contactdynamics::Body& body, int axis);
} // namespace PlaneOfMotion

/// Number of contacts that violate the condition (33) for a unique solution, mu |W_TN| < W_NN (in three dimensions: a sufficient condition, with the
/// norm of both tangential components). Contacts of balls never do.
int ambiguousContacts(const contactdynamics::GrainProblem& problem);

} // namespace yade
