// SPDX-License-Identifier: GPL-2.0-or-later
#include "Bo1_Facet_Aabb_Proximity.hpp"

namespace yade {

YADE_PLUGIN((Bo1_Facet_Aabb_Proximity));

} // namespace yade
