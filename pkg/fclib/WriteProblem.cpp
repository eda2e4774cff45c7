// SPDX-License-Identifier: GPL-2.0-or-later
#include "FclibHeader.hpp"
#include "Problem.hpp"
#include "Reduction.hpp"

#include <filesystem>
#include <fstream>

namespace contactdynamics::fclib {

void writeProblem(const std::string& path, const Problem& problem)
{
	// libfclib adds to a file that is there, and ends the program when it cannot make one.
	std::error_code ignored;
	std::filesystem::remove(path, ignored);
	if (!std::ofstream(path, std::ios::binary)) throw FileError(path + ": cannot be written");
	std::filesystem::remove(path, ignored);

	BlockProblem copy = problem.local; // libfclib takes no pointers to constants
	Sparse W = matrixOf(copy);
	W.makeCompressed();
	const int rows = int(W.rows());
	fclib_matrix matrix{int(W.nonZeros()), rows, rows, W.outerIndexPtr(), W.innerIndexPtr(), W.valuePtr(), -1, nullptr};
	std::string title = problem.title.empty() ? problem.name : problem.title;
	std::string description = "Written by Contact Dynamics for YADE, with the solution found; components N, T1, T2 (2D: N, T).";
	fclib_info info{title.data(), description.data(), nullptr};
	fclib_local local{&matrix, nullptr, nullptr, copy.friction.data(), copy.q.data(), nullptr, copy.dimension, &info};
	fclib_solution solution{nullptr, copy.velocity.data(), copy.impulse.data(), nullptr};
	if (!fclib_write_local(&local, path.c_str()) || !fclib_write_solution(&solution, path.c_str()))
		throw FileError(path + ": libfclib could not write /fclib_local and /solution");
}

} // namespace contactdynamics::fclib
