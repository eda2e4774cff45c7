// SPDX-License-Identifier: GPL-2.0-or-later
#include "FacetEdges.hpp"
#include "Triangle.hpp"
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

namespace yade {
namespace {
/// Whether `one` belongs to the surface that `other`, a contact of the same sphere, already gives.
bool doubles(const FacetContact& one, const FacetContact& other)
{
	// Vertices of neighbouring facets agree to round-off only (each is stored relative to its own facet's centre): the square root
	// of the machine precision separates that from any mesh a user means.
	Real size = one.onFacet.norm();
	for (const Vector3r& corner : other.corners) size = std::max(size, corner.norm());
	const Real close = std::sqrt(std::numeric_limits<Real>::epsilon()) * size;
	if ((nearestOnTriangle(one.onFacet, other.corners[0], other.corners[1], other.corners[2]) - one.onFacet).norm() > close) return false;
	const bool sharedPoint = (other.onFacet - one.onFacet).norm() <= close;
	return sharedPoint ? other.facet < one.facet : true;
}
} // namespace

std::vector<char> doubledFacetContacts(const std::vector<FacetContact>& contacts)
{
	std::vector<std::size_t> order(contacts.size());
	std::iota(order.begin(), order.end(), 0);
	std::sort(order.begin(), order.end(), [&contacts](std::size_t a, std::size_t b) {
		return std::tie(contacts[a].sphere, contacts[a].facet) < std::tie(contacts[b].sphere, contacts[b].facet);
	});

	std::vector<char> doubled(contacts.size(), 0);
	for (std::size_t first = 0, last = 0; first < order.size(); first = last) {
		while (last < order.size() && contacts[order[last]].sphere == contacts[order[first]].sphere) last++;
		for (std::size_t b = first; b < last; b++)
			for (std::size_t a = first; a < last && !doubled[order[b]]; a++)
				if (a != b) doubled[order[b]] = doubles(contacts[order[b]], contacts[order[a]]);
	}
	return doubled;
}

} // namespace yade
