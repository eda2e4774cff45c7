// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "Surface.hpp"
#include <vector>

namespace yade {

/// Contact of one sphere with a surface. Points are relative to the sphere's centre, which is the origin.
struct SurfaceContact {
	Surface surface;
	int body;		  // id of the surface
	Vector3r normal;  // from the surface's nearest point to the centre, unit
	Real gap;		  // [m]
	Vector3r advance; // way of the surface at its nearest point in the coming step, without contacts [m]

	enum class Role {
		kept,	  // stays as it is
		replaced, // normal and gap are new ones
		left	  // gives nothing that the other contacts do not give
	} role = Role::kept;
};

/// The seams between facets, boxes and walls. A sphere above a flat mesh touches the face below it, and the edges of the neighbours only
/// seem to touch; taken as contacts, their tilted normals would make the sphere stumble. So the contact with surface B is *doubled* when its
/// nearest point lies on another surface A that the same sphere is near to, unless A's nearest point lies on B, too, and B is the nearer one or,
/// where both share the point of a ridge or corner, has the smaller id. This needs no topology of the mesh.
///
/// A doubled contact is left out when B lies behind the tangent plane of a contact that stays: that one keeps the sphere off B as well.
/// Otherwise the surface is hollow there, as in a drum or a hopper, and a sphere that runs along A would enter B within a step. Then B gets another
/// plane that separates it from the sphere but does not hinder the way along A: that of the face beyond the edge, or else (at corners) the tangent
/// plane at the place where the sphere would strike B on its way in this step. The way is that of a lone sphere without friction: the free
/// displacement, projected on what the planes admit.
///
/// @param radius   of the sphere [m]
/// @param advance  free displacement of its centre in the coming step [m]
/// @param contacts all surfaces that the sphere is near to, in ascending order of their ids; the result is in role, normal and gap
void settleSeams(Real radius, const Vector3r& advance, std::vector<SurfaceContact>& contacts);

/// Distance below which two points of a mesh are the same. Vertices of neighbouring facets agree to round-off only (each is stored relative
/// to its own facet's centre), and files of meshes hold single precision, which matters where edges meet in the middle of others.
/// @param size    of what is compared [m]
/// @param radius  of the body that touches the mesh [m]
Real seamCloseness(Real size, Real radius);

} // namespace yade
