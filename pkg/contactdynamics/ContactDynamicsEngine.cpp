// SPDX-License-Identifier: GPL-2.0-or-later
#include "ContactDynamicsEngine.hpp"
#include "AdmittedValues.hpp"
#include "ContactDynamicsCellController.hpp"
#include "ContactDynamicsStep.hpp"
#include "DeferredError.hpp"
#include "EngineOrder.hpp"
#include "PlaneOfMotion.hpp"
#include "OtherContacts.hpp"
#include "Reach.hpp"
#include "RefuseAttribute.hpp"
#include "StockControllers.hpp"
#include <core/BodyContainer.hpp>
#include <core/Scene.hpp>
#include <core/Timing.hpp>
#include <cmath>
#include <iostream>
#include <sstream>
#include <stdexcept>

namespace yade {

YADE_PLUGIN((ContactDynamicsEngine));

struct ContactDynamicsEngine::Step : ContactDynamicsStep {};

ContactDynamicsEngine::~ContactDynamicsEngine() = default;

void ContactDynamicsEngine::createStep() { step = std::make_shared<Step>(); }

void ContactDynamicsEngine::requireAdmissible() const
{
	if (!(tolerance > 0 && std::isfinite(tolerance))) refuseAttribute("ContactDynamicsEngine.tolerance", tolerance, "it must be positive and finite");
	if (maxIterations < 1) refuseAttribute("ContactDynamicsEngine.maxIterations", maxIterations, "at least one sweep is needed");
	if (contactLaw != "quasiInelasticShock" && contactLaw != "velocitySignorini" && contactLaw != "signorini")
		refuseAttribute("ContactDynamicsEngine.contactLaw", '"' + contactLaw + '"',
						"allowed are quasiInelasticShock, velocitySignorini and signorini");
	if (onNonConvergence != "warn" && onNonConvergence != "raise" && onNonConvergence != "ignore")
		refuseAttribute("ContactDynamicsEngine.onNonConvergence", '"' + onNonConvergence + '"', "allowed are warn, raise and ignore");
	if (acceleration != "default" && acceleration != "none")
		refuseAttribute("ContactDynamicsEngine.acceleration", '"' + acceleration + '"', "allowed are default and none");
	if (!(repairRate >= 0 && repairRate <= 1))
		refuseAttribute("ContactDynamicsEngine.repairRate", repairRate, "it must lie between 0 (no repair) and 1");
	if (!(allowedOverlap >= 0 && std::isfinite(allowedOverlap)))
		refuseAttribute("ContactDynamicsEngine.allowedOverlap", allowedOverlap, "it must be finite and not negative");
}

void ContactDynamicsEngine::postLoad(ContactDynamicsEngine&)
{
	admit(attributes(), admitted, [this] { requireAdmissible(); });
}

void ContactDynamicsEngine::action()
{
	struct ForgetReach {
		~ForgetReach() { Reach::forget(); }
	} atTheEnd;
	timingDeltas->start();
	collect();
	timingDeltas->checkpoint("collect");
	solve();
	timingDeltas->checkpoint("solve");
	apply();
	timingDeltas->checkpoint("apply");
	repair();
	timingDeltas->checkpoint("repair");
	// The engines may be replaced before the next step, see Plugin.cpp; a collider that knows all bodies passes by at no cost.
	scene->bodies->checkedByCollider = false;
}

void ContactDynamicsEngine::collect()
{
	DeferredError::raise(scene);
	if (!(scene->dt > 0 && std::isfinite(scene->dt))) {
		std::ostringstream message;
		message << "ContactDynamicsEngine: O.dt is " << scene->dt << "; the time step must be positive and finite.";
		throw std::runtime_error(message.str());
	}
	const NewtonIntegrator& newton = requireEngineOrder(*scene, *this);
	requireUsableControllers(*scene, *this);
	scene->forces.sync();
	IntegratorPlan plan(*scene, newton);
	cellController = findCellController(*scene);
	std::optional<contactdynamics::MeanField> cell;
	if (cellController) {
		otherStress = stressOfOtherContacts(*scene);
		cell = cellController->freeMotion(*scene, otherStress);
		plan.useVelGrad(cell->gradient);
	}
	step->collectBodies(*scene, plan);
	if (cell) step->useMeanField(*cell, plan);
	const Real scale = impulseTimeStep > 0 ? scene->dt / impulseTimeStep : 1;
	step->collectContacts(*scene, contactLaw, warmStart ? scale : 0);
	if (!step->problem.contacts.empty())
		if (const std::string forbidden = whatForbidsOtherContacts(*scene); !forbidden.empty())
			throw std::runtime_error("ContactDynamicsEngine: " + forbidden);
	step->usePlane();
	plane = PlaneOfMotion::nameOf(step->planeAxis);
	ambiguousContacts = yade::ambiguousContacts(step->problem);
}

void ContactDynamicsEngine::solve()
{
	const auto report = step->solve(tolerance, maxIterations, acceleration != "none");
	iterations = report.iterations;
	newtonSteps = report.newtonSteps;
	residual = report.residual;
	maxApproachSpeed = report.maxApproachSpeed;
	converged = report.status == contactdynamics::SolveStatus::converged;
	if (report.status == contactdynamics::SolveStatus::notFinite) {
		std::ostringstream message;
		message << "ContactDynamicsEngine: the contact problem of step " << scene->iter
				<< " has values that are not finite: velocities, external forces, inertia, contact geometry, or what O.dt = " << scene->dt
				<< " makes of them; no body was moved.";
		throw std::runtime_error(message.str());
	}
	if (cellController) {
		ContactDynamicsCellController::requireSmallStrain(*scene, step->problem.meanField->gradient);
		ContactDynamicsCellController::requireRoom(*scene, step->problem.meanField->gradient);
	}
	if (converged || onNonConvergence == "ignore") return;
	std::ostringstream message;
	const bool unsolvable = report.status == contactdynamics::SolveStatus::unbounded;
	if (unsolvable)
		message << "ContactDynamicsEngine: step " << scene->iter
				<< ": the contact problem has no solution: bodies are pressed from opposite sides by bodies or a periodic cell "
				<< "whose motion is given, and impulses without bound do not stop them (largest approach speed left " << maxApproachSpeed
				<< " m/s). Stop the walls or the cell, or let a force or a stress drive them.";
	else
		message << "ContactDynamicsEngine: step " << scene->iter << ": residual " << residual << " after " << iterations
				<< " sweeps is above the tolerance " << tolerance << " (" << step->problem.contacts.size()
				<< " contacts, largest approach speed left " << maxApproachSpeed << " m/s). Raise maxIterations or tolerance, or lower O.dt.";
	if (onNonConvergence == "raise") throw std::runtime_error(message.str());
	bool& warned = unsolvable ? warnedOfUnsolvable : warnedOfUnconverged;
	if (!warned) std::cerr << "WARNING: " << message.str() << " Said once; see ContactDynamicsEngine.converged." << std::endl;
	warned = true;
}

void ContactDynamicsEngine::apply()
{
	step->elasticEnergy = elasticEnergy;
	step->apply(*scene);
	if (cellController) cellController->apply(*scene, step->problem.meanField->gradient, step->moment(), otherStress);
	elasticEnergy = step->elasticEnergy;
	impulseTimeStep = scene->dt;
	contacts = static_cast<int>(step->problem.contacts.size());
	activeContacts = step->activeContacts;
	maxPenetration = step->maxPenetration;
	meanPenetration = step->meanPenetration;
}

void ContactDynamicsEngine::repair()
{
	const Matrix3r cellMobility = cellController ? cellController->mobilityForRepair(*scene) : Matrix3r(Matrix3r::Zero());
	// Where part of the cell's strain is under stress and part is given, a jammed packing may have nowhere to go, and the stress would pull against
	// the repair for ever.
	const bool rests = cellController && cellController->stressMask != 0 && cellMobility.isZero(0);
	step->repairPenetration(*scene, rests ? 0 : repairRate, allowedOverlap, cellMobility);
	if (cellController) cellController->yieldToRepair(*scene, step->repairStrain, otherStress);
	remainingOverlap = step->remainingOverlap;
	repairDisplacement = step->repairDisplacement;
	warnOfOverlap();
}

/// Overlaps this deep are nothing that repair would undo in a while. The residual bounds velocities; what it leaves of them moves bodies by as much
/// as O.dt allows, and where centres pass each other contact is lost.
void ContactDynamicsEngine::warnOfOverlap()
{
	const ContactDynamicsStep::Overlap& worst = step->worstOverlap;
	if (warnedOfOverlap || !(worst.share > 0)) return;
	warnedOfOverlap = true;
	std::cerr << "WARNING: ContactDynamicsEngine: step " << scene->iter << ": bodies #" << worst.id1 << " and #" << worst.id2 << " overlap by "
			  << worst.depth << " m, " << worst.share << " of their size. They were placed so, or they move too far in a step: O.dt = " << scene->dt
			  << ", largest approach speed left by the solve " << maxApproachSpeed
			  << " m/s. Bodies whose centres pass each other are lost to contact. Said once; see ContactDynamicsEngine.remainingOverlap."
			  << std::endl;
}

boost::python::list ContactDynamicsEngine::freeVelocities() const { return step->velocitiesById(step->free()); }
boost::python::list ContactDynamicsEngine::predictedVelocities() const { return step->velocitiesById(step->end()); }
boost::python::list ContactDynamicsEngine::predictedAngularMomenta() const { return step->angularMomentaById(); }
boost::python::dict ContactDynamicsEngine::lastProblem() const { return step->asDictionary(); }
boost::python::dict ContactDynamicsEngine::convergenceNorms() const { return step->normsAsDictionary(); }

} // namespace yade
