// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <stdexcept>

namespace yade {

/// A class that multiple dispatch finds by an index: one number per class, counted within its family (Shape, Material, State, Bound, IGeom, IPhys).
class Indexable {
protected:
	/// To be called in the constructor of every class that is not the root of its family: gives the class its index, the first time.
	void createIndex()
	{
		int& index = modifyClassIndex();
		if (index != -1) return;
		index = getMaxCurrentlyUsedClassIndexOfKin() + 1;
		incrementMaxCurrentlyUsedClassIndexOfKin();
	}
	// Order as in YADE's table of virtual functions. The libraries export no definitions of these, hence the bodies.
	virtual void incrementMaxCurrentlyUsedClassIndexOfKin() { throwNotOverridden(); }
	virtual int& modifyClassIndex() { throwNotOverridden(); }

public:
	Indexable() {}
	virtual ~Indexable() {}
	virtual const int& getClassIndex() const { throwNotOverridden(); }
	/// Index of the base class `depth` levels up, 1 for the direct base.
	virtual const int& getBaseClassIndex(int) const { throwNotOverridden(); }
	virtual const int& getMaxCurrentlyUsedClassIndexOfKin() const { throwNotOverridden(); }

private:
	[[noreturn]] static void throwNotOverridden()
	{
		throw std::logic_error("A class derived from Indexable does not use REGISTER_CLASS_INDEX in its body.");
	}
};

} // namespace yade

/// Index of a class in its family; in the body of the class.
#define REGISTER_CLASS_INDEX(Class, Base)                                                                                                            \
private:                                                                                                                                             \
	static int& modifyClassIndexStatic()                                                                                                             \
	{                                                                                                                                                \
		static int index = -1;                                                                                                                       \
		return index;                                                                                                                                \
	}                                                                                                                                                \
                                                                                                                                                     \
protected:                                                                                                                                           \
	int& modifyClassIndex() override { return modifyClassIndexStatic(); }                                                                            \
                                                                                                                                                     \
public:                                                                                                                                              \
	static const int& getClassIndexStatic() { return modifyClassIndexStatic(); }                                                                     \
	const int& getClassIndex() const override { return getClassIndexStatic(); }                                                                      \
	const int& getBaseClassIndex(int depth) const override                                                                                           \
	{                                                                                                                                                \
		static const Base& base = *new Base; /* never destroyed: asked for until the end of the process */                                           \
		return depth == 1 ? base.getClassIndex() : base.getBaseClassIndex(depth - 1);                                                                \
	}
