// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <core/Interaction.hpp>
#include <core/State.hpp>
#include <pkg/dem/DemXDofGeom.hpp>

namespace yade {

/// Geometry of a contact of a sphere.
class ScGeom : public GenericSpheresContact {
	YADE_STOCK_SERIALIZABLE(ScGeom)
	YADE_STOCK_INDEXABLE(ScGeom)

private:
	abi::Opaque<96, 144> rotationOfContact;

public:
	Real& radius1;		   ///< refers to `refR1`
	Real& radius2;		   ///< refers to `refR2`
	Real penetrationDepth; ///< positive if the bodies overlap [m]
	Vector3r shearInc;

	ScGeom();
	/// Sets the normal, and what laws with memory need to follow the rotation of the contact.
	void precompute(const State& state1, const State& state2, const Scene* scene, const shared_ptr<Interaction>& interaction, const Vector3r& normal,
					bool isNew, const Vector3r& shift2, bool avoidGranularRatcheting = true);
	Vector3r& rotate(Vector3r& tangentVector) const;
};

} // namespace yade

YADE_STOCK_SERIALIZERS(ScGeom)
