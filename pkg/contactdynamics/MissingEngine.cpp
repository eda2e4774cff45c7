// SPDX-License-Identifier: GPL-2.0-or-later
#include "MissingEngine.hpp"
#include "ContactDynamicsEngine.hpp"
#include <core/Scene.hpp>
#include <algorithm>
#include <iostream>

namespace yade {

void MissingEngine::lookFor(const Scene& scene)
{
	// Of all threads that come by in a step one goes on.
	if (lookedAt.load(std::memory_order_relaxed) == scene.iter || lookedAt.exchange(scene.iter) == scene.iter) return;
	const bool missing = std::none_of(scene.engines.begin(), scene.engines.end(),
									  [](const auto& engine) { return dynamic_cast<const ContactDynamicsEngine*>(engine.get()) != nullptr; });
	if (missing && !said)
		std::cerr << "WARNING: Law2_ScGeom_ContactDynamicsPhys_SignoriniCoulomb: there is no ContactDynamicsEngine in O.engines, so its contacts get "
					 "no "
					 "force and bodies pass through one another. Put one between InteractionLoop and NewtonIntegrator, or take the list that "
					 "contactdynamics.engines() returns. Said once."
				  << std::endl;
	said = missing;
}

} // namespace yade
