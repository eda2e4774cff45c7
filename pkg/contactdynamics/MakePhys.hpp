// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "PairLaw.hpp"

namespace yade {

class FrictMat;
class Interaction;
class Scene;

/// Gives `interaction` a ContactDynamicsPhys with this law, unless it has a phys already. What is wrong with the law or the geometry is
/// reported as refuseInteraction() does.
void makePhys(const Scene* scene, const FrictMat& material1, const FrictMat& material2, Interaction& interaction, const PairLaw& law);

} // namespace yade
