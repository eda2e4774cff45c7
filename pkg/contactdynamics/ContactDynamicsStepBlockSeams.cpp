// SPDX-License-Identifier: GPL-2.0-or-later
// Polyhedra on the seams of what they stand on: see BlockSeams.hpp.
#include "BlockSeams.hpp"
#include "ContactDynamicsStep.hpp"
#include "ConvexShapes.hpp"
#include "ManifoldContact.hpp"
#include "ManifoldGeom.hpp"
#include "ParallelLoop.hpp"
#include "Reach.hpp"
#include <core/Cell.hpp>
#include <core/Scene.hpp>
#include <pkg/common/Facet.hpp>
#include <algorithm>

namespace yade {
namespace {
/// A body that stands still and bears many others: seams of theirs are settled on their side, and a look at all pairs would take long.
constexpr std::size_t manyOnFixed = 64;

/// One side of an interaction.
struct Side {
	int body, other;
	Interaction* interaction;
	BlockContact::Seam seam = BlockContact::Seam::none;
	Vector3r direction = Vector3r::Zero(); // from body 1 to body 2
};

BlockContact contactSeenFrom(const Scene& scene, const Side& side)
{
	const Interaction& interaction = *side.interaction;
	const auto& geom = static_cast<const ManifoldGeom&>(*interaction.geom);
	const Body& surface = *(*scene.bodies)[side.other];
	const State& own = *(*scene.bodies)[side.body]->state;
	const Vector3r shift = scene.isPeriodic ? Vector3r(scene.cell->hSize * interaction.cellDist.cast<Real>()) : Vector3r(Vector3r::Zero());
	const bool isFirst = interaction.getId1() == side.body;
	const Vector3r origin = isFirst ? own.pos : Vector3r(own.pos + shift); // where the points of the geometry are seen from
	BlockContact contact;
	contact.normal = isFirst ? Vector3r(-geom.normal) : geom.normal;
	contact.gap = -geom.penetrationDepth;
	if (dynamic_cast<const Wall*>(surface.shape.get())) return contact;
	contact.shape = &ConvexShapes::of(surface.shape);
	contact.rotation = surface.state->ori.toRotationMatrix();
	contact.place = surface.state->pos + (isFirst ? shift : Vector3r(Vector3r::Zero())) - origin;
	contact.isFacet = dynamic_cast<const Facet*>(surface.shape.get());
	if (!contact.isFacet) return contact;
	for (std::size_t i = 0; i < geom.points.size(); i++) contact.points.push_back(geom.points[i] - 0.5 * geom.gaps[i] * contact.normal - origin);
	if (geom.points.empty()) contact.points.push_back(geom.contactPoint - 0.5 * contact.gap * contact.normal - origin);
	return contact;
}
} // namespace

void ContactDynamicsStep::settleBlockSeamsOf(const Scene& scene)
{
	std::vector<Side> sides;
	for (const Gathered& one : gathered) {
		if (!one.severalPoints) continue;
		sides.push_back({one.id1, one.id2, one.interaction});
		sides.push_back({one.id2, one.id1, one.interaction});
	}
	std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.body != b.body ? a.body < b.body : a.other < b.other; });
	std::vector<std::size_t> starts;
	for (std::size_t i = 0; i < sides.size(); i++)
		if (i == 0 || sides[i].body != sides[i - 1].body) starts.push_back(i);
	starts.push_back(sides.size());

	parallelLoop(static_cast<long>(starts.size()) - 1, [&](long group) {
		const std::size_t first = starts[group], count = starts[group + 1] - first;
		const Body& body = *(*scene.bodies)[sides[first].body];
		if (count < 2 || (views[body.id].fixed && count > manyOnFixed) || dynamic_cast<const Wall*>(body.shape.get())) return;
		std::vector<BlockContact> contacts;
		for (std::size_t i = 0; i < count; i++) contacts.push_back(contactSeenFrom(scene, sides[first + i]));
		settleBlockSeams(ConvexShapes::of(body.shape), body.state->ori.toRotationMatrix(), contacts);
		for (std::size_t i = 0; i < count; i++) {
			Side& side = sides[first + i];
			side.seam = contacts[i].seam;
			side.direction = side.interaction->getId1() == side.body ? Vector3r(-contacts[i].direction) : contacts[i].direction;
		}
	});

	// Where both bodies see a seam, the one with the smaller id decides.
	std::vector<const Side*> turned;
	for (const Side& side : sides)
		if (side.seam != BlockContact::Seam::none) turned.push_back(&side);
	std::stable_sort(turned.begin(), turned.end(),
					 [](const Side* a, const Side* b) { return std::minmax(a->body, a->other) < std::minmax(b->body, b->other); });
	turned.erase(std::unique(turned.begin(), turned.end(), [](const Side* a, const Side* b) { return a->interaction == b->interaction; }),
				 turned.end());
	parallelLoop(static_cast<long>(turned.size()), [&](long i) {
		const Side& side = *turned[i];
		// Beyond a hollow seam the block is not above the facet yet.
		const Real beside = side.seam == BlockContact::Seam::hollow ? Reach::ofPair(scene, side.body, side.other) : 0;
		turnManifold(scene, *side.interaction, side.direction, beside);
	});
}

} // namespace yade
