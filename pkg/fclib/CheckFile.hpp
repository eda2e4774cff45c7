// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "Hdf5File.hpp"

namespace contactdynamics::fclib {

enum class Form {
	local, ///< u = W r + q [+ V l]
	global ///< M v = H r + f [+ G l], u = H^T v + w
};

/// Makes sure that libfclib can read the problem of a file: it ends the program when a dataset is missing, and writes past its memory when one is
/// longer than the others say. All numbers are looked at, too: indices in range, values finite, friction not negative.
/// @throws FileError  naming the dataset and what is wrong with it
Form requireProblem(const Hdf5File& file);

/// Whether the file holds a solution that libfclib can read.
/// @throws FileError  it holds one that does not fit the problem
bool requireSolution(const Hdf5File& file, Form form);

} // namespace contactdynamics::fclib
