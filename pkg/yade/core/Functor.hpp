// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <lib/multimethods/FunctorWrapper.hpp>
#include <lib/serialization/Serializable.hpp>
#include <core/Timing.hpp>

namespace yade {

class Scene;

/// What a dispatcher calls for a combination of types. `go` runs in several threads at once.
class Functor : public Serializable {
	YADE_STOCK_SERIALIZABLE(Functor)

	shared_ptr<TimingDeltas> timingDeltas;
	Scene* scene = nullptr; ///< set by the dispatcher before each loop
	string label;

	Functor() {}
	virtual vector<string> getFunctorTypes() const;
};

/// A functor called for one type.
template <class Type, class Result, class Arguments> class Functor1D : public Functor, public FunctorWrapper<Result, Arguments> {
public:
	using DispatchType1 = Type;

	Functor1D() {}
	~Functor1D() override {}
	string getClassName() const override;
	string getBaseClassName(unsigned int which = 0) const override;
	int getBaseClassNumber() const override;
	vector<string> getFunctorTypes() const override;
	virtual string get1DFunctorType1() const;
};

/// A functor called for a pair of types.
template <class Type1, class Type2, class Result, class Arguments> class Functor2D : public Functor, public FunctorWrapper<Result, Arguments> {
public:
	using DispatchType1 = Type1;
	using DispatchType2 = Type2;

	Functor2D() {}
	~Functor2D() override {}
	string getClassName() const override;
	string getBaseClassName(unsigned int which = 0) const override;
	int getBaseClassNumber() const override;
	vector<string> getFunctorTypes() const override;
	virtual string get2DFunctorType1() const;
	virtual string get2DFunctorType2() const;
};

} // namespace yade

/// Types that a functor takes; in the body of the class.
#define FUNCTOR1D(Type1)                                                                                                                             \
public:                                                                                                                                              \
	std::string get1DFunctorType1() const override { return #Type1; }
#define FUNCTOR2D(Type1, Type2)                                                                                                                      \
public:                                                                                                                                              \
	std::string get2DFunctorType1() const override { return #Type1; }                                                                                \
	std::string get2DFunctorType2() const override { return #Type2; }
