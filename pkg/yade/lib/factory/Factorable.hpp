// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <lib/factory/ClassFactory.hpp>

#include <boost/enable_shared_from_this.hpp>

namespace yade {

/// What the class factory can make.
class Factorable : public boost::enable_shared_from_this<Factorable> {
public:
	Factorable() {}
	// A copy would copy the members that are not named here byte by byte.
	Factorable(const Factorable&) = delete;
	Factorable& operator=(const Factorable&) = delete;

	virtual ~Factorable();
	/// Name of the i-th base class as Python and the archives know it; empty beyond the last.
	virtual std::string getBaseClassName(unsigned int which = 0) const;
	virtual int getBaseClassNumber() const;
	virtual std::string getClassName() const;
};

} // namespace yade

/// Names of a class and of its base, in the body of the class.
#define REGISTER_CLASS_NAME(Class)                                                                                                                   \
public:                                                                                                                                              \
	std::string getClassName() const override { return #Class; }
#define REGISTER_BASE_CLASS_NAME(Base)                                                                                                               \
public:                                                                                                                                              \
	std::string getBaseClassName(unsigned int which = 0) const override { return which == 0 ? #Base : ""; }                                          \
	int getBaseClassNumber() const override { return 1; }
#define REGISTER_CLASS_AND_BASE(Class, Base) REGISTER_CLASS_NAME(Class) REGISTER_BASE_CLASS_NAME(Base)
