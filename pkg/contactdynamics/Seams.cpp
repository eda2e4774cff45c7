// SPDX-License-Identifier: GPL-2.0-or-later
#include "Seams.hpp"
#include <algorithm>
#include <cmath>

namespace yade {
namespace {
using Role = SurfaceContact::Role;

Vector3r nearestPoint(const SurfaceContact& contact, Real radius) { return -(radius + contact.gap) * contact.normal; }

/// Whether `one` belongs to what `other`, a contact of the same sphere, already gives.
bool doubles(const SurfaceContact& one, const SurfaceContact& other, Real radius)
{
	const Vector3r point = nearestPoint(one, radius), otherPoint = nearestPoint(other, radius);
	const Real size = std::max({point.norm(), one.surface.size(), other.surface.size()});
	const Real close = seamCloseness(size, radius);
	if (!other.surface.mayBeWithin(point, close)) return false;
	if ((other.surface.nearest(point) - point).norm() > close) return false;
	if ((one.surface.nearest(otherPoint) - otherPoint).norm() > close) return true;
	// Each of the two lies on the other surface: the nearer one stays, or the one with the smaller id if they differ by round-off only.
	if ((otherPoint - point).norm() <= 1e-8 * size) return other.body < one.body;
	return (point - otherPoint).dot(point + otherPoint) > 0;
}

/// Whether a sphere that stays in front of the tangent plane of `front` stays off `surface`.
bool isBehind(const Surface& surface, const SurfaceContact& front, Real radius)
{
	const Real plane = -(radius + front.gap);
	return surface.extent(front.normal) <= plane + seamCloseness(surface.size(), radius);
}

/// The plane of the facet beyond the edge that is nearest, if it separates facet and sphere, but for an overlap of the sphere that is there anyway.
bool takeFace(SurfaceContact& contact, Real radius, Real overlap)
{
	const Vector3r point = nearestPoint(contact, radius);
	if (!contact.surface.isFacet() || !contact.surface.insideEdge(point, seamCloseness(contact.surface.size(), radius))) return false;
	Vector3r normal = contact.surface.faceNormal();
	if (normal.dot(point) > 0) normal = -normal;
	const Real gap = -normal.dot(point) - radius;
	if (!(gap >= -overlap)) return false;
	contact.normal = normal;
	contact.gap = gap;
	return true;
}

/// Where a sphere that moves by `way` relative to the surface strikes it: the tangent plane there. The distance is a convex function of
/// the time, so Newton's iteration comes to the first contact from one side.
bool takeStrike(SurfaceContact& contact, Real radius, const Vector3r& way)
{
	constexpr int limit = 30;		  // quadratic convergence; a grazing strike, which is slower, may be missed by 2^-30 of the way
	const Real exact = 1e-6 * radius; // the tangent plane of this moment separates, too
	Real time = 0;
	for (int iteration = 0; iteration < limit; iteration++) {
		const Vector3r apart = time * way - contact.surface.nearest(time * way);
		const Real distance = apart.norm();
		if (!(distance > 0)) return false;
		const Real gap = distance - radius, rate = apart.dot(way) / distance;
		if (gap <= exact) {
			contact.normal = apart / distance;
			contact.gap = contact.normal.dot(apart - time * way) - radius; // from the centre's place at the start of the step
			return true;
		}
		if (!(rate < 0)) return false;
		time -= gap / rate;
		if (!(time <= 1)) return false;
	}
	return false;
}

/// The displacement nearest to `advance` that crosses none of the planes (Hildreth's method; few planes, so convergence is no concern).
Vector3r admitted(const Vector3r& advance, const std::vector<SurfaceContact>& contacts, Real radius)
{
	constexpr int sweeps = 100;
	Vector3r way = advance;
	std::vector<Real> pushes(contacts.size(), 0);
	for (int sweep = 0; sweep < sweeps; sweep++) {
		Real largest = 0;
		for (std::size_t i = 0; i < contacts.size(); i++) {
			const SurfaceContact& contact = contacts[i];
			if (contact.role == Role::left) continue;
			const Real missing = -std::max(Real(0), contact.gap) - contact.normal.dot(way - contact.advance);
			const Real push = std::max(Real(0), pushes[i] + missing);
			way += (push - pushes[i]) * contact.normal;
			largest = std::max(largest, std::abs(push - pushes[i]));
			pushes[i] = push;
		}
		if (largest <= 1e-9 * radius) break;
	}
	return way;
}
} // namespace

Real seamCloseness(Real size, Real radius) { return std::max(1e-8 * size, std::min(1e-6 * size, 1e-4 * radius)); }

void settleSeams(Real radius, const Vector3r& advance, std::vector<SurfaceContact>& contacts)
{
	std::vector<SurfaceContact*> open; // doubled, and not behind a contact that stays
	for (SurfaceContact& one : contacts) {
		const bool isDoubled = std::any_of(contacts.begin(), contacts.end(),
										   [&](const SurfaceContact& other) { return &other != &one && doubles(one, other, radius); });
		if (isDoubled) open.push_back(&one);
	}
	if (open.size() == contacts.size()) { // round-off made a circle of them: the nearest stays
		const auto nearest = std::min_element(contacts.begin(), contacts.end(), [](const auto& a, const auto& b) { return a.gap < b.gap; });
		open.erase(open.begin() + (nearest - contacts.begin()));
	}
	for (SurfaceContact* one : open) one->role = Role::left;
	const auto covered = [&](const SurfaceContact* one) {
		return std::any_of(contacts.begin(), contacts.end(),
						   [&](const SurfaceContact& front) { return front.role == Role::kept && isBehind(one->surface, front, radius); });
	};
	open.erase(std::remove_if(open.begin(), open.end(), covered), open.end());

	// Each round adds at least one plane; a sphere meets only a few surfaces in earnest in a step.
	constexpr int rounds = 10;
	Real overlap = 0;
	for (const SurfaceContact& one : contacts)
		if (one.role == Role::kept) overlap = std::max(overlap, -one.gap);
	for (SurfaceContact* one : open)
		if (takeFace(*one, radius, overlap)) one->role = Role::replaced;
	for (int round = 0; round < rounds && !open.empty(); round++) {
		open.erase(std::remove_if(open.begin(), open.end(), [](const SurfaceContact* one) { return one->role != Role::left; }), open.end());
		const Vector3r way = admitted(advance, contacts, radius);
		bool struck = false;
		for (SurfaceContact* one : open) {
			if (!takeStrike(*one, radius, way - one->advance)) continue;
			one->role = Role::replaced;
			struck = true;
		}
		if (!struck) break;
	}
}

} // namespace yade
