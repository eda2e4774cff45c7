// SPDX-License-Identifier: GPL-2.0-or-later

#include "LayoutProbe.hpp"
#include "LayoutTable.hpp"

#include <lib/factory/ClassFactory.hpp>
#include <lib/serialization/Serializable.hpp>
#include <core/BodyContainer.hpp>
#include <core/Omega.hpp>
#include <core/Scene.hpp>

#include <iterator>
#include <list>
#include <string>

namespace py = boost::python;

namespace yade {
namespace {

/// The names a library has announced to the class factory, taken out of it for as long as this object lives.
class SetAside {
	std::list<std::string>& place;
	std::list<std::string> names;

public:
	explicit SetAside(std::list<std::string>& place) : place(place) { names.swap(place); }
	~SetAside()
	{
		place.splice(place.end(), names);
		place.sort();
		place.unique();
	}
	SetAside(const SetAside&) = delete;
	SetAside& operator=(const SetAside&) = delete;

	std::list<std::string> unknownTo(const Omega& omega) const
	{
		const auto& known = omega.getDynlibsDescriptor();
		std::list<std::string> unknown;
		for (const std::string& name : names)
			if (known.find(name) == known.end()) unknown.push_back(name);
		return unknown;
	}
};

/// Once a body has been erased, a collider that is new in a scene that another one has seen stays without bodies, and they fall through each other.
void showBodiesToCollider() { Omega::instance().getScene()->bodies->checkedByCollider = false; }

/// Makes the classes of this library part of the running YADE, as if it had been there from the start: they appear in `yade.wrapper`, their base
/// classes are known, archives can hold them. Returns their names, also if called again.
///
/// `yade.boot.initialize` with the path of this library would do it too, but throws away all scenes and registers YADE's 370 classes again.
/// So Omega gets to see the new names only, and the old ones are put back afterwards, also when a registration throws.
py::list registerClasses()
{
	static std::list<std::string> ours;
	if (ours.empty()) {
		Omega& omega = Omega::instance();
		ClassFactory& factory = ClassFactory::instance();
		const SetAside all(factory.pluginClasses);
		factory.pluginClasses = all.unknownTo(omega);
		if (!factory.pluginClasses.empty()) omega.loadPlugins({});
		ours = factory.pluginClasses;
	}
	py::list names;
	for (const std::string& name : ours) names.append(name);
	return names;
}

} // namespace
} // namespace yade

// Python sees this as contactdynamics._plugin. Importing it changes nothing; contactdynamics._loading looks at the layout first and registers then.
BOOST_PYTHON_MODULE(_plugin)
{
	using namespace yade;
	const py::docstring_options everythingButSignatures(true, true, false);
	py::scope().attr("__doc__") = "Compiled part of contactdynamics, for contactdynamics._loading.";
	py::def("compiledLayout", &compiledLayout, "Sizes, offsets and types of members of YADE's classes that this library was compiled with.");
	py::def("layoutDisagreements", &layoutDisagreements, "Sentences on where a table like that of compiledLayout, and the running YADE, disagree.");
	py::def("showBodiesToCollider", &showBodiesToCollider,
			"Lets the next run of a collider, also of a new one, look for bodies that it does not know.");
	py::def("registerClasses", &registerClasses, "Registers this library's classes with YADE the first time, and returns their names.");
}
