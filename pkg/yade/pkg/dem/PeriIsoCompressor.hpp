// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <pkg/common/BoundaryController.hpp>

namespace yade {

/// Deforms the periodic cell towards stress or strain along the three axes.
class PeriTriaxController : public BoundaryController {
	YADE_STOCK_SERIALIZABLE(PeriTriaxController)

private:
	abi::Opaque<104, 136> goal;

public:
	int stressMask; ///< bits of the axes under stress

private:
	abi::Opaque<140, 484> rest;

public:
	PeriTriaxController() = delete;
	void action() override;
};

/// Deforms the periodic cell along paths of stress or strain, all six components.
class Peri3dController : public BoundaryController {
	YADE_STOCK_SERIALIZABLE(Peri3dController)

private:
	abi::Opaque<104, 800> tensors;

public:
	int stressMask; ///< bits of the components under stress

private:
	abi::Opaque<804, 1232> rest;

public:
	Peri3dController() = delete;
	void action() override;
};

} // namespace yade
