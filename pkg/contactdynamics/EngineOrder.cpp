// SPDX-License-Identifier: GPL-2.0-or-later
#include "EngineOrder.hpp"
#include "ContactDynamicsCellController.hpp"
#include "LawForUs.hpp"
#include "Requirement.hpp"
#include <core/BodyContainer.hpp>
#include <core/InteractionContainer.hpp>
#include <core/InteractionLoop.hpp>
#include <core/PartialEngine.hpp>
#include <core/Scene.hpp>
#include <core/TimeStepper.hpp>
#include <pkg/common/Collider.hpp>
#include <pkg/common/CombinedKinematicEngine.hpp>
#include <pkg/common/FieldApplier.hpp>
#include <pkg/dem/NewtonIntegrator.hpp>
#include <algorithm>
#include <sstream>

namespace yade {
namespace {
template <class Message> void require(bool fulfilled, const Message& message)
{
	requireOfScene(fulfilled, message, " contactdynamics.engines() returns a list in the right order.");
}

/// Engines that add forces or set velocities of some bodies or all: KinematicEngine, ForceEngine, GravityEngine and their kin.
bool actsOnBodies(const Engine& engine)
{
	if (dynamic_cast<const NewtonIntegrator*>(&engine)) return false;
	return dynamic_cast<const PartialEngine*>(&engine) || dynamic_cast<const FieldApplier*>(&engine);
}

/// ServoPIDController, also where it is one of several motions that are added up.
bool followsForces(const Engine& engine)
{
	if (const auto* combined = dynamic_cast<const CombinedKinematicEngine*>(&engine))
		return std::any_of(combined->comb.begin(), combined->comb.end(), [](const auto& one) { return one && followsForces(*one); });
	return engine.getClassName() == "ServoPIDController";
}

/// With no law but soft ones, YADE would take theirs, which drops the contacts as long as there is a gap.
bool hasLawForUs(const InteractionLoop& loop)
{
	const auto& laws = loop.lawDispatcher->functors;
	return std::any_of(laws.begin(), laws.end(), isLawForUs);
}
} // namespace

const NewtonIntegrator& requireEngineOrder(const Scene& scene, const Engine& engine)
{
	const NewtonIntegrator* newton = nullptr;
	bool collides = false, resetBefore = false, loopBefore = false, lawBefore = false, passed = false, newtonBehind = false;
	int integrators = 0;
	std::string intruder;	  // between this engine and the integrator
	std::string lateCollider; // between our InteractionLoop and the integrator
	for (const auto& other : scene.engines) {
		if (other.get() == &engine) {
			require(!passed, "it stands twice in O.engines, so it would solve the contacts again that it has just solved. Remove one.");
			passed = true;
			continue;
		}
		if (!other || other->dead) continue;
		const std::string name = other->getClassName();
		require(name != engine.getClassName(),
				"there are two of them in O.engines; one engine solves all contacts of the scene. Remove one or set it dead.");
		const auto* stepper = dynamic_cast<const TimeStepper*>(other.get());
		require(name != "GlobalStiffnessTimeStepper" || !stepper || !stepper->active,
				"GlobalStiffnessTimeStepper stands in O.engines, but rigid contacts have no stiffness to take a time step from. Remove it, or set "
				"active=False, and set O.dt.");
		if (passed && !newtonBehind && intruder.empty() && actsOnBodies(*other)) intruder = name;
		require(!followsForces(*other) || passed || !resetBefore, [&] {
			const std::string whole = name == "ServoPIDController" ? "" : ", with the " + name + " it is part of,";
			return "ServoPIDController stands behind ForceResetter and before this engine in O.engines, where there are no contact forces yet "
				   "that it could follow. Put it" +
				   whole + " behind NewtonIntegrator.";
		});
		if (name == "ForceResetter") resetBefore |= !passed;
		if (dynamic_cast<const Collider*>(other.get())) {
			collides = true;
			if (lawBefore && !newtonBehind) lateCollider = name;
		}
		if (const auto* loop = dynamic_cast<const InteractionLoop*>(other.get())) {
			loopBefore |= !passed;
			if (!passed && hasLawForUs(*loop)) {
				lawBefore = true;
				lateCollider.clear();
			}
		}
		require(name != "ContactDynamicsTriaxialController" || !passed,
				"ContactDynamicsTriaxialController stands behind this engine in O.engines, so the contacts would not feel its walls; put it before.");
		if (const auto* candidate = dynamic_cast<const NewtonIntegrator*>(other.get())) {
			newton = candidate;
			newtonBehind = passed;
			integrators++;
		}
	}
	require(integrators > 0, "there is no (live) NewtonIntegrator in O.engines; put NewtonIntegrator(damping=0) behind this engine.");
	require(integrators == 1,
			[&] { return "there are " + std::to_string(integrators) + " live NewtonIntegrators in O.engines; exactly one may move the bodies."; });
	require(newtonBehind, "NewtonIntegrator stands before this engine in O.engines, so the contact forces would not act; put it behind.");
	require(intruder.empty(), [&] {
		return intruder + " stands between this engine and NewtonIntegrator in O.engines, where the forces it adds or the velocities it sets would "
						  "spoil the solution. Put it before this engine or behind NewtonIntegrator.";
	});
	require(resetBefore, "no ForceResetter stands before this engine in O.engines, so forces of past steps would add up; make it the first engine.");
	// A scene may do with interactions that were made by hand (utils.createInteraction).
	const InteractionContainer& interactions = *scene.interactions;
	require(collides || interactions.begin() != interactions.end() || scene.bodies->size() < 2,
			"no (live) collider stands in O.engines and there are no interactions, so bodies would pass through one another; put "
			"InsertionSortCollider between ForceResetter and InteractionLoop.");
	require(loopBefore,
			"no InteractionLoop stands before this engine in O.engines, so there are no contacts to solve; put it between collider and engine.");
	require(lawBefore, "no InteractionLoop before this engine in O.engines has a law for ContactDynamicsPhys, so contacts would be lost; give it "
					   "Law2_ScGeom_ContactDynamicsPhys_SignoriniCoulomb().");
	require(lateCollider.empty(), [&] {
		return lateCollider +
			   " stands between InteractionLoop and NewtonIntegrator in O.engines, so pairs that it finds would be solved a step late, "
			   "and fast bodies pass through one another. Put it before InteractionLoop.";
	});
	const auto valueOf = [](const char* name, const auto& value, const char* allowed) {
		std::ostringstream message;
		message << "NewtonIntegrator." << name << " is " << value << allowed;
		return message.str();
	};
	require(newton->gravity.allFinite(), [&] { return valueOf("gravity", newton->gravity.transpose(), "; it must be finite."); });
	require(newton->damping == 0,
			[&] { return valueOf("damping", newton->damping, "; it must be 0: damped velocities no longer satisfy the contact law."); });
	return *newton;
}

ContactDynamicsCellController* findCellController(const Scene& scene)
{
	ContactDynamicsCellController* found = nullptr;
	for (const auto& engine : scene.engines) {
		if (!engine || engine->dead) continue;
		auto* controller = dynamic_cast<ContactDynamicsCellController*>(engine.get());
		require(!controller || !found,
				"there are two live ContactDynamicsCellControllers in O.engines; one of them moves the cell. Remove one or set it dead.");
		if (!controller) continue;
		found = controller;
		for (const auto& other : scene.engines) {
			if (!other || other->dead) continue;
			const std::string name = other->getClassName();
			require(name != "PeriTriaxController" && name != "Peri3dController", [&] {
				return name + " and ContactDynamicsCellController stand in O.engines; one of them moves the cell. Remove one or set it dead.";
			});
		}
	}
	return found;
}

} // namespace yade
