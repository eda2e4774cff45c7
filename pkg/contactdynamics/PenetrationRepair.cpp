// SPDX-License-Identifier: GPL-2.0-or-later
#include "PenetrationRepair.hpp"
#include <algorithm>
#include <limits>

namespace yade {
namespace {
/// Largest part of an overlap taken away in a step, in radii. The gaps that the repair may open elsewhere are of that size, so a grain that falls
/// into one stays below a hundredth of the speed that gravity gives over a diameter: sqrt(2 g r/10000) < sqrt(2 g 2r)/100.
constexpr Real largestShare = 1e-4;
/// Largest displacement of a body in a step, in radii of the smallest sphere: a fifth of the least proximity margin of a body, so that no contact
/// comes unseen.
constexpr Real largestWay = 1e-2;
/// The repair goes on in the next step, so a coarse solution is good enough; its error shows as overlap, never as energy.
constexpr Real coarse = 1e-2;
constexpr int fewSweeps = 30;
} // namespace

bool PenetrationRepair::solve(const contactdynamics::GrainProblem& solved, const std::vector<Overlap>& overlaps, Real h, Real rate, Real allowed,
							  int threads)
{
	const std::size_t count = solved.contacts.size();
	gapAtEnd.resize(count);
	remaining = largest = 0;
	Real smallest = std::numeric_limits<Real>::infinity();
	bool needed = false;
	for (std::size_t i = 0; i < count; i++) {
		const contactdynamics::Contact& contact = solved.contacts[i];
		gapAtEnd[i] = overlaps[i].gap + h * contact.normal.dot(contact.relativeVelocity);
		remaining = std::max(remaining, -gapAtEnd[i]);
		if (overlaps[i].radius > 0) smallest = std::min(smallest, overlaps[i].radius);
		needed = needed || (overlaps[i].radius > 0 && gapAtEnd[i] < -allowed * overlaps[i].radius);
	}
	if (!needed) return false;

	const auto isotropic = [](const contactdynamics::Body& body) { return body.inverseMass == Vector3r::Constant(body.inverseMass[0]); };
	problem.bodies.resize(solved.bodies.size());
	for (std::size_t i = 0; i < solved.bodies.size(); i++)
		problem.bodies[i] = {Vector3r::Zero(), Vector3r::Zero(), solved.bodies[i].inverseMass, Matrix3r::Zero()};
	problem.contacts.clear();
	for (std::size_t i = 0; i < count; i++) {
		const contactdynamics::Contact& from = solved.contacts[i];
		const Real room = gapAtEnd[i] + allowed * overlaps[i].radius;
		if (overlaps[i].radius <= 0 || room > 2 * largestWay * smallest) continue;
		contactdynamics::Contact contact;
		contact.body1 = from.body1;
		contact.body2 = from.body2;
		contact.normal = from.normal;
		contact.ball = isotropic(solved.bodies[from.body1]) && isotropic(solved.bodies[from.body2]); // without rotation, arms do not matter
		contact.gapVelocity = room < 0 ? std::max(rate * room, -largestShare * overlaps[i].radius) : room;
		gapAtEnd[problem.contacts.size()] = gapAtEnd[i]; // from here on parallel to problem.contacts
		problem.contacts.push_back(contact);
	}

	contactdynamics::SolverOptions options;
	options.tolerance = coarse;
	options.maxIterations = fewSweeps;
	options.threads = threads;
	if (solver.solve(problem, options).status == contactdynamics::SolveStatus::notFinite) return false;
	limit(largestWay * smallest);
	return largest > 0;
}

/// Scaling all displacements alike keeps them admissible: the way of no contact grows.
void PenetrationRepair::limit(Real allowedDisplacement)
{
	for (const auto& body : problem.bodies) largest = std::max(largest, body.velocity.norm());
	const Real scale = largest > allowedDisplacement ? allowedDisplacement / largest : 1;
	for (auto& body : problem.bodies) body.velocity *= scale;
	largest *= scale;
	remaining = 0;
	for (std::size_t i = 0; i < problem.contacts.size(); i++)
		remaining = std::max(remaining, -(gapAtEnd[i] + scale * problem.contacts[i].normal.dot(problem.contacts[i].relativeVelocity)));
}

} // namespace yade
