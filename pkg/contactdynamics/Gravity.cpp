// SPDX-License-Identifier: GPL-2.0-or-later
#include "Gravity.hpp"
#include <core/Scene.hpp>
#include <pkg/dem/NewtonIntegrator.hpp>

namespace yade {

Vector3r gravityOf(const Scene& scene)
{
	Vector3r gravity = Vector3r::Zero();
	for (const auto& engine : scene.engines)
		if (const auto* newton = dynamic_cast<const NewtonIntegrator*>(engine.get()); newton && !newton->dead) gravity = newton->gravity;
	return gravity;
}

} // namespace yade
