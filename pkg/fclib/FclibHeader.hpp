// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

// Version 3.1.0 does not say that it is C.
extern "C" {
#include <fclib.h>
}
