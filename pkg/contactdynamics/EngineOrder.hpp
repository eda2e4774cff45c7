// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

namespace yade {

class ContactDynamicsCellController;
class Engine;
class NewtonIntegrator;
class Scene;

/// The NewtonIntegrator that will turn the forces of `engine` into motion, after checking that O.engines makes a Contact Dynamics step:
/// ForceResetter and an InteractionLoop with a law for ContactDynamicsPhys before the engine, a live collider unless interactions are there; exactly
/// one live NewtonIntegrator, behind it and without damping; nothing between the two that adds forces or sets velocities; ServoPIDController where it
/// sees contact forces, ContactDynamicsTriaxialController before; no second Contact Dynamics engine; no GlobalStiffnessTimeStepper (rigid contacts
/// have no stiffness to take a time step from).
/// @throws std::runtime_error  naming what is missing or misplaced and how to mend it
const NewtonIntegrator& requireEngineOrder(const Scene& scene, const Engine& engine);

/// The live ContactDynamicsCellController of the scene, or null.
/// @throws std::runtime_error  there are two, or a PeriTriaxController or Peri3dController beside it
ContactDynamicsCellController* findCellController(const Scene& scene);

} // namespace yade
