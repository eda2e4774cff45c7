// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <lib/base/Math.hpp>

namespace yade {

/// Compares the members that Python does not show as plain data with what it tells of them: on temporary objects, and on the scene. Appends one
/// sentence per disagreement.
void compareHiddenMembers(boost::python::list& disagreements);

} // namespace yade
