// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <pkg/dem/ScGeom.hpp>

namespace yade {

class ManifoldGeom : public ScGeom {
public:
	virtual ~ManifoldGeom() = default;
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR(ManifoldGeom,ScGeom,
		"Contact of two convex bodies over a face, an edge or a corner: one direction and as many points as the shared part needs. For two faces these are the corners of the polygon they share, for an edge its ends. "
		"As a :yref:`ScGeom`: :yref:`normal<GenericSpheresContact.normal>` from body 1 to body 2 is that of all points, :yref:`penetrationDepth<ScGeom.penetrationDepth>` is minus the smallest gap (the signed distance of the bodies), "
		":yref:`contactPoint<GenericSpheresContact.contactPoint>` the mean of the points, after a step weighted with their normal forces, and :yref:`refR1<GenericSpheresContact.refR1>`, :yref:`refR2<GenericSpheresContact.refR2>` its distances from the two bodies' positions "
		"(for walls and facets that of the other body). So functions that read one force at one point per contact get resultant and moment of the normal forces right. Shear increments of soft contact laws are not computed.",
		((std::vector<Vector3r>,points,,Attr::readonly,"Points of the contact, in the middle of gap or overlap, global axes [m]. None if the bodies are apart beside each other."))
		((std::vector<Real>,gaps,,Attr::readonly,"Gap at each point along the normal [m]; negative where the bodies overlap. Points whose gap exceeds what the bodies may close in the coming step are left out."))
		((std::vector<int>,features,,Attr::readonly,"What makes each point, by which it is recognised in the next step [-]: number of a vertex of body 1; 2²⁸ plus number of a vertex of body 2; or 2·2²⁸ plus 2¹⁴ times number of an edge of body 1 plus number of an edge of body 2, where these cross. "
			"For bodies of the same shape class, those of smaller and larger id take the places of body 1 and 2."))
		((Vector3i,deciding,Vector3i(0,-1,-1),(Attr::readonly|Attr::hidden),"Feature that gave the direction, see DecidingFeature; kept while no other one is clearly better."))
		,
		createIndex();
	);
	// clang-format on
	REGISTER_CLASS_INDEX(ManifoldGeom, ScGeom);
};
REGISTER_SERIALIZABLE(ManifoldGeom);

} // namespace yade
