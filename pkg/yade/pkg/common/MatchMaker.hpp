// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <lib/serialization/Serializable.hpp>

namespace yade {

/// Gives a number for a pair: looked up by ids, or computed from a number of each.
class MatchMaker : public Serializable {
	YADE_STOCK_SERIALIZABLE(MatchMaker)

private:
	abi::Opaque<24, 96> fallbackAndLookup;

public:
	vector<Vector3r> matches; ///< (id 1, id 2, value)
	string algo;			  ///< "avg" (default), "min", "max", "harmAvg", "zero" or "val"; call postLoad after setting it
	Real val;

	MatchMaker();
	/// To be called after setting `algo` or `matches` from C++.
	void postLoad(MatchMaker&);
	Real operator()(const int id1, const int id2, const Real value1 = NaN, const Real value2 = NaN) const;
	Real computeFallback(Real value1, Real value2) const;
};

} // namespace yade

YADE_STOCK_SERIALIZERS(MatchMaker)
