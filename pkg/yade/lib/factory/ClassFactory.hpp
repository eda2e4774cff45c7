// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <lib/base/Logging.hpp>
#include <lib/base/Math.hpp>
#include <lib/base/Singleton.hpp>

#include <abi/Opaque.hpp>
#include <abi/StockClass.hpp>

#include <boost/serialization/shared_ptr.hpp>
#include <boost/serialization/vector.hpp>

#include <boost/preprocessor/cat.hpp>
#include <boost/preprocessor/seq/for_each.hpp>
#include <boost/preprocessor/seq/seq.hpp>
#include <boost/preprocessor/stringize.hpp>

#include <list>
#include <string>

namespace yade {

class Factorable;

/// Makes instances of classes by name. Plugins enter their classes while their library is loaded.
class ClassFactory : public Singleton<ClassFactory> {
public:
	using CreateShared = shared_ptr<Factorable> (*)();
	using Create = Factorable* (*)();
	using CreatePureCustom = void* (*)();

	/// Returns false, and changes nothing, when the name is already known.
	bool registerFactorable(std::string name, Create, CreateShared, CreatePureCustom);
	/// A file name, then class names, then a null pointer; appends the class names to `pluginClasses`.
	void registerPluginClasses(const char* fileAndClasses[]);

	shared_ptr<Factorable> createShared(std::string name);
	Factorable* createPure(std::string name);

	virtual std::string getClassName() const;
	virtual std::string getBaseClassName(int) const;

private:
	ClassFactory() = delete;
	virtual ~ClassFactory();

	abi::Opaque<8, 144> libraryManagerAndCreators;

public:
	std::list<std::string> pluginClasses;
};

} // namespace yade

/// Enters `Class` into the factory when the library is loaded. In namespace yade, after the class.
#define REGISTER_FACTORABLE(Class)                                                                                                                   \
	inline const bool BOOST_PP_CAT(registered, Class) = ::yade::ClassFactory::instance().registerFactorable(                                         \
			#Class, []() -> ::yade::Factorable* { return new Class; },                                                                               \
			[]() -> ::boost::shared_ptr<::yade::Factorable> { return ::boost::shared_ptr<Class>(new Class); }, []() -> void* { return new Class; });

#define YADE_ABI_EXPORT(r, data, Class) BOOST_CLASS_EXPORT_IMPLEMENT(yade::Class)
#define YADE_ABI_QUOTED(r, data, Class) BOOST_PP_STRINGIZE(Class),

/// `YADE_PLUGIN((A)(B))`: once in a source file, in namespace yade. Makes the classes loadable from archives and announces their names.
/// It leaves the namespace and enters it again, because the archive keys have to stand outside.
#define YADE_PLUGIN(classes)                                                                                                                         \
	}                                                                                                                                                \
	BOOST_PP_SEQ_FOR_EACH(YADE_ABI_EXPORT, ~, classes)                                                                                               \
	namespace {                                                                                                                                      \
	[[maybe_unused]] const bool BOOST_PP_CAT(announced, BOOST_PP_SEQ_HEAD(classes)) = [] {                                                           \
		const char* fileAndClasses[] = {__FILE__, BOOST_PP_SEQ_FOR_EACH(YADE_ABI_QUOTED, ~, classes) nullptr};                                       \
		::yade::ClassFactory::instance().registerPluginClasses(fileAndClasses);                                                                      \
		return true;                                                                                                                                 \
	}();                                                                                                                                             \
	}                                                                                                                                                \
	namespace yade {
