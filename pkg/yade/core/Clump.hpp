// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <core/Body.hpp>

namespace yade {

/// Shape of a body that is a rigid aggregate of other bodies.
class Clump : public Shape {
	YADE_STOCK_SERIALIZABLE(Clump)
	YADE_STOCK_INDEXABLE(Clump)

	using MemberMap = std::map<Body::id_t, Se3r>;

	MemberMap members; ///< placement of each member in the clump's frame
	vector<int> ids;

	Clump() = delete;
	/// Adds force and torque of the members, about the clump's centre, to F and T.
	void addForceTorqueFromMembers(const State* clumpState, Scene* scene, Vector3r& F, Vector3r& T);
};

} // namespace yade
