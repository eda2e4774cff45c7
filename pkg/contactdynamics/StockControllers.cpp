// SPDX-License-Identifier: GPL-2.0-or-later
#include "StockControllers.hpp"
#include "Requirement.hpp"
#include <core/Scene.hpp>
#include <pkg/dem/NewtonIntegrator.hpp>
#include <pkg/dem/PeriIsoCompressor.hpp>
#include <pkg/dem/TriaxialStressController.hpp>

namespace yade {
namespace {
enum class Place { before, between, behind }; // relative to the ContactDynamicsEngine and the NewtonIntegrator

void judgeCell(const char* name, int stressMask, Place place)
{
	requireOfScene(stressMask == 0, [&] {
		return std::string(name) + " stands in O.engines with stressMask = " + std::to_string(stressMask) +
			   ". It steers stress by contact stiffness or by the stress of the step before, and rigid contacts have none and answer at once. "
			   "Use ContactDynamicsCellController for stress, or stressMask=0 (strain only).";
	});
	requireOfScene(place == Place::before, [&] {
		return std::string(name) + " stands behind this engine in O.engines, so the contacts would be solved for another motion of the cell; put it "
								   "between InteractionLoop and this engine.";
	});
}

void judgeBox(const TriaxialStressController& controller, Place place)
{
	requireOfScene(
			!controller.internalCompaction,
			"TriaxialStressController stands in O.engines with internalCompaction = True. Grains that grow are no motion: rigid contacts do not "
			"resist it, "
			"only overlaps would grow. Use internalCompaction=False with stressMask=0 (strain only), or contactdynamics.triaxial for stress.");
	requireOfScene(controller.stressMask == 0, [&] {
		return "TriaxialStressController stands in O.engines with stressMask = " + std::to_string(controller.stressMask) +
			   ". It steers stress by contact stiffness, and rigid contacts have none. "
			   "Use contactdynamics.triaxial for stress, or stressMask=0 (strain only).";
	});
	requireOfScene(place == Place::behind,
				   "TriaxialStressController stands before NewtonIntegrator in O.engines, where the forces on its walls are not known yet or their "
				   "velocities are already in use; put it behind NewtonIntegrator.");
}
} // namespace

void requireUsableControllers(const Scene& scene, const Engine& engine)
{
	Place place = Place::before;
	for (const auto& other : scene.engines) {
		if (other.get() == &engine) place = Place::between;
		if (!other || other->dead) continue;
		if (dynamic_cast<const NewtonIntegrator*>(other.get())) place = Place::behind;
		requireOfScene(other->getClassName() != "PeriIsoCompressor",
					   "PeriIsoCompressor stands in O.engines. It steers stress by contact stiffness, and "
					   "rigid contacts have none. Use ContactDynamicsCellController.");
		if (const auto* triax = dynamic_cast<const PeriTriaxController*>(other.get())) judgeCell("PeriTriaxController", triax->stressMask, place);
		if (const auto* cell = dynamic_cast<const Peri3dController*>(other.get())) judgeCell("Peri3dController", cell->stressMask, place);
		if (const auto* box = dynamic_cast<const TriaxialStressController*>(other.get())) judgeBox(*box, place);
	}
}

std::string whatForbidsOtherContacts(const Scene& scene)
{
	for (const auto& engine : scene.engines)
		if (engine && !engine->dead && engine->getClassName() == "Law2_ScGeom_CapillaryPhys_Capillarity")
			return "Law2_ScGeom_CapillaryPhys_Capillarity stands in O.engines. It takes every interaction of the scene for one of its own class, and "
				   "so "
				   "cannot act beside any other law. Use ViscElCapMat with Law2_ScGeom_ViscElCapPhys_Basic for capillary bridges beside Contact "
				   "Dynamics.";
	return "";
}

} // namespace yade
