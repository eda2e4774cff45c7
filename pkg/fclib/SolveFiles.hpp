// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "CommandLine.hpp"

namespace contactdynamics::fclib {

/// "solve" of the command line: table on standard output, JSON and solved problems on request.
/// @return whether every file could be read, solved (converged or not) and written; what went wrong is on standard error
bool solveFiles(const Arguments& arguments);

/// "info" of the command line.
/// @return whether every file could be read
bool showFiles(const Arguments& arguments);

} // namespace contactdynamics::fclib
