// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cstddef>

namespace yade::abi {

/// Storage of stock members that we do not name: the bytes from offset `from` up to, not including, offset `to` of the class it stands in.
/// A member and not padding, because derived classes reuse the tail padding of their base: it has to end where the last stock member ends.
/// Never read or written by us; created and destroyed by YADE's own constructors and destructors.
template <std::size_t from, std::size_t to> struct Opaque {
	static_assert(from < to);
	unsigned char bytes[to - from];
};

struct PrivateMembers; ///< the check of the layout looks at these, too: LayoutOfCore.cpp

} // namespace yade::abi
