// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <lib/base/Math.hpp>

namespace yade {

/// Compares a table as compiledLayout makes it, and the members that Python does not show, with the classes of the running YADE. Returns one sentence
/// per disagreement, naming class, member, what is expected and what is found; empty if all is well. Reads, and makes temporary objects; changes
/// nothing.
boost::python::list layoutDisagreements(const boost::python::dict& expected);

} // namespace yade
