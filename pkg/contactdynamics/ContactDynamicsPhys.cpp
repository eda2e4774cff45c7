// SPDX-License-Identifier: GPL-2.0-or-later
#include "ContactDynamicsPhys.hpp"

namespace yade {

YADE_PLUGIN((ContactDynamicsPhys));

} // namespace yade
