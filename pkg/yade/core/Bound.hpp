// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <lib/multimethods/Indexable.hpp>
#include <lib/serialization/Serializable.hpp>

namespace yade {

/// Volume around a body that the collider compares with others.
class Bound : public Serializable, public Indexable {
	YADE_STOCK_SERIALIZABLE(Bound)
	YADE_STOCK_INDEX_ROOT(Bound)

	int lastUpdateIter; ///< step in which `min` and `max` were computed
	Vector3r refPos;	///< position of the body then [m]
	Real sweepLength;	///< by how much the bound was enlarged for motion to come [m]
	Vector3r color;
	Vector3r min; ///< [m]
	Vector3r max; ///< [m]

	Bound() = delete;
};

} // namespace yade

YADE_STOCK_SERIALIZERS(Bound)
