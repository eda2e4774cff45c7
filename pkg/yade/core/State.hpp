// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <lib/multimethods/Indexable.hpp>
#include <lib/serialization/Serializable.hpp>

namespace yade {

/// Placement and motion of a body. Vectors are in the global frame unless said otherwise.
class State : public Serializable, public Indexable {
	YADE_STOCK_SERIALIZABLE(State)
	YADE_STOCK_INDEX_ROOT(State)

	Vector3r& pos;	  ///< position of the mass centre [m], refers into `se3`
	Quaternionr& ori; ///< from the body's frame to the global one, refers into `se3`

private:
	abi::Opaque<48, 88> updateMutex;

public:
	Se3r se3;
	Vector3r vel;	  ///< [m/s]
	Real mass;		  ///< [kg]
	Vector3r angVel;  ///< [rad/s]
	Vector3r angMom;  ///< [kg m²/s]; kept by the integrator for aspherical bodies only
	Vector3r inertia; ///< principal moments, body's frame [kg m²]
	Vector3r refPos;
	Quaternionr refOri;
	unsigned int blockedDOFs; ///< bits of DOF_*
	bool isDamped;
	Real densityScaling;

	State();

	enum { DOF_NONE = 0, DOF_X = 1, DOF_Y = 2, DOF_Z = 4, DOF_RX = 8, DOF_RY = 16, DOF_RZ = 32 };
	static constexpr unsigned DOF_XYZ = DOF_X | DOF_Y | DOF_Z;
	static constexpr unsigned DOF_RXRYRZ = DOF_RX | DOF_RY | DOF_RZ;
	static constexpr unsigned DOF_ALL = DOF_XYZ | DOF_RXRYRZ;

	/// Bit of the translation along, or the rotation about, axis 0, 1 or 2.
	static unsigned axisDOF(int axis, bool rotationalDOF = false) { return 1u << (rotationalDOF ? axis + 3 : axis); }
};

} // namespace yade

YADE_STOCK_SERIALIZERS(State)
