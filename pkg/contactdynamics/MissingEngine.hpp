// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <atomic>

namespace yade {

class Scene;

/// Looks once a step whether O.engines has a ContactDynamicsEngine. Kept by the law, so that each scene has its own; called for each of its
/// interactions, by many threads at once.
class MissingEngine {
public:
	/// Says on standard error, once until the engine is there again, that there is none, not even a dead one: contacts of our law then get no force
	/// at all. It cannot be raised, see DeferredError: the engine that would raise it is missing.
	void lookFor(const Scene& scene);

private:
	std::atomic<long> lookedAt{-1}; // step
	bool said = false;
};

} // namespace yade
