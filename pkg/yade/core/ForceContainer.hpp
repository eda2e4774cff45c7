// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <core/Body.hpp>

namespace yade {

/// Forces [N] and torques about the mass centre [N m] on bodies, by id. Adding is safe from several threads; reading needs `sync()` first.
class ForceContainer {
	alignas(8) abi::Opaque<0, 304> perThreadAndSummed;

public:
	ForceContainer() = delete;
	ForceContainer(const ForceContainer&) = delete;

	const Vector3r& getForce(Body::id_t id);
	const Vector3r& getTorque(Body::id_t id);
	void addForce(Body::id_t id, const Vector3r& force);
	void addTorque(Body::id_t id, const Vector3r& torque);
	/// Makes room for bodies up to this id.
	void addMaxId(Body::id_t id);

	const Vector3r& getPermForce(Body::id_t id);
	const Vector3r& getPermTorque(Body::id_t id);
	bool getPermForceUsed() const;

	const Vector3r& getForceUnsynced(Body::id_t id);
	const Vector3r& getTorqueUnsynced(Body::id_t id);
	void addForceUnsynced(Body::id_t id, const Vector3r& force);
	void addTorqueUnsynced(Body::id_t id, const Vector3r& torque);

	void sync();
	int getNumAllocatedThreads() const;
};

} // namespace yade
