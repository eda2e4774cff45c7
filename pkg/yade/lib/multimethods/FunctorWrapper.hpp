// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <lib/serialization/Serializable.hpp>

#include <boost/mpl/at.hpp>
#include <boost/mpl/vector.hpp>

#include <string>

namespace yade {

/// The functions through which a dispatcher calls a functor, one per number of arguments. A functor overrides `go` with exactly the number of
/// arguments of its family; the others, defined in YADE's libraries, throw.
template <class Result, class Arguments> class FunctorWrapper {
	template <int n> using Argument = typename boost::mpl::at_c<Arguments, n>::type;

	using A1 = Argument<0>;
	using A2 = Argument<1>;
	using A3 = Argument<2>;
	using A4 = Argument<3>;
	using A5 = Argument<4>;
	using A6 = Argument<5>;
	using A7 = Argument<6>;

public:
	FunctorWrapper() {}
	virtual ~FunctorWrapper() {}

	/// "T1 T2" if the functor takes its two arguments in this order only, empty otherwise.
	virtual std::string checkOrder() const;

	virtual Result go(A1);
	virtual Result go(A1, A2);
	virtual Result go(A1, A2, A3);
	virtual Result go(A1, A2, A3, A4);
	virtual Result go(A1, A2, A3, A4, A5);
	virtual Result go(A1, A2, A3, A4, A5, A6);
	virtual Result go(A1, A2, A3, A4, A5, A6, A7);

	virtual Result goReverse(A1);
	virtual Result goReverse(A1, A2);
	virtual Result goReverse(A1, A2, A3);
	virtual Result goReverse(A1, A2, A3, A4);
	virtual Result goReverse(A1, A2, A3, A4, A5);
	virtual Result goReverse(A1, A2, A3, A4, A5, A6);
	virtual Result goReverse(A1, A2, A3, A4, A5, A6, A7);
};

} // namespace yade

#define DEFINE_FUNCTOR_ORDER_2D(Type1, Type2)                                                                                                        \
public:                                                                                                                                              \
	std::string checkOrder() const override { return #Type1 " " #Type2; }
