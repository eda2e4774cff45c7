// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "CheckFile.hpp"

#include <pkg/solver/BlockProblem.hpp>

namespace contactdynamics::fclib {

/// A contact problem as FCLIB keeps it, reduced to the local form u = W r + q that the solver works on.
struct Problem {
	std::string name; ///< of the file, without folder and ending
	std::string title;
	Form form = Form::local; ///< in the file
	int unknowns = 0;		 ///< velocities v of a global problem, which the reduction has eliminated
	int constraints = 0;	 ///< equality constraints, likewise eliminated
	BlockProblem local;		 ///< impulses zero
};

/// Reads a local or global problem in two or three dimensions. Equality constraints (V, R or G) are eliminated.
/// @throws FileError  the file is missing, not HDF5, cut short, or a dataset is missing, of the wrong size, or holds an inadmissible value; the
///                    matrix to be eliminated is singular. The message names file and dataset.
Problem readProblem(const std::string& path);

/// The impulses of the solution in the file; empty when there is none. Apart from the problem, because files with a left-over solution of another
/// size are about, and their problem is none the worse for it.
/// @throws FileError  the solution does not fit the problem
std::vector<double> readSolution(const std::string& path);

/// Writes the problem in local form with impulses and velocities as its solution; an existing file is replaced.
/// @throws FileError  the file cannot be written
void writeProblem(const std::string& path, const Problem& problem);

} // namespace contactdynamics::fclib
