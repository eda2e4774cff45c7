// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <pkg/common/BoundaryController.hpp>

namespace yade {

/// Moves six walls towards stress, or at strain rates, along the three axes, or lets the grains grow.
class TriaxialStressController : public BoundaryController {
	YADE_STOCK_SERIALIZABLE(TriaxialStressController)

private:
	abi::Opaque<104, 1000> wallsAndMeasurements;

public:
	unsigned int stressMask; ///< bits of the axes under stress

private:
	abi::Opaque<1004, 1048> limits;

public:
	bool internalCompaction; ///< grains grow instead of walls moving

private:
	abi::Opaque<1049, 1081> rest;

public:
	TriaxialStressController() = delete;
	void action() override;
};

} // namespace yade
