// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cstddef>

// `offsetof` in a class with virtual functions is what GCC and Clang support and the standard leaves open.
#pragma GCC diagnostic ignored "-Winvalid-offsetof"

namespace yade::abi {

/// Its own member stands where the members of any class derived from Class begin.
template <class Class> struct Derived : Class {
	char first;
};

} // namespace yade::abi

/// A class of `size` bytes whose last member ends at byte `dataSize`: a derived class uses the padding behind it.
#define STOCK_CLASS(Class, size, dataSize)                                                                                                           \
	static_assert(sizeof(Class) == size && alignof(Class) == 8, "size of " #Class);                                                                  \
	static_assert(offsetof(abi::Derived<Class>, first) == dataSize, "data size of " #Class);
#define STOCK_MEMBER(Class, member, offset) static_assert(offsetof(Class, member) == offset, #Class "::" #member);
