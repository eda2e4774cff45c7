// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <string>

namespace yade {

class Interaction;
class Scene;

/// Refuse an interaction that is being made: `message` is raised by the engine in the same step, and the interaction becomes potential
/// again, so that it is made anew once the cause is mended. Needed because a functor must not throw (see DeferredError), and because
/// YADE's InteractionLoop calls exit(1), which takes the user's session along, when no Law2 knows the geometry.
void refuseInteraction(const Scene* scene, Interaction& interaction, const std::string& message);

} // namespace yade
