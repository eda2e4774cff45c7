// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <lib/base/Math.hpp>

namespace yade {

class Scene;

/// Gravity of the live NewtonIntegrator [m/s2], zero where there is none. (Of several, which ContactDynamicsEngine refuses, that of the last.)
Vector3r gravityOf(const Scene& scene);

} // namespace yade
