// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <abi/PythonAttributes.hpp>

#include <boost/preprocessor/control/expr_if.hpp>
#include <boost/preprocessor/punctuation/comma_if.hpp>
#include <boost/preprocessor/seq/for_each.hpp>
#include <boost/preprocessor/seq/for_each_i.hpp>
#include <boost/preprocessor/seq/size.hpp>
#include <boost/preprocessor/stringize.hpp>
#include <boost/preprocessor/tuple/elem.hpp>

// The macros by which a class of YADE declares its attributes. An attribute is a tuple (type, name, default, flags, documentation); `default` and
// `flags` may be empty. The macros only spread the names; what happens to an attribute is written in PythonAttributes.hpp.

// clang-format off: it aligns the continued strings and lists of these macros beyond recognition

#define YADE_ABI_TYPE(attribute) BOOST_PP_TUPLE_ELEM(5, 0, attribute)
#define YADE_ABI_NAME(attribute) BOOST_PP_TUPLE_ELEM(5, 1, attribute)
#define YADE_ABI_DEFAULT(attribute) BOOST_PP_TUPLE_ELEM(5, 2, attribute)
#define YADE_ABI_FLAGS(attribute) (BOOST_PP_TUPLE_ELEM(5, 3, attribute) + 0)
#define YADE_ABI_DOC(attribute)                                                                                                                      \
	BOOST_PP_TUPLE_ELEM(5, 4, attribute)                                                                                                             \
	" :ydefault:`" BOOST_PP_STRINGIZE(YADE_ABI_DEFAULT(attribute)) "`"                                                                               \
																   " :yattrtype:`" BOOST_PP_STRINGIZE(YADE_ABI_TYPE(attribute)) "`"

// One line of code per attribute, for each of the functions below.
#define YADE_ABI_DECLARE(r, data, attribute) YADE_ABI_TYPE(attribute) YADE_ABI_NAME(attribute);
#define YADE_ABI_AS_INITIALISER(r, data, attribute) ((YADE_ABI_NAME(attribute), YADE_ABI_DEFAULT(attribute)))
#define YADE_ABI_INITIALISE(r, data, index, initialiser)                                                                                             \
	BOOST_PP_COMMA_IF(index) BOOST_PP_TUPLE_ELEM(2, 0, initialiser)(BOOST_PP_TUPLE_ELEM(2, 1, initialiser))
#define YADE_ABI_SET(r, data, attribute)                                                                                                             \
	if (key == BOOST_PP_STRINGIZE(YADE_ABI_NAME(attribute))) return ::yade::abi::assign(YADE_ABI_NAME(attribute), value);
#define YADE_ABI_INTO_DICT(r, data, attribute)                                                                                                       \
	if (!(YADE_ABI_FLAGS(attribute) & ::yade::Attr::hidden)) attributes[BOOST_PP_STRINGIZE(YADE_ABI_NAME(attribute))] = YADE_ABI_NAME(attribute);
#define YADE_ABI_ARCHIVE(r, data, attribute)                                                                                                         \
	if constexpr (!(YADE_ABI_FLAGS(attribute) & ::yade::Attr::noSave)) archive& BOOST_SERIALIZATION_NVP(YADE_ABI_NAME(attribute));
#define YADE_ABI_PROPERTY(r, Class, attribute)                                                                                                       \
	::yade::abi::defineAttribute<Class>(pyClass, BOOST_PP_STRINGIZE(YADE_ABI_NAME(attribute)), &Class::YADE_ABI_NAME(attribute),                     \
																	YADE_ABI_FLAGS(attribute), YADE_ABI_DOC(attribute));

#define YADE_ABI_CONSTRUCTOR(Class, initialisers, code)                                                                                              \
	Class() BOOST_PP_EXPR_IF(BOOST_PP_SEQ_SIZE(initialisers), :) BOOST_PP_SEQ_FOR_EACH_I(YADE_ABI_INITIALISE, ~, initialisers) { code; }

/// Attributes of a class: assignment by name, dictionary, archives. In the body of the class.
#define YADE_ABI_ATTRIBUTES(Base, attributeList)                                                                                                     \
private:                                                                                                                                             \
	friend class boost::serialization::access;                                                                                                       \
	template <class Archive> void serialize(Archive& archive, unsigned int)                                                                          \
	{                                                                                                                                                \
		archive& BOOST_SERIALIZATION_BASE_OBJECT_NVP(Base);                                                                                          \
		if constexpr (Archive::is_loading::value)                                                                                                    \
			preLoad(*this);                                                                                                                          \
		else                                                                                                                                         \
			preSave(*this);                                                                                                                          \
		BOOST_PP_SEQ_FOR_EACH(YADE_ABI_ARCHIVE, ~, attributeList)                                                                                    \
		if constexpr (Archive::is_loading::value)                                                                                                    \
			postLoad(*this);                                                                                                                         \
		else                                                                                                                                         \
			postSave(*this);                                                                                                                         \
	}                                                                                                                                                \
                                                                                                                                                     \
public:                                                                                                                                              \
	void pySetAttr(const std::string& key, const ::boost::python::object& value) override                                                            \
	{                                                                                                                                                \
		BOOST_PP_SEQ_FOR_EACH(YADE_ABI_SET, ~, attributeList)                                                                                        \
		Base::pySetAttr(key, value);                                                                                                                 \
	}                                                                                                                                                \
	::boost::python::dict pyDict() const override                                                                                                    \
	{                                                                                                                                                \
		::boost::python::dict attributes;                                                                                                            \
		BOOST_PP_SEQ_FOR_EACH(YADE_ABI_INTO_DICT, ~, attributeList)                                                                                  \
		attributes.update(this->pyDictCustom());                                                                                                     \
		attributes.update(Base::pyDict());                                                                                                           \
		return attributes;                                                                                                                           \
	}                                                                                                                                                \
	void callPostLoad() override                                                                                                                     \
	{                                                                                                                                                \
		Base::callPostLoad();                                                                                                                        \
		postLoad(*this);                                                                                                                             \
	}

/// The whole declaration of a class: attributes, default constructor (additional initialisers as ((member, value)), then code), Python class
/// (`extras` are further `.def(…)`). In the body of the class.
#define YADE_CLASS_BASE_DOC_ATTRS_INIT_CTOR_PY(Class, Base, documentation, attributeList, initialisers, code, extras)                                \
public:                                                                                                                                              \
	BOOST_PP_SEQ_FOR_EACH(YADE_ABI_DECLARE, ~, attributeList)                                                                                        \
	YADE_ABI_CONSTRUCTOR(Class, initialisers BOOST_PP_SEQ_FOR_EACH(YADE_ABI_AS_INITIALISER, ~, attributeList), code)                                 \
	YADE_ABI_ATTRIBUTES(Base, attributeList)                                                                                                         \
	REGISTER_CLASS_AND_BASE(Class, Base)                                                                                                             \
	void pyRegisterClass(::boost::python::object scope) override                                                                                     \
	{                                                                                                                                                \
		checkPyClassRegistersItself(#Class);                                                                                                         \
		const ::boost::python::scope inside(scope);                                                                                                  \
		const ::boost::python::docstring_options everythingButSignatures(true, true, false);                                                         \
		::boost::python::class_<Class, ::boost::shared_ptr<Class>, ::boost::python::bases<Base>, boost::noncopyable> pyClass(#Class, documentation); \
		pyClass.def("__init__", ::yade::abi::pythonConstructor<Class>());                                                                            \
		BOOST_PP_SEQ_FOR_EACH(YADE_ABI_PROPERTY, Class, attributeList)                                                                               \
		(void)pyClass extras;                                                                                                                        \
	}

#define YADE_CLASS_BASE_DOC(Class, Base, documentation) YADE_CLASS_BASE_DOC_ATTRS_INIT_CTOR_PY(Class, Base, documentation, , , , )
#define YADE_CLASS_BASE_DOC_ATTRS(Class, Base, documentation, attributes)                                                                            \
	YADE_CLASS_BASE_DOC_ATTRS_INIT_CTOR_PY(Class, Base, documentation, attributes, , , )
#define YADE_CLASS_BASE_DOC_ATTRS_CTOR(Class, Base, documentation, attributes, code)                                                                 \
	YADE_CLASS_BASE_DOC_ATTRS_INIT_CTOR_PY(Class, Base, documentation, attributes, , code, )
#define YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(Class, Base, documentation, attributes, code, extras)                                                      \
	YADE_CLASS_BASE_DOC_ATTRS_INIT_CTOR_PY(Class, Base, documentation, attributes, , code, extras)

/// Makes a class known to the class factory and gives it the key `yade::Class` in archives. After the class, in namespace yade, which it leaves
/// and enters again because the key has to stand outside.
#define REGISTER_SERIALIZABLE(Class)                                                                                                                 \
	REGISTER_FACTORABLE(Class)                                                                                                                       \
	}                                                                                                                                                \
	BOOST_CLASS_EXPORT_KEY(yade::Class)                                                                                                              \
	namespace yade {

// clang-format on
