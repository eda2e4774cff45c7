// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <lib/base/Math.hpp>

namespace yade {

/// How stock classes are laid out in what this library was compiled with. For each class a dictionary: "size" [bytes], if this library makes objects
/// of it or derives from it; and "members", from the name of a Python attribute to its offset [bytes] and the C++ type of the member.
boost::python::dict compiledLayout();

} // namespace yade
