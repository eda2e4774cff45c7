// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <cstdint>

namespace yade {

/// The objects of a scene lie anywhere in memory, and only a loop over them knows which one comes next: it fetches each some turns before its own,
/// and earlier still what holds the address of another. To be inlined without fail: GCC drops the call of a function that does nothing but fetch.
namespace Prefetch {
constexpr long ahead = 6, farAhead = 12;

/// The lines of the cache that hold the bytes from `first` up to, not including, `last`.
[[gnu::always_inline]] inline void between(const void* first, const void* last)
{
	constexpr std::uintptr_t line = 64;
	for (const char* at = static_cast<const char*>(first) - reinterpret_cast<std::uintptr_t>(first) % line; at < last; at += line)
		__builtin_prefetch(at);
}

/// Null is passed over.
template <class Object> [[gnu::always_inline]] inline void whole(const Object* object)
{
	if (object) between(object, object + 1);
}

/// As much as a `Likely` takes, whatever there is.
template <class Likely> [[gnu::always_inline]] inline void probably(const void* object)
{
	if (object) between(object, static_cast<const char*>(object) + sizeof(Likely));
}
} // namespace Prefetch

} // namespace yade
