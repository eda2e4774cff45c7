// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <core/Dispatching.hpp>

namespace yade {

/// The bound of a sphere.
class Bo1_Sphere_Aabb : public BoundFunctor {
	YADE_STOCK_SERIALIZABLE(Bo1_Sphere_Aabb)

	Real aabbEnlargeFactor; ///< relative enlargement of the radius; negative: none

	Bo1_Sphere_Aabb() = delete;
	void go(const shared_ptr<Shape>& shape, shared_ptr<Bound>& bound, const Se3r& placement, const Body* body) override;
	string get1DFunctorType1() const override;
};

} // namespace yade
