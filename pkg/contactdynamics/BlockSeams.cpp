// SPDX-License-Identifier: GPL-2.0-or-later
#include "BlockSeams.hpp"
#include "Seams.hpp"
#include <pkg/geometry/PointDistance.hpp>
#include <algorithm>
#include <cstdint>
#include <limits>

namespace yade {
namespace {
using contactdynamics::ConvexShape;

/// Directions that differ by less than 10⁻⁷ are one.
bool alike(const Vector3r& one, const Vector3r& other) { return one.dot(other) > 1 - 1e-14; }

/// How far a shape reaches along a unit vector, from the origin of the caller's axes.
Real reachAlong(const ConvexShape& shape, const Matrix3r& rotation, const Vector3r& place, const Vector3r& direction)
{
	const Vector3r inside = rotation.transpose() * direction;
	Real most = -std::numeric_limits<Real>::infinity();
	for (const Vector3r& vertex : shape.vertices) most = std::max(most, inside.dot(vertex));
	return most + direction.dot(place);
}

class SeamsOfBlock {
public:
	SeamsOfBlock(const ConvexShape& block_, const Matrix3r& rotation_, std::vector<BlockContact>& contacts_)
		: block(block_), rotation(rotation_), contacts(contacts_), planes(contacts_.size()), covered(contacts_.size())
	{
		for (std::size_t i = 0; i < contacts.size(); i++) // the plane touches the surface; the gap tells where a wall is
			planes[i] = contacts[i].shape ? reachAlong(*contacts[i].shape, contacts[i].rotation, contacts[i].place, contacts[i].normal)
										  : lowestOfBlock(contacts[i].normal) - contacts[i].gap;
	}

	void settle()
	{
		for (std::size_t i = 0; i < contacts.size(); i++)
			for (std::size_t j = 0; j < contacts.size() && !covered[i]; j++) covered[i] = isBehind(i, j) && !isBehind(j, i);
		for (std::size_t i = 0; i < contacts.size(); i++) {
			if (covered[i]) takePlane(i);
			if (contacts[i].seam == BlockContact::Seam::none) takeFace(i);
		}
	}

private:
	const ConvexShape& block;
	const Matrix3r& rotation;
	std::vector<BlockContact>& contacts;
	std::vector<Real> planes; // by contact: height of its plane along its normal [m]
	std::vector<std::uint8_t> covered;

	Real lowestOfBlock(const Vector3r& normal) const { return -reachAlong(block, rotation, Vector3r::Zero(), -normal); }
	Real gapAlong(const BlockContact& contact, const Vector3r& normal) const
	{
		return lowestOfBlock(normal) - reachAlong(*contact.shape, contact.rotation, contact.place, normal);
	}
	Real closeness(const BlockContact& one, const BlockContact& other) const
	{
		const auto size = [](const BlockContact& contact) { return contact.place.norm() + (contact.shape ? contact.shape->radius : 0); };
		return seamCloseness(std::max(size(one), size(other)), block.radius);
	}

	/// Whether the surface of contact i lies behind the plane of contact j, another one than its own.
	bool isBehind(std::size_t i, std::size_t j) const
	{
		const BlockContact &one = contacts[i], &front = contacts[j];
		if (i == j || !one.shape || alike(one.normal, front.normal)) return false;
		const Real limit = planes[j] + closeness(one, front);
		return front.normal.dot(one.place) <= limit && reachAlong(*one.shape, one.rotation, one.place, front.normal) <= limit;
	}

	/// Of the planes that stay and have the surface behind them the one that parts the bodies best.
	void takePlane(std::size_t i)
	{
		Real best = -std::numeric_limits<Real>::infinity();
		for (std::size_t j = 0; j < contacts.size(); j++) {
			if (covered[j] || !isBehind(i, j)) continue;
			const Real gap = gapAlong(contacts[i], contacts[j].normal);
			if (!(gap > best)) continue;
			best = gap;
			contacts[i].direction = contacts[j].normal;
			contacts[i].seam = BlockContact::Seam::flush;
		}
	}

	void takeFace(std::size_t i)
	{
		BlockContact& contact = contacts[i];
		if (!contact.isFacet || contact.points.empty()) return;
		Vector3r normal = contact.rotation * contact.shape->faces[0].normal;
		if (normal.dot(contact.place) > 0) normal = -normal; // to the side where the block is
		if (alike(normal, contact.normal)) return;
		Real overlap = closeness(contact, contact);
		for (const BlockContact& other : contacts) overlap = std::max(overlap, -other.gap);
		if (!(gapAlong(contact, normal) >= -overlap)) return;
		for (const Vector3r& point : contact.points)
			if (!isOnAnother(i, point)) return;
		contact.direction = normal;
		contact.seam = BlockContact::Seam::hollow;
	}

	bool isOnAnother(std::size_t i, const Vector3r& point) const
	{
		static thread_local contactdynamics::PlacedShape placed;
		for (std::size_t j = 0; j < contacts.size(); j++) {
			const BlockContact& other = contacts[j];
			if (i == j || !other.shape) continue;
			const Real close = closeness(contacts[i], other);
			if ((point - other.place).norm() > other.shape->radius + close) continue;
			placed.place(*other.shape, other.rotation, other.place);
			if (contactdynamics::nearestOnSurface(placed, point).distance <= close) return true;
		}
		return false;
	}
};
} // namespace

void settleBlockSeams(const ConvexShape& block, const Matrix3r& rotation, std::vector<BlockContact>& contacts)
{
	SeamsOfBlock(block, rotation, contacts).settle();
}

} // namespace yade
