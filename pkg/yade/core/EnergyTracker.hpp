// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <lib/serialization/Serializable.hpp>

namespace yade {

/// Energies by name [J]; filled while `O.trackEnergy` is true.
class EnergyTracker : public Serializable {
	YADE_STOCK_SERIALIZABLE(EnergyTracker)

private:
	abi::Opaque<24, 176> accumulators;

public:
	EnergyTracker();

	/// Adds to the energy of that name. `id` remembers its place; start with -1. With `reset`, it is zeroed in every step.
	void add(const Real& value, const string& name, int& id, bool reset = false);
	Real total() const;
};

} // namespace yade
