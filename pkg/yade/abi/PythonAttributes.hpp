// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <lib/serialization/Serializable.hpp>

#include <boost/python/raw_function.hpp>

#include <type_traits>

namespace yade::abi {

/// Types that Python sees in place, so that `state.vel[0] = 1` acts on the object. All others are copied, as in YADE.
template <class T> constexpr bool seenInPlace = std::is_same_v<T, Vector3r> || std::is_same_v<T, Vector3i> || std::is_same_v<T, Vector2r> ||
												std::is_same_v<T, Vector2i> || std::is_same_v<T, Quaternionr> || std::is_same_v<T, Matrix3r>;

template <class T> void assign(T& attribute, const py::object& value)
{
	py::extract<T> converted(value);
	attribute = converted(); // throws TypeError, before the assignment, if Python's value is of another type
}

/// Defines the Python property of one attribute, after the rules of YADE for its flags and type.
template <class Class, class PyClass, class T>
void defineAttribute(PyClass& pyClass, const char* name, T Class::*member, int flags, std::string documentation)
{
	if (flags & Attr::hidden) return;
	documentation += " :yattrflags:`" + std::to_string(flags) + "` ";

	py::object getter;
	if constexpr (seenInPlace<T>)
		getter = py::make_getter(member);
	else
		getter = py::make_getter(member, py::return_value_policy<py::return_by_value>());

	if (flags & Attr::readonly) {
		pyClass.add_property(name, getter, documentation.c_str());
		return;
	}
	const bool callsPostLoad = flags & Attr::triggerPostLoad;
	const auto set = [member, callsPostLoad](Class& object, const T& value) {
		object.*member = value;
		if (callsPostLoad) object.callPostLoad();
	};
	const auto setter = py::make_function(set, py::default_call_policies(), boost::mpl::vector<void, Class&, const T&>());
	pyClass.add_property(name, getter, setter, documentation.c_str());
}

/// Python's constructor of every class: attributes by keyword, nothing by position unless the class takes it.
template <class Class> shared_ptr<Class> constructFromKeywords(py::tuple arguments, py::dict keywords)
{
	const shared_ptr<Class> instance(new Class);
	instance->pyHandleCustomCtorArgs(arguments, keywords);
	if (py::len(arguments) > 0)
		throw std::runtime_error(instance->getClassName() + ": " + std::to_string(py::len(arguments)) +
								 " positional argument(s) given, none allowed; write attributes as keyword=value.");
	if (py::len(keywords) > 0) instance->pyUpdateAttrs(keywords);
	return instance;
}

template <class Class> py::object pythonConstructor()
{
	const py::object construct = py::make_constructor(&constructFromKeywords<Class>);
	const auto dispatch = [construct](const py::tuple& selfAndArguments, const py::dict& keywords) -> py::object {
		return construct(py::object(selfAndArguments[0]), py::tuple(selfAndArguments.slice(1, py::_)), keywords);
	};
	return py::raw_function(dispatch, 1);
}

} // namespace yade::abi
