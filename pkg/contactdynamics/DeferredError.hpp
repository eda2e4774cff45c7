// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <string>

namespace yade {

class Scene;

/// Errors that a functor finds but must not throw: YADE calls functors inside OpenMP loops, where an exception ends the process.
/// The functor reports and leaves the pair without contact; ContactDynamicsEngine raises the report in the same step.
namespace DeferredError {
/// Keep `message` for `scene`; of several reports in a step the one with the smallest (id1, id2) is kept, so that the thread count does not choose.
void report(const Scene* scene, int id1, int id2, const std::string& message);
/// Throw std::runtime_error with the message kept in this step of `scene` and forget it; nothing happens when there is none.
void raise(const Scene* scene);
} // namespace DeferredError

} // namespace yade
