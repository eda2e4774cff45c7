// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/Dispatching.hpp>
#include <mutex>

namespace yade {

/// Common part of the Bo1_*_Aabb_Proximity functors: YADE's own functor for the shape computes the bound (sheared periodic cells
/// included), then the bound is enlarged by the body's reach. C++ only; YADE knows the named classes derived from it.
class Bo1_Proximity : public BoundFunctor {
public:
	void go(const shared_ptr<Shape>& shape, shared_ptr<Bound>& bound, const Se3r& se3, const Body* body) override;
	virtual ~Bo1_Proximity() = default;

protected:
	/// To be called by the constructors: name of YADE's functor for the shape.
	void delegateTo(const char* stockFunctor);
	/// The bound before it is enlarged: that of YADE's functor, unless a class knows better.
	virtual void bound(const shared_ptr<Shape>& shape, shared_ptr<Bound>& bound, const Se3r& se3, const Body* body);

private:
	void showSceneToStock();
	shared_ptr<BoundFunctor> stock;
	std::mutex showing;
};

} // namespace yade
