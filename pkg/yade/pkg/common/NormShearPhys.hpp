// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <core/IPhys.hpp>

namespace yade {

class NormPhys : public IPhys {
	YADE_STOCK_SERIALIZABLE(NormPhys)
	YADE_STOCK_INDEXABLE(NormPhys)

	Real kn;			  ///< [N/m]
	Vector3r normalForce; ///< on body 2 [N]

	NormPhys();
};

class NormShearPhys : public NormPhys {
	YADE_STOCK_SERIALIZABLE(NormShearPhys)
	YADE_STOCK_INDEXABLE(NormShearPhys)

	Real ks;			 ///< [N/m]
	Vector3r shearForce; ///< on body 2 [N]

	NormShearPhys();
};

} // namespace yade

YADE_STOCK_SERIALIZERS(NormPhys)
YADE_STOCK_SERIALIZERS(NormShearPhys)
