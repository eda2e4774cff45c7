// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <core/GlobalEngine.hpp>

namespace yade {

/// An engine that applies a field such as gravity.
class FieldApplier : public GlobalEngine {
	YADE_STOCK_SERIALIZABLE(FieldApplier)
private:
	abi::Opaque<104, 108> energyIndex;

public:
	FieldApplier() = delete;
	void action() override;
};

} // namespace yade
