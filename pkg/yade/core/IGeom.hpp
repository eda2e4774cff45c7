// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <lib/multimethods/Indexable.hpp>
#include <lib/serialization/Serializable.hpp>

namespace yade {

/// Geometry of an interaction.
class IGeom : public Serializable, public Indexable {
	YADE_STOCK_SERIALIZABLE(IGeom)
	YADE_STOCK_INDEX_ROOT(IGeom)
	IGeom() {}
};

} // namespace yade

YADE_STOCK_SERIALIZERS(IGeom)
