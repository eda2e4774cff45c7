// SPDX-License-Identifier: GPL-2.0-or-later
#include "ManifoldGeom.hpp"
#include <boost/serialization/vector.hpp>

namespace yade {

YADE_PLUGIN((ManifoldGeom));

} // namespace yade
