// SPDX-License-Identifier: GPL-2.0-or-later

#include "LayoutProbe.hpp"
#include "HiddenMembers.hpp"

#include <lib/factory/ClassFactory.hpp>
#include <lib/factory/Factorable.hpp>

#include <boost/core/demangle.hpp>
#include <boost/python/object/function.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <malloc.h>
#include <optional>
#include <string>
#include <utility>

namespace py = boost::python;

namespace yade {
namespace {

using Member = std::pair<long, string>; ///< offset and C++ type

/// What Boost.Python keeps in the getter of a data member: the object of its function, behind the Python header; in that a table of virtual functions
/// and then the pointer to the member. These are layouts of Boost's, in the library that YADE and this plugin share.
struct GetterCall {
	const void* virtualTable;
	long offset;
};
struct GetterObject {
	PyObject header;
	const py::objects::py_function_impl_base* call;
};

/// The member behind a Python property, read from the property itself; nothing if it is not the plain getter of a data member.
std::optional<Member> memberBehind(const py::object& property)
{
	if (!PyObject_HasAttrString(property.ptr(), "fget")) return {};
	const py::object getter = property.attr("fget");
	if (std::strcmp(Py_TYPE(getter.ptr())->tp_name, "Boost.Python.function") != 0) return {};

	const auto* call = reinterpret_cast<const GetterObject*>(getter.ptr())->call;
	const std::string type = boost::core::demangle(typeid(*call).name());
	const std::string what = "boost::python::detail::member<";
	const auto from = type.find(what);
	if (from == std::string::npos) return {};
	std::size_t to = from + what.size();
	for (int depth = 1; depth > 0; ++to) depth += type[to] == '<' ? 1 : type[to] == '>' ? -1 : 0;
	return Member(reinterpret_cast<const GetterCall*>(call)->offset, type.substr(from, to - from));
}

/// Where two members differ, as "expected …, found …".
string difference(const Member& expected, const Member& found)
{
	if (expected.first != found.first) return "expected offset " + std::to_string(expected.first) + ", found offset " + std::to_string(found.first);
	return "expected " + expected.second + ", found " + found.second;
}

void compareMember(const string& className, const string& name, const py::object& pyClass, const Member& expected, py::list& disagreements)
{
	const string prefix = className + "." + name + ": ";
	const auto found = PyObject_HasAttrString(pyClass.ptr(), name.c_str()) ? memberBehind(pyClass.attr(name.c_str())) : std::nullopt;
	if (!found)
		disagreements.append(prefix + "expected a data member at offset " + std::to_string(expected.first) + ", found none of that name");
	else if (*found != expected)
		disagreements.append(prefix + difference(expected, *found));
}

/// Bytes that the heap gives for an object: as near to its size as one can ask. The heap gives some objects a little more than they need, so the
/// least of several made one after the other.
template <class Make, class Destroy> std::size_t heapBytes(Make make, Destroy destroy)
{
	constexpr int attempts = 16;
	std::array<void*, attempts> objects;
	std::size_t least = std::numeric_limits<std::size_t>::max();
	for (void*& object : objects) {
		object = make();
		least = std::min(least, malloc_usable_size(object));
	}
	for (void* const object : objects) destroy(object);
	return least;
}

void compareSize(const string& className, std::size_t expected, py::list& disagreements)
{
	// A Factorable is the first base of all these classes: its address is that of the object.
	const auto found = heapBytes([&className] { return static_cast<void*>(ClassFactory::instance().createPure(className)); },
								 [](void* object) { delete static_cast<Factorable*>(object); });
	const auto ours = heapBytes([expected] { return ::operator new(expected); }, [](void* memory) { ::operator delete(memory); });
	if (found == ours) return;
	disagreements.append(className + ": expected " + std::to_string(expected) + " bytes, which take " + std::to_string(ours) +
						 " of heap memory, found an object that takes " + std::to_string(found));
}

} // namespace

py::list layoutDisagreements(const py::dict& expected)
{
	const py::object wrapper = py::import("yade.wrapper");
	py::list disagreements;

	const py::list rows = expected.items();
	for (py::ssize_t i = 0; i < py::len(rows); ++i) {
		const string className = py::extract<string>(rows[i][0]);
		const py::object description = rows[i][1];
		if (!PyObject_HasAttrString(wrapper.ptr(), className.c_str())) {
			disagreements.append(className + ": expected a class of that name in yade.wrapper, found none");
			continue;
		}
		const py::list members(description["members"].attr("items")());
		for (py::ssize_t j = 0; j < py::len(members); ++j) {
			const py::object member = members[j][1];
			compareMember(className, py::extract<string>(members[j][0]), wrapper.attr(className.c_str()),
						  Member(py::extract<long>(member[0]), py::extract<string>(member[1])), disagreements);
		}
		if (py::dict(description).has_key("size")) compareSize(className, py::extract<std::size_t>(description["size"]), disagreements);
	}

	// The members that Python does not show are found by their distance from those it does: only sensible if these are where they should be.
	if (py::len(disagreements) == 0) compareHiddenMembers(disagreements);
	return disagreements;
}

} // namespace yade
