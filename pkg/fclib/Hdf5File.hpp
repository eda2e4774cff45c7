// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace contactdynamics::fclib {

/// A file that is not what it should be. The message names the file and, where one is at fault, the dataset.
struct FileError : std::runtime_error {
	using std::runtime_error::runtime_error;
};

/// An HDF5 file opened for reading, whose every failure is a FileError.
class Hdf5File {
public:
	explicit Hdf5File(const std::string& path);
	~Hdf5File();
	Hdf5File(const Hdf5File&) = delete;
	Hdf5File& operator=(const Hdf5File&) = delete;

	bool has(const std::string& name) const;
	bool hasGroup(const std::string& name) const;
	std::vector<int> integers(const std::string& name) const;
	std::vector<double> reals(const std::string& name) const;
	std::int64_t entries(const std::string& name) const;
	int integer(const std::string& name) const; ///< of a dataset with one entry
	std::string text(const std::string& name) const;

	[[noreturn]] void refuse(const std::string& name, const std::string& what) const;

private:
	std::string path;
	std::int64_t file;
};

} // namespace contactdynamics::fclib
