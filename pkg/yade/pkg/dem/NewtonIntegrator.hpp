// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <pkg/common/FieldApplier.hpp>

namespace yade {

/// Moves the bodies: semi-implicit Euler in velocity and position.
class NewtonIntegrator : public FieldApplier {
	YADE_STOCK_SERIALIZABLE(NewtonIntegrator)

private:
	abi::Opaque<108, 216> perStep;

public:
	bool densityScaling;

private:
	abi::Opaque<217, 256> speeds;

public:
	Real damping;
	Vector3r gravity; ///< [m/s²]
	Real maxVelocitySq;
	bool exactAsphericalRot;
	Matrix3r prevVelGrad; ///< [1/s]
	Vector3r prevCellSize;
	bool warnNoForceReset;

private:
	abi::Opaque<401, 409> energyOptions;

public:
	bool dampGravity;

private:
	abi::Opaque<410, 424> energyIndices;

public:
	int mask; ///< 0: all bodies; otherwise only those whose groupMask has a bit of it

	NewtonIntegrator() = delete;
	void action() override;
};

} // namespace yade
