// SPDX-License-Identifier: GPL-2.0-or-later
// Spheres on the seams of boundaries: see Seams.hpp.
#include "ContactDynamicsPhys.hpp"
#include "ContactDynamicsStep.hpp"
#include "ParallelLoop.hpp"
#include "ProximityGeometry.hpp"
#include "Seams.hpp"
#include <core/Cell.hpp>
#include <core/Scene.hpp>
#include <pkg/dem/ScGeom.hpp>
#include <algorithm>
#include <tuple>

namespace yade {

/// A sphere that rolls over a seam takes the start of the solve along: what the contact that is left remembers goes to the one that follows it.
void ContactDynamicsStep::passOnImpulses(Link* const* group, const std::vector<SurfaceContact>& contacts) const
{
	const auto sphereIsFirst = [&](std::size_t i) { return views[group[i]->id1].radius > 0; };
	constexpr Real alike = 0.9; // cosine of the angle between normals of contacts that take over from each other
	for (std::size_t from = 0; from < contacts.size(); from++) {
		Vector3r& impulse = group[from]->phys->impulse;
		if (contacts[from].role != SurfaceContact::Role::left || impulse == Vector3r::Zero()) continue;
		for (std::size_t to = 0; to < contacts.size(); to++) {
			if (contacts[to].role == SurfaceContact::Role::left || group[to]->phys->impulse != Vector3r::Zero()) continue;
			if (contacts[to].normal.dot(contacts[from].normal) < alike) continue;
			const int sign = sphereIsFirst(from) == sphereIsFirst(to) ? 1 : -1;
			const ContactDynamicsPhys& left = *group[from]->phys;
			ContactDynamicsPhys& follows = *group[to]->phys;
			follows.impulse = sign * impulse;
			follows.torqueImpulse = sign * left.torqueImpulse;
			follows.stretch = sign * left.stretch;
			follows.stretchRate = sign * left.stretchRate;
			break;
		}
		impulse = Vector3r::Zero();
	}
}

void ContactDynamicsStep::settleSurfaceSeams(const Scene& scene)
{
	const auto shiftOfImage = [&](const Interaction& interaction) {
		return scene.isPeriodic ? Vector3r(scene.cell->hSize * interaction.cellDist.cast<Real>()) : Vector3r(Vector3r::Zero());
	};
	// Links of spheres with more than one surface, by sphere and image of space, and by the surface's id within. Seldom many.
	std::vector<int> surfacesOf(views.size(), 0);
	const auto ofSurface = [&](const Link& link) { return (views[link.id1].radius > 0) != (views[link.id2].radius > 0); };
	// The sphere is body 2, but for polyhedra.
	const auto sphereIsFirst = [&](const Link& link) { return views[link.id1].radius > 0; };
	const auto sphereOf = [&](const Link& link) { return sphereIsFirst(link) ? link.id1 : link.id2; };
	const auto surfaceOf = [&](const Link& link) { return sphereIsFirst(link) ? link.id2 : link.id1; };
	for (const Link& link : links)
		if (ofSurface(link)) surfacesOf[sphereOf(link)]++;
	std::vector<Link*> shared;
	for (Link& link : links)
		if (ofSurface(link) && surfacesOf[sphereOf(link)] > 1) shared.push_back(&link);
	const auto image = [&](const Link* link) { return std::make_tuple(sphereOf(*link), surfaceOf(*link)); };
	std::sort(shared.begin(), shared.end(), [&](const Link* a, const Link* b) { return image(a) < image(b); });
	std::vector<std::size_t> starts;
	for (std::size_t i = 0; i < shared.size(); i++)
		if (i == 0 || sphereOf(*shared[i]) != sphereOf(*shared[i - 1])) starts.push_back(i);
	starts.push_back(shared.size());

	parallelLoop(static_cast<long>(starts.size()) - 1, [&](long group) {
		const BodyView& sphere = views[sphereOf(*shared[starts[group]])];
		const auto advanceAt = [&](const BodyView& view, const Vector3r& arm) { // of a point of the body, from the body's own position
			const Twist twist = freeOf(view.index);
			const Vector3r fromCentre = view.state->pos - views[idOfIndex[view.index]].state->pos + arm;
			return Vector3r(h * (twist.velocity + twist.angularVelocity.cross(fromCentre)));
		};
		const Vector3r advance = advanceAt(sphere, Vector3r::Zero());
		std::vector<SurfaceContact> contacts;
		for (std::size_t i = starts[group]; i < starts[group + 1]; i++) {
			const Interaction& interaction = *shared[i]->interaction;
			const ScGeom& geom = static_cast<const ScGeom&>(*interaction.geom);
			const int surface = surfaceOf(*shared[i]);
			const BodyView& view = views[surface];
			const Real side = sphereIsFirst(*shared[i]) ? -1 : 1;
			const Vector3r shift = side * shiftOfImage(interaction); // of the sphere, as seen from the surface
			const Vector3r origin = view.state->pos - sphere.state->pos - shift;
			const Vector3r normal = side * geom.normal, point = -(sphere.radius - geom.penetrationDepth) * normal;
			contacts.push_back({Surface((*scene.bodies)[surface]->shape, *view.state, origin), surface, normal, -geom.penetrationDepth,
								advanceAt(view, point - origin) - h * (velGrad * shift)});
		}
		settleSeams(sphere.radius, advance, contacts);
		passOnImpulses(shared.data() + starts[group], contacts);
		for (std::size_t i = 0; i < contacts.size(); i++) {
			Link& link = *shared[starts[group] + i];
			const SurfaceContact& contact = contacts[i];
			if (contact.role == SurfaceContact::Role::left) link.solved = false;
			if (contact.role != SurfaceContact::Role::replaced) continue;
			// As if the surface were its tangent plane.
			if (sphereIsFirst(link))
				placeScGeom(*link.interaction,
							{sphere.state->pos - sphere.radius * contact.normal, -contact.normal, contact.gap, sphere.radius, sphere.radius});
			else
				placeScGeom(*link.interaction, {sphere.state->pos + shiftOfImage(*link.interaction) - (sphere.radius + contact.gap) * contact.normal,
												contact.normal, contact.gap, sphere.radius, sphere.radius});
		}
	});
}

} // namespace yade
