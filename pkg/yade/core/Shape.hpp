// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <lib/multimethods/Indexable.hpp>
#include <lib/serialization/Serializable.hpp>

namespace yade {

/// Geometry of a body, in the body's frame.
class Shape : public Serializable, public Indexable {
	YADE_STOCK_SERIALIZABLE(Shape)
	YADE_STOCK_INDEX_ROOT(Shape)
	Shape() = delete;

private:
	abi::Opaque<32, 90> functorsAndAppearance;
};

} // namespace yade

YADE_STOCK_SERIALIZERS(Shape)
