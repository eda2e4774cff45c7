// SPDX-License-Identifier: GPL-2.0-or-later
#include "CheckFile.hpp"

#include <cmath>

namespace contactdynamics::fclib {

namespace {

struct Shape {
	int rows, columns;
};

void requireEntries(const Hdf5File& file, const std::string& name, std::int64_t expected, const std::string& because)
{
	const std::int64_t found = file.entries(name);
	if (found != expected)
		file.refuse(name, "has " + std::to_string(found) + " entries, must have " + std::to_string(expected) + " (" + because + ")");
}

void requireVector(const Hdf5File& file, const std::string& name, std::int64_t expected, const std::string& because, bool negativeAllowed = true)
{
	requireEntries(file, name, expected, because);
	const std::vector<double> values = file.reals(name);
	for (std::size_t k = 0; k < values.size(); ++k) {
		if (!std::isfinite(values[k])) file.refuse(name, "is " + std::to_string(values[k]) + " at entry " + std::to_string(k) + ", must be finite");
		if (values[k] < 0 && !negativeAllowed)
			file.refuse(name, "is " + std::to_string(values[k]) + " at entry " + std::to_string(k) + ", must not be negative");
	}
}

void requireIndices(const Hdf5File& file, const std::string& name, int below)
{
	const std::vector<int> values = file.integers(name);
	for (std::size_t k = 0; k < values.size(); ++k)
		if (values[k] < 0 || values[k] >= below)
			file.refuse(name,
						"is " + std::to_string(values[k]) + " at entry " + std::to_string(k) + ", must be in 0 ... " + std::to_string(below - 1));
}

void requireStarts(const Hdf5File& file, const std::string& name, int lines, int capacity)
{
	requireEntries(file, name, std::int64_t(lines) + 1, "one more than the lines of the compressed matrix");
	const std::vector<int> starts = file.integers(name);
	if (starts.front() != 0) file.refuse(name, "starts with " + std::to_string(starts.front()) + ", must start with 0");
	for (std::size_t k = 1; k < starts.size(); ++k)
		if (starts[k] < starts[k - 1]) file.refuse(name, "decreases at entry " + std::to_string(k));
	if (starts.back() > capacity) file.refuse(name, "ends with " + std::to_string(starts.back()) + ", more than nzmax = " + std::to_string(capacity));
}

Shape requireMatrix(const Hdf5File& file, const std::string& name)
{
	const int capacity = file.integer(name + "/nzmax"), rows = file.integer(name + "/m"), columns = file.integer(name + "/n");
	const int format = file.integer(name + "/nz");
	if (rows < 0) file.refuse(name + "/m", "is " + std::to_string(rows) + ", must not be negative");
	if (columns < 0) file.refuse(name + "/n", "is " + std::to_string(columns) + ", must not be negative");
	if (capacity < 0) file.refuse(name + "/nzmax", "is " + std::to_string(capacity) + ", must not be negative");
	if (format < -2) file.refuse(name + "/nz", "is " + std::to_string(format) + ", must be -2 (rows), -1 (columns) or the number of triplets");
	if (format > capacity) file.refuse(name + "/nz", "is " + std::to_string(format) + ", more than nzmax = " + std::to_string(capacity));

	const int stored = format >= 0 ? format : capacity;
	const std::string because = format >= 0 ? "nz" : "nzmax";
	requireEntries(file, name + "/i", stored, because);
	// Some writers store the spare room of a triplet matrix, too, and libfclib has taken memory for it.
	const bool withRoom = format >= 0 && file.entries(name + "/x") == capacity;
	requireVector(file, name + "/x", withRoom ? capacity : stored, because);
	if (format >= 0) {
		requireEntries(file, name + "/p", stored, because);
		requireIndices(file, name + "/i", rows);
		requireIndices(file, name + "/p", columns);
	} else {
		requireStarts(file, name + "/p", format == -1 ? columns : rows, capacity);
		requireIndices(file, name + "/i", format == -1 ? rows : columns);
	}
	// Optional, all or none; only "conditioning" is looked for.
	if (file.has(name + "/conditioning")) {
		requireEntries(file, name + "/conditioning", 1, "a single number");
		requireEntries(file, name + "/determinant", 1, "a single number");
		requireEntries(file, name + "/rank", 1, "a single number");
		if (file.has(name + "/comment")) file.text(name + "/comment");
	}
	return {rows, columns};
}

void requireSize(const Hdf5File& file, const std::string& name, int found, int expected, const std::string& because)
{
	if (found != expected) file.refuse(name, "is " + std::to_string(found) + ", must be " + std::to_string(expected) + " (" + because + ")");
}

Shape requireSquare(const Hdf5File& file, const std::string& name)
{
	const Shape shape = requireMatrix(file, name);
	requireSize(file, name + "/n", shape.columns, shape.rows, "the matrix is square");
	return shape;
}

/// Number of contacts of a problem with so many velocity components.
int contactsOf(const Hdf5File& file, const std::string& root, int components, const std::string& nameOfComponents)
{
	const int dimension = file.integer(root + "/spacedim");
	if (dimension != 2 && dimension != 3) file.refuse(root + "/spacedim", "is " + std::to_string(dimension) + ", must be 2 or 3");
	if (components % dimension != 0)
		file.refuse(nameOfComponents, "is " + std::to_string(components) + ", must be a multiple of spacedim = " + std::to_string(dimension));
	return components / dimension;
}

void requireLocal(const Hdf5File& file)
{
	const std::string root = "/fclib_local", vectors = root + "/vectors";
	const int components = requireSquare(file, root + "/W").rows;
	const int contacts = contactsOf(file, root, components, root + "/W/m");
	requireVector(file, vectors + "/q", components, "the rows of W");
	requireVector(file, vectors + "/mu", contacts, "one for each contact", false);
	if (!file.has(root + "/V") && !file.has(root + "/R")) return;
	const Shape V = requireMatrix(file, root + "/V");
	requireSize(file, root + "/V/m", V.rows, components, "the rows of W");
	requireSize(file, root + "/R/m", requireSquare(file, root + "/R").rows, V.columns, "the columns of V");
	requireVector(file, vectors + "/s", V.columns, "the columns of V");
}

void requireGlobal(const Hdf5File& file)
{
	const std::string root = "/fclib_global", vectors = root + "/vectors";
	const int unknowns = requireSquare(file, root + "/M").rows;
	const Shape H = requireMatrix(file, root + "/H");
	requireSize(file, root + "/H/m", H.rows, unknowns, "the rows of M");
	const int contacts = contactsOf(file, root, H.columns, root + "/H/n");
	requireVector(file, vectors + "/f", unknowns, "the rows of M");
	requireVector(file, vectors + "/w", H.columns, "the columns of H");
	requireVector(file, vectors + "/mu", contacts, "one for each contact", false);
	if (!file.has(root + "/G")) return;
	const Shape G = requireMatrix(file, root + "/G");
	requireSize(file, root + "/G/m", G.rows, unknowns, "the rows of M");
	requireVector(file, vectors + "/b", G.columns, "the columns of G");
}

} // namespace

Form requireProblem(const Hdf5File& file)
{
	const bool global = file.has("/fclib_global");
	if (!global && !file.has("/fclib_local")) {
		if (file.has("/fclib_global_rolling")) file.refuse("/fclib_global_rolling", "is a problem with rolling friction, which is not supported");
		file.refuse("/fclib_local", "is missing, and so is /fclib_global: this is no FCLIB file");
	}
	const std::string root = global ? "/fclib_global" : "/fclib_local";
	if (!file.hasGroup(root)) file.refuse(root, "must be a group");
	global ? requireGlobal(file) : requireLocal(file);
	if (file.has(root + "/info")) {
		if (!file.hasGroup(root + "/info")) file.refuse(root + "/info", "must be a group");
		for (const char* name : {"/title", "/description", "/math_info"})
			if (file.has(root + "/info" + name)) file.text(root + "/info" + name);
	}
	return global ? Form::global : Form::local;
}

bool requireSolution(const Hdf5File& file, Form form)
{
	if (!file.has("/solution")) return false;
	const std::string root = form == Form::global ? "/fclib_global" : "/fclib_local", constraints = root + (form == Form::global ? "/G" : "/R");
	const int components = file.integer(root + (form == Form::global ? "/H/n" : "/W/n"));
	requireVector(file, "/solution/r", components, "the components of the problem");
	requireVector(file, "/solution/u", components, "the components of the problem");
	if (form == Form::global) requireVector(file, "/solution/v", file.integer(root + "/M/n"), "the rows of M");
	if (file.has(constraints)) requireVector(file, "/solution/l", file.integer(constraints + "/n"), "the equality constraints");
	return true;
}

} // namespace contactdynamics::fclib
