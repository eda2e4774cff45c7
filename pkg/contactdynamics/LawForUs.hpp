// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/Dispatching.hpp>

namespace yade {

/// Whether a law is for the contacts of ContactDynamicsEngine; any other one is soft.
inline bool isLawForUs(const shared_ptr<LawFunctor>& law) { return law->get2DFunctorType2() == "ContactDynamicsPhys"; }

} // namespace yade
