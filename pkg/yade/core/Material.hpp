// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <lib/multimethods/Indexable.hpp>
#include <lib/serialization/Serializable.hpp>

namespace yade {

class Scene;
class State;

class Material : public Serializable, public Indexable {
	YADE_STOCK_SERIALIZABLE(Material)

	int id; ///< index in the scene's materials; -1 if not shared
	string label;
	Real density; ///< [kg/m³]

	Material() = delete;
	virtual shared_ptr<State> newAssocState() const;
	virtual bool stateTypeOk(State* state) const;

	YADE_STOCK_INDEX_ROOT(Material) // after the virtual functions above, as in YADE's table
};

} // namespace yade

YADE_STOCK_SERIALIZERS(Material)
