// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <lib/base/Math.hpp>
#include <array>
#include <vector>

namespace yade {

/// Contact of a sphere with a facet, everything relative to the sphere's centre.
struct FacetContact {
	int sphere, facet;				 // body ids
	Vector3r onFacet;				 // nearest point of the facet [m]
	std::array<Vector3r, 3> corners; // of the facet [m]
};

/// Which contacts belong to a surface that another facet already gives: a sphere above a flat mesh touches the face below it, and the
/// edges of the neighbours only seem to touch. Taken as contacts, their tilted normals would make the sphere stumble.
///
/// The contact with facet B is doubled when its point on B lies on another facet A that the same sphere is near to, unless that point
/// is nearest on A, too, and A has the larger id (one of the facets that share a ridge or corner keeps the contact). This needs no
/// mesh topology, and convex edges, where the ridge really is nearest, stay.
/// @param contacts  all facet contacts of one sphere with one image of space; any order
/// @return one flag for each
std::vector<char> doubledFacetContacts(const std::vector<FacetContact>& contacts);

} // namespace yade
