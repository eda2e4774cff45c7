// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <core/Engine.hpp>

namespace yade {

/// An engine that calls functors by the types of what they act on.
class Dispatcher : public Engine {
	YADE_STOCK_SERIALIZABLE(Dispatcher)
	Dispatcher() = delete;
	virtual string getFunctorType() const;
	virtual int getDimension() const;
	virtual string getBaseClassType(unsigned int which) const;
};

} // namespace yade
