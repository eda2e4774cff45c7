// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/archive/xml_iarchive.hpp>
#include <boost/archive/xml_oarchive.hpp>
#include <boost/archive/detail/iserializer.hpp>
#include <boost/archive/detail/oserializer.hpp>
#include <boost/serialization/export.hpp>
#include <boost/version.hpp>

#if BOOST_VERSION != 107400
#error "Debian's YADE is compiled with Boost 1.74, whose serialisers and Python classes the plugin shares: use the headers of the same version."
#endif

// How a class of stock YADE is declared here. Everything these macros declare is defined in YADE's libraries: our own code never emits it.

/// In the body of every stock class that can be saved and seen from Python.
#define YADE_STOCK_SERIALIZABLE(Class)                                                                                                               \
public:                                                                                                                                              \
	~Class() override;                                                                                                                               \
	std::string getClassName() const override;                                                                                                       \
	std::string getBaseClassName(unsigned int which = 0) const override;                                                                             \
	int getBaseClassNumber() const override;                                                                                                         \
	void pySetAttr(const std::string& key, const ::boost::python::object& value) override;                                                           \
	::boost::python::dict pyDict() const override;                                                                                                   \
	void callPostLoad() override;                                                                                                                    \
	void pyRegisterClass(::boost::python::object scope) override;                                                                                    \
	template <class Archive> void serialize(Archive& archive, unsigned int version);

/// In addition, for a class that multiple dispatch knows by its index. Order matters here and in the next one: these functions come from the second
/// base class, so their first override in the root of a family takes new places in its table of virtual functions.
#define YADE_STOCK_INDEXABLE(Class)                                                                                                                  \
protected:                                                                                                                                           \
	int& modifyClassIndex() override;                                                                                                                \
                                                                                                                                                     \
public:                                                                                                                                              \
	const int& getClassIndex() const override;                                                                                                       \
	const int& getBaseClassIndex(int depth) const override;

/// In addition, for the root of a family of indexed classes (Shape, Material, State, Bound, IGeom, IPhys).
#define YADE_STOCK_INDEX_ROOT(Class)                                                                                                                 \
	YADE_STOCK_INDEXABLE(Class)                                                                                                                      \
	const int& getMaxCurrentlyUsedClassIndexOfKin() const override;                                                                                  \
                                                                                                                                                     \
protected:                                                                                                                                           \
	void incrementMaxCurrentlyUsedClassIndexOfKin() override;                                                                                        \
                                                                                                                                                     \
public:

#define YADE_STOCK_SERIALIZERS_FOR(Class, Input, Output)                                                                                             \
	extern template class boost::archive::detail::iserializer<boost::archive::Input, yade::Class>;                                                   \
	extern template class boost::archive::detail::oserializer<boost::archive::Output, yade::Class>;

/// Outside of all namespaces, for a stock class that a class of ours derives from or holds as a saved attribute: its serialisers live in YADE's
/// libraries. (Writing them again would work too, but then two texts would have to agree on every saved attribute of YADE.)
#define YADE_STOCK_SERIALIZERS(Class)                                                                                                                \
	BOOST_CLASS_EXPORT_KEY(yade::Class)                                                                                                              \
	YADE_STOCK_SERIALIZERS_FOR(Class, binary_iarchive, binary_oarchive)                                                                              \
	YADE_STOCK_SERIALIZERS_FOR(Class, xml_iarchive, xml_oarchive)
