// SPDX-License-Identifier: GPL-2.0-or-later
#include "Bo1_Proximity.hpp"
#include "Reach.hpp"
#include <core/Body.hpp>
#include <core/Bound.hpp>
#include <core/Cell.hpp>
#include <core/Scene.hpp>
#include <lib/factory/ClassFactory.hpp>

namespace yade {

void Bo1_Proximity::delegateTo(const char* stockFunctor)
{
	stock = boost::dynamic_pointer_cast<BoundFunctor>(ClassFactory::instance().createShared(stockFunctor));
}

/// YADE calls us from several threads at once, and tells us of the scene, but not the functor we hold: one of them writes, before any of them reads.
void Bo1_Proximity::showSceneToStock()
{
	if (__atomic_load_n(&stock->scene, __ATOMIC_ACQUIRE) == scene) return;
	const std::lock_guard<std::mutex> lock(showing);
	if (__atomic_load_n(&stock->scene, __ATOMIC_RELAXED) != scene) __atomic_store_n(&stock->scene, scene, __ATOMIC_RELEASE);
}

void Bo1_Proximity::bound(const shared_ptr<Shape>& shape, shared_ptr<Bound>& bound, const Se3r& se3, const Body* body)
{
	showSceneToStock();
	stock->go(shape, bound, se3, body);
}

void Bo1_Proximity::go(const shared_ptr<Shape>& shape, shared_ptr<Bound>& bound, const Se3r& se3, const Body* body)
{
	// A position that is not finite would spread through the sorted lists of the collider; the old bound (or none) does no harm, and
	// the engine names the body in the same step.
	if (!se3.position.allFinite()) return;
	this->bound(shape, bound, se3, body);
	Vector3r margin = Vector3r::Constant(Reach::ofBound(*scene, body->getId()));
	if (scene->isPeriodic && scene->cell->hasShear()) {
		// Bounds live in the unsheared cell, where a length may look longer by the inverse cosine of the skew angles.
		const Vector3r& cosine = scene->cell->getCos();
		const Real stretch = 1 / cosine[0] + 1 / cosine[1] + 1 / cosine[2] - 2;
		margin *= stretch;
	}
	bound->min -= margin;
	bound->max += margin;
}

} // namespace yade
