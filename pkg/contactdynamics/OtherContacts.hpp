// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <lib/base/Math.hpp>

namespace yade {

class Scene;

/// Stress of the interactions of a periodic scene that Contact Dynamics does not solve, such as soft contacts beside it, as utils.getStress() defines
/// it: positive in tension, Cauchy, over the volume of the cell [Pa]. Their forces are those of this step.
Matrix3r stressOfOtherContacts(const Scene& scene);

} // namespace yade
