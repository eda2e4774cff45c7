// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <string>

namespace yade {

class Scene;
class Engine;

/// Judges YADE's boundary controllers beside Contact Dynamics. Those that steer by stress take their gain from contact stiffness, or react to the
/// stress of the step before: a jammed packing of rigid grains answers the smallest compression with any stress, so they overshoot without bound
/// (pressure of a periodic assembly of 142 grains: up to 2e3, 2e2 and 7e4 times the goal with PeriTriaxController, PeriIsoCompressor and
/// PeriTriaxController(dynCell=True), none with Peri3dController, which stands still). Those that steer by strain work in the right place.
/// @param engine  ContactDynamicsEngine
/// @throws std::runtime_error  naming the controller and what to use instead, or where to put it
void requireUsableControllers(const Scene& scene, const Engine& engine);

/// Law2_ScGeom_CapillaryPhys_Capillarity, an engine, takes the physics of every interaction for its own class without looking: beside a contact of
/// another class it reads and writes past the end of an object. So no contact of ours may exist where it acts.
/// @returns what to say where this engine is in O.engines, else an empty string
std::string whatForbidsOtherContacts(const Scene& scene);

} // namespace yade
