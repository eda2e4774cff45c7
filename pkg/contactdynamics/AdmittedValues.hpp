// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <tuple>

namespace yade {

/// Takes what Python has set over into `admitted`, or puts the last admissible values back where the check refuses.
/// @param attributes  std::tie of the attributes that the check is about
/// @param check       throws if one of them, as it is now, is not admissible (see refuseAttribute)
template <class... Values, class Check> void admit(std::tuple<Values&...> attributes, std::tuple<Values...>& admitted, const Check& check)
{
	try {
		check();
	} catch (...) {
		attributes = admitted;
		throw;
	}
	admitted = attributes;
}

} // namespace yade
