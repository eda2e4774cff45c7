// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <lib/base/AliasNamespaces.hpp>
#include <lib/base/Math.hpp>
#include <lib/factory/Factorable.hpp>

namespace yade {

// Hooks of a class around saving and loading. A member function of the same name, which takes the class by reference, goes before these.
template <class T> void preLoad(T&) {}
template <class T> void postLoad(T&) {}
template <class T> void preSave(T&) {}
template <class T> void postSave(T&) {}

namespace Attr {
/// Flags of an attribute, to be combined with `|`.
enum flags {
	noSave = 1,			 ///< not in archives
	readonly = 2,		 ///< Python may set it in the constructor only
	triggerPostLoad = 4, ///< assigning from Python calls postLoad
	hidden = 8,			 ///< not visible from Python, but saved
	noResize = 16		 ///< a sequence of fixed length; for the graphical inspector only
};
} // namespace Attr

/// What can be saved in archives and seen from Python.
class Serializable : public Factorable {
public:
	Serializable() {}
	~Serializable() override;

	template <class Archive> void serialize(Archive&, unsigned int) {}

	/// Assigns each item of the dictionary to the attribute of that name, then calls callPostLoad.
	void pyUpdateAttrs(const ::boost::python::dict& attributes);

	virtual void pySetAttr(const std::string& key, const ::boost::python::object& value);
	virtual ::boost::python::dict pyDict() const;
	virtual ::boost::python::dict pyDictCustom() const;
	virtual void callPostLoad();
	virtual void checkPyClassRegistersItself(const std::string& className) const;
	virtual void pyRegisterClass(::boost::python::object scope);
	virtual void pyHandleCustomCtorArgs(::boost::python::tuple& arguments, ::boost::python::dict& keywords);

	std::string getClassName() const override;
	std::string getBaseClassName(unsigned int which = 0) const override;
	int getBaseClassNumber() const override;
};

} // namespace yade

YADE_STOCK_SERIALIZERS(Serializable)

#include <abi/ClassMacros.hpp>
