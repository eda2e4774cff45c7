// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <core/IGeom.hpp>

namespace yade {

/// Geometry of a contact with one point and one normal.
class GenericSpheresContact : public IGeom {
	YADE_STOCK_SERIALIZABLE(GenericSpheresContact)
	YADE_STOCK_INDEXABLE(GenericSpheresContact)

	Vector3r normal;	   ///< from body 1 to body 2
	Vector3r contactPoint; ///< [m]
	Real refR1;			   ///< [m]
	Real refR2;			   ///< [m]

	GenericSpheresContact() = delete;
};

} // namespace yade

YADE_STOCK_SERIALIZERS(GenericSpheresContact)
