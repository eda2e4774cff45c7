// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <core/Shape.hpp>

namespace yade {

/// A convex polyhedron.
class Polyhedra : public Shape {
	YADE_STOCK_SERIALIZABLE(Polyhedra)
	YADE_STOCK_INDEXABLE(Polyhedra)

private:
	abi::Opaque<90, 328> hull; // a CGAL polyhedron and what follows from it; not saved

public:
	vector<Vector3r> v; ///< vertices, in the body's frame [m]
	int seed;
	Vector3r size; ///< of a random polyhedron [m]

	Polyhedra() = delete;
};

} // namespace yade
