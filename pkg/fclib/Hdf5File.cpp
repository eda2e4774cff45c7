// SPDX-License-Identifier: GPL-2.0-or-later
#include "Hdf5File.hpp"

#include <filesystem>
#include <fstream>
#include <hdf5.h>
#include <hdf5_hl.h>
#include <limits>
#include <type_traits>

namespace contactdynamics::fclib {

static_assert(std::is_same_v<hid_t, std::int64_t>, "the header spares its users HDF5's own");

namespace {

/// Closes what H5…open returned.
class Handle {
public:
	Handle(hid_t opened, herr_t (*closeWith)(hid_t)) : id(opened), close(closeWith) {}
	~Handle()
	{
		if (id >= 0) close(id);
	}
	Handle(const Handle&) = delete;
	Handle& operator=(const Handle&) = delete;
	operator hid_t() const { return id; }

private:
	hid_t id;
	herr_t (*close)(hid_t);
};

template <class Value> std::vector<Value> numbers(const Hdf5File& owner, hid_t file, const std::string& name, H5T_class_t kind, hid_t type)
{
	const std::int64_t count = owner.entries(name);
	const Handle data(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose), stored(H5Dget_type(data), H5Tclose);
	const H5T_class_t found = H5Tget_class(stored);
	if (found != kind && !(kind == H5T_FLOAT && found == H5T_INTEGER))
		owner.refuse(name, kind == H5T_INTEGER ? "does not hold integers" : "does not hold numbers");
	if (count > std::numeric_limits<int>::max()) owner.refuse(name, "has " + std::to_string(count) + " entries, more than FCLIB can count");
	std::vector<Value> values(static_cast<std::size_t>(count));
	if (count > 0 && H5Dread(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
		owner.refuse(name, "cannot be read; the file is cut short or damaged");
	return values;
}

} // namespace

Hdf5File::Hdf5File(const std::string& pathOfFile) : path(pathOfFile), file(-1)
{
	H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); // the exception says it; HDF5 would print a page
	std::error_code ignored;
	if (!std::filesystem::exists(path, ignored)) throw FileError(path + ": there is no such file");
	if (std::filesystem::is_directory(path, ignored)) throw FileError(path + ": is a folder, not a file");
	if (!std::ifstream(path)) throw FileError(path + ": may not be read");
	if (H5Fis_hdf5(path.c_str()) <= 0) throw FileError(path + ": is not an HDF5 file, so it has neither /fclib_local nor /fclib_global");
	file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
	if (file < 0) throw FileError(path + ": is an HDF5 file cut short or damaged; neither /fclib_local nor /fclib_global can be reached");
}

Hdf5File::~Hdf5File()
{
	if (file >= 0) H5Fclose(file);
}

void Hdf5File::refuse(const std::string& name, const std::string& what) const { throw FileError(path + ": dataset " + name + " " + what); }

bool Hdf5File::has(const std::string& name) const { return H5LTpath_valid(file, name.c_str(), true) > 0; }

bool Hdf5File::hasGroup(const std::string& name) const
{
	if (!has(name)) return false;
	const Handle object(H5Oopen(file, name.c_str(), H5P_DEFAULT), H5Oclose);
	return H5Iget_type(object) == H5I_GROUP;
}

std::int64_t Hdf5File::entries(const std::string& name) const
{
	if (!has(name)) refuse(name, "is missing");
	const Handle data(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
	if (data < 0) refuse(name, "is not a dataset, or is damaged");
	const Handle space(H5Dget_space(data), H5Sclose);
	const hssize_t count = H5Sget_simple_extent_npoints(space);
	if (count < 0) refuse(name, "has no size; the file is damaged");
	return count;
}

std::vector<int> Hdf5File::integers(const std::string& name) const { return numbers<int>(*this, file, name, H5T_INTEGER, H5T_NATIVE_INT); }

std::vector<double> Hdf5File::reals(const std::string& name) const { return numbers<double>(*this, file, name, H5T_FLOAT, H5T_NATIVE_DOUBLE); }

int Hdf5File::integer(const std::string& name) const
{
	if (entries(name) != 1) refuse(name, "has " + std::to_string(entries(name)) + " entries, must have 1");
	return integers(name).front();
}

std::string Hdf5File::text(const std::string& name) const
{
	if (entries(name) != 1) refuse(name, "has " + std::to_string(entries(name)) + " entries, must have 1");
	const Handle data(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose), type(H5Dget_type(data), H5Tclose);
	if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0) return {}; // no string that libfclib could read either
	std::string value(H5Tget_size(type), '\0');
	if (H5Dread(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, value.data()) < 0) refuse(name, "cannot be read; the file is damaged");
	return value.substr(0, value.find('\0'));
}

} // namespace contactdynamics::fclib
