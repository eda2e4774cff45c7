// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <iostream>

// YADE's own logger is Boost.Log behind a singleton of libyade. Our classes report to the user by exceptions and, rarely, a warning: for that the
// standard error stream does, and spares every source file the headers of Boost.Log.

#define DECLARE_LOGGER                                                                                                                               \
public:                                                                                                                                              \
	static_assert(true)
#define CREATE_LOGGER(Class) static_assert(true)

#define LOG_WARN(message) (std::cerr << "WARN " << __func__ << ": " << message << std::endl)
#define LOG_ERROR(message) (std::cerr << "ERROR " << __func__ << ": " << message << std::endl)
