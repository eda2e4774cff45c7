// SPDX-License-Identifier: GPL-2.0-or-later
#include "PenetrationRepair.hpp"
#include <algorithm>
#include <limits>

namespace yade {
namespace {
/// The deepest overlap shrinks by this in a step, in radii, and all others in proportion ...
constexpr Real gentleStep = 1e-4;
/// ... but at least by this share, which makes a hundredth of any overlap in 770 steps.
constexpr Real leastShare = 6e-3;
/// Largest displacement of a body in a step, in radii of the smallest sphere: a fifth of the least proximity margin of a body, so that no contact
/// comes unseen.
constexpr Real largestWay = 1e-2;
/// How far the pull c alone would move two bodies, in units of the largest displacement that is asked for. Overlaps accumulate over a stack, so it
/// has to be many.
constexpr Real pull = 50;
/// Relative to the pull. What is left shows as overlap or gap, never as energy, and the repair goes on in the next step.
constexpr Real tolerance = 1e-5;
constexpr int sweeps = 500;

Real normalMobility(const contactdynamics::GrainProblem& problem, const contactdynamics::Contact& contact)
{
	return contact.normal.dot((problem.bodies[contact.body1].inverseMass + problem.bodies[contact.body2].inverseMass).cwiseProduct(contact.normal));
}
} // namespace

/// Whether any overlap is larger than allowed.
bool PenetrationRepair::measure(const contactdynamics::GrainProblem& solved, const std::vector<Overlap>& overlaps, Real h, Real allowed)
{
	gapAtEnd.resize(overlaps.size());
	remaining = largest = deepest = 0;
	smallestRadius = std::numeric_limits<Real>::infinity();
	for (std::size_t i = 0; i < overlaps.size(); i++) {
		const contactdynamics::Contact& contact = solved.contacts[i];
		gapAtEnd[i] = overlaps[i].gap + h * contact.normal.dot(contact.relativeVelocity);
		if (overlaps[i].radius <= 0) continue;
		remaining = std::max(remaining, -gapAtEnd[i]);
		deepest = std::max(deepest, -gapAtEnd[i] / overlaps[i].radius);
		smallestRadius = std::min(smallestRadius, overlaps[i].radius);
	}
	return deepest > allowed;
}

bool PenetrationRepair::solve(const contactdynamics::GrainProblem& solved, const std::vector<Overlap>& overlaps, Real h, Real rate, Real allowed,
							  int threads)
{
	if (!measure(solved, overlaps, h, allowed) || rate == 0) return false;
	const Real share = std::min(rate, std::max(leastShare, gentleStep / deepest));
	const auto isotropic = [](const contactdynamics::Body& body) { return body.inverseMass == Vector3r::Constant(body.inverseMass[0]); };
	problem.bodies.resize(solved.bodies.size());
	for (std::size_t i = 0; i < solved.bodies.size(); i++)
		problem.bodies[i] = {Vector3r::Zero(), Vector3r::Zero(), solved.bodies[i].inverseMass, Matrix3r::Zero()};
	problem.contacts.clear();
	for (std::size_t i = 0; i < overlaps.size(); i++) {
		const contactdynamics::Contact& from = solved.contacts[i];
		const Real room = gapAtEnd[i] + allowed * overlaps[i].radius;
		if (overlaps[i].radius <= 0 || room > 2 * largestWay * smallestRadius) continue;
		contactdynamics::Contact contact;
		contact.body1 = from.body1;
		contact.body2 = from.body2;
		contact.normal = from.normal;
		contact.ball = isotropic(solved.bodies[from.body1]) && isotropic(solved.bodies[from.body2]); // without rotation, arms do not matter
		contact.gapVelocity = room < 0 ? share * room : room;
		if (from.impulse != Vector3r::Zero() && normalMobility(problem, contact) > 0) {
			contact.gapVelocity = std::min(contact.gapVelocity, Real(0)); // closed contacts stay where they are
			letPull(contact, pull * share * deepest * overlaps[i].radius);
		}
		gapAtEnd[problem.contacts.size()] = gapAtEnd[i]; // from here on parallel to problem.contacts
		problem.contacts.push_back(contact);
	}

	contactdynamics::SolverOptions options;
	options.tolerance = tolerance;
	options.maxIterations = sweeps;
	options.threads = threads;
	if (solver.solve(problem, options).status == contactdynamics::SolveStatus::notFinite) return false;
	limit(largestWay * smallestRadius);
	return largest > 0;
}

void PenetrationRepair::letPull(contactdynamics::Contact& contact, Real displacement)
{
	contactdynamics::Body &body1 = problem.bodies[contact.body1], &body2 = problem.bodies[contact.body2];
	contact.impulse = displacement / normalMobility(problem, contact) * contact.normal;
	body1.velocity += body1.inverseMass.cwiseProduct(contact.impulse);
	body2.velocity -= body2.inverseMass.cwiseProduct(contact.impulse);
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
