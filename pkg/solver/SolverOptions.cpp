// SPDX-License-Identifier: GPL-2.0-or-later
#include "SolverOptions.hpp"

#include <stdexcept>
#include <string>

namespace contactdynamics {

void requireOptions(const SolverOptions& options)
{
	if (!(options.tolerance > 0)) throw std::invalid_argument("SolverOptions::tolerance is " + std::to_string(options.tolerance) + ", must be > 0");
	if (options.maxIterations < 0)
		throw std::invalid_argument("SolverOptions::maxIterations is " + std::to_string(options.maxIterations) + ", must be >= 0");
	if (options.threads < 1) throw std::invalid_argument("SolverOptions::threads is " + std::to_string(options.threads) + ", must be >= 1");
}

} // namespace contactdynamics
