// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <pkg/solver/SolverOptions.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace contactdynamics::fclib {

struct Arguments {
	bool solve = true; ///< or show
	bool help = false;
	SolverOptions options;
	std::string json;	///< file for the results, empty: none
	std::string folder; ///< for the problems with their solutions, empty: none
	std::vector<std::string> files;
};

struct UsageError : std::runtime_error {
	using std::runtime_error::runtime_error;
};

/// @throws UsageError  naming the argument and what is allowed
Arguments parse(const std::vector<std::string>& words);

extern const char* const usage;

} // namespace contactdynamics::fclib
