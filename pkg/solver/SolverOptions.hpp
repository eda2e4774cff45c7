// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

namespace contactdynamics {

/// What is done between two sweeps of the Signorini-Coulomb loop.
enum class Acceleration {
	none,	 ///< plain nonlinear block Gauss-Seidel, section 5.4 of Jean (1999)
	momentum ///< momentum on the sweep with restart and safeguard, see Accelerator.hpp
};

struct SolverOptions {
	double tolerance = 1e-4;  ///< bound on SolveReport::residual [-]; 1e-3 quasi-static flow, 1e-4 default, 1e-8 to 1e-12 verification; > 0
	int maxIterations = 1000; ///< sweeps over the contacts; 0 only evaluates the residual of the impulses handed over
	Acceleration acceleration = Acceleration::momentum;
	/// Newton steps and central path where the sweeps stall, see BlockSolver.hpp: explicit block problems only, and not with Acceleration::none.
	bool newtonFinish = true;
	int threads = 1; ///< threads, >= 1 (the caller is one of them); the result does not depend on it, bit for bit. Block problems take one.
};

/// @throws std::invalid_argument  naming the option and its value
void requireOptions(const SolverOptions& options);

} // namespace contactdynamics
