// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <lib/multimethods/Indexable.hpp>
#include <lib/serialization/Serializable.hpp>

namespace yade {

/// Physical side of an interaction: parameters, forces and what a law remembers.
class IPhys : public Serializable, public Indexable {
	YADE_STOCK_SERIALIZABLE(IPhys)
	YADE_STOCK_INDEX_ROOT(IPhys)
	IPhys() {}
};

} // namespace yade

YADE_STOCK_SERIALIZERS(IPhys)
