// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <sstream>
#include <stdexcept>
#include <string>

namespace yade {

/// Refuses the value of an attribute: ValueError in Python, in the one form that all classes use.
/// @param attribute  with its class, as "ContactDynamicsEngine.tolerance"
/// @param allowed    what the value must be, a clause without full stop
template <class Value> [[noreturn]] void refuseAttribute(const std::string& attribute, const Value& value, const char* allowed)
{
	std::ostringstream message;
	message << attribute << " = " << value << ": " << allowed << ".";
	throw std::invalid_argument(message.str());
}

} // namespace yade
