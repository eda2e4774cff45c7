// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <core/Body.hpp>
#include <core/Shape.hpp>

namespace yade {

/// A triangle without thickness.
class Facet : public Shape {
	YADE_STOCK_SERIALIZABLE(Facet)
	YADE_STOCK_INDEXABLE(Facet)

	Vector3r ne[3];			   ///< outward normals of the edges, in the plane
	Real icr;				   ///< radius of the inscribed circle [m]
	Real vl[3];				   ///< distances of the vertices from the origin [m]
	Vector3r vu[3];			   ///< unit vectors to the vertices
	vector<Vector3r> vertices; ///< in the body's frame [m]
	Vector3r normal;		   ///< in the body's frame
	Real area;				   ///< [m²]

	Facet();
};

} // namespace yade
