// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <stdexcept>
#include <string>
#include <type_traits>

namespace yade {

/// What the ContactDynamicsEngine needs of a scene, or a std::runtime_error.
/// @param message  text, or a function that makes it: to put the messages together costs more than to look at the engines, in each step
template <class Message> void requireOfScene(bool fulfilled, const Message& message, const char* advice = "")
{
	if (fulfilled) return;
	const auto fail = [&](const std::string& what) { throw std::runtime_error("ContactDynamicsEngine: " + what + advice); };
	if constexpr (std::is_invocable_v<Message>)
		fail(message());
	else
		fail(message);
}

} // namespace yade
