// SPDX-License-Identifier: GPL-2.0-or-later
#include "ContactDynamicsCellController.hpp"
#include "AdmittedValues.hpp"
#include "BodySize.hpp"
#include "ContactEnergy.hpp"
#include "MovableBodies.hpp"
#include "RefuseAttribute.hpp"
#include <core/Cell.hpp>
#include <core/EnergyTracker.hpp>
#include <core/Scene.hpp>
#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace yade {

YADE_PLUGIN((ContactDynamicsCellController));

namespace {
std::string entry(const char* matrix, int row, int column) { return std::string(matrix) + '[' + "012"[row] + ',' + "012"[column] + ']'; }
void requireFinite(const char* name, const Matrix3r& matrix)
{
	for (int i = 0; i < 3; i++)
		for (int j = 0; j < 3; j++)
			if (!std::isfinite(matrix(i, j)))
				refuseAttribute("ContactDynamicsCellController." + entry(name, i, j), matrix(i, j), "it must be finite");
}
} // namespace

void ContactDynamicsCellController::requireAdmissible() const
{
	requireFinite("stress", stress);
	for (int i = 0; i < 3; i++)
		for (int j = 0; j < i; j++)
			if (std::abs(stress(i, j) - stress(j, i)) > 1e-12 * stress.norm())
				refuseAttribute("ContactDynamicsCellController." + entry("stress", i, j), stress(i, j),
								"stress must be symmetric, and the component across the diagonal is another");
	requireFinite("velGrad", velGrad);
	if (stressMask < 0 || stressMask > 63)
		refuseAttribute("ContactDynamicsCellController.stressMask", stressMask,
						"it must be a sum of 1 (xx), 2 (yy), 4 (zz), 8 (yz), 16 (zx), 32 (xy)");
	if (!(inertia >= 0 && std::isfinite(inertia)))
		refuseAttribute("ContactDynamicsCellController.inertia", inertia, "it must be finite and not negative (0: from the bodies)");
	if (!(maxStrainRate > 0)) refuseAttribute("ContactDynamicsCellController.maxStrainRate", maxStrainRate, "it must be positive");
}

void ContactDynamicsCellController::postLoad(ContactDynamicsCellController&)
{
	const Real before = std::get<3>(admitted);
	admit(attributes(), admitted, [this] { requireAdmissible(); });
	if (inertia == 0 && before > 0) inertiaInUse = 0; // to be taken from the bodies again; what a scene was saved with is kept
}

void ContactDynamicsCellController::action()
{
	for (const auto& engine : scene->engines)
		if (engine && !engine->dead && engine->getClassName() == "ContactDynamicsEngine") return;
	throw std::runtime_error(
			"ContactDynamicsCellController: there is no (live) ContactDynamicsEngine in O.engines, which moves the cell together with "
			"the contacts; put one behind this engine. contactdynamics.engines() returns a list with one.");
}

bool ContactDynamicsCellController::controlsStress(int row, int column) const { return stressMask & (1 << (row == column ? row : 6 - row - column)); }

/// Inertia that the step is made with; 0 if it is to come from the bodies and none is movable.
Real ContactDynamicsCellController::inertiaFor(const Scene& scene) const
{
	if (inertia > 0) return inertia;
	return inertiaInUse > 0 ? inertiaInUse : inertiaOfBodies(scene);
}

/// The default; 0 if no body is movable.
Real ContactDynamicsCellController::inertiaOfBodies(const Scene& scene)
{
	const auto bodies = MovableBodies::of(scene, [](const Body&) { return true; });
	return bodies.mass > 0 ? bodies.mass * std::pow(scene.cell->hSize.determinant() / bodies.count, Real(2) / 3) / 3 : 0;
}

ContactDynamicsCellController::Outlook ContactDynamicsCellController::outlook(const Scene& scene) const
{
	const Real M = inertiaFor(scene);
	if (!scene.isPeriodic || !(M > 0)) return {};
	const Matrix3r& now = scene.cell->velGrad;
	const Real perStress = scene.cell->hSize.determinant() / M;
	Matrix3r gradient = velGrad, push = Matrix3r::Zero();
	for (int i = 0; i < 3; i++)
		for (int j = 0; j < 3; j++) {
			if (!controlsStress(i, j)) continue;
			const Real stretch =
					0.5 * (now(i, j) + now(j, i)) + scene.dt * perStress * (stress(i, j) - 0.5 * (currentStress(i, j) + currentStress(j, i)));
			gradient(i, j) = std::clamp(stretch, -maxStrainRate, maxStrainRate) + 0.5 * (velGrad(i, j) - velGrad(j, i));
			push(i, j) = perStress * stress(i, j);
		}
	return {gradient.norm(), push.norm()};
}

contactdynamics::MeanField ContactDynamicsCellController::freeMotion(const Scene& scene, const Matrix3r& otherStress)
{
	if (!scene.isPeriodic) throw std::runtime_error("ContactDynamicsCellController: the scene is not periodic (O.periodic is False).");
	const Cell& cell = *scene.cell;
	if (cell.homoDeform < Cell::HOMO_POS)
		throw std::runtime_error("ContactDynamicsCellController: O.cell.homoDeform is " + std::to_string(cell.homoDeform) +
								 "; it must be at least 1, so that the bodies follow the cell.");
	requireAdmissible(); // again: Python writes single components of a matrix past postLoad()
	const Real volume = cell.hSize.determinant();
	inertiaInUse = inertiaFor(scene);
	if (!(inertiaInUse > 0))
		throw std::runtime_error(
				"ContactDynamicsCellController.inertia = 0: it cannot be taken from the bodies, because none is movable and has mass.");

	contactdynamics::MeanField field;
	field.limit = maxStrainRate;
	field.gradient = velGrad;
	for (int i = 0; i < 3; i++)
		for (int j = 0; j < 3; j++) {
			if (!controlsStress(i, j)) continue;
			const Real rate = 0.5 * (cell.velGrad(i, j) + cell.velGrad(j, i)), goal = 0.5 * (stress(i, j) + stress(j, i)),
					   other = 0.5 * (otherStress(i, j) + otherStress(j, i));
			field.gradient(i, j) = rate + scene.dt * volume / inertiaInUse * (goal - other) + 0.5 * (velGrad(i, j) - velGrad(j, i));
			field.inverseMass(i, j) = 1 / inertiaInUse;
		}
	return field;
}

void ContactDynamicsCellController::requireSmallStrain(const Scene& scene, const Matrix3r& gradient)
{
	const Real strain = scene.dt * gradient.cwiseAbs().maxCoeff();
	if (strain < largestStrain) return;
	std::ostringstream message;
	message << "ContactDynamicsCellController: the cell would be strained by " << strain << " in this step (O.dt = " << scene.dt << "); at most "
			<< largestStrain << " is allowed. Lower O.dt or set maxStrainRate.";
	throw std::runtime_error(message.str());
}

void ContactDynamicsCellController::requireRoom(const Scene& scene, const Matrix3r& gradient)
{
	const Cell& cell = *scene.cell;
	const Matrix3r hSize = cell.hSize + scene.dt * gradient * cell.hSize;
	for (int axis = 0; axis < 3; axis++) {
		const Vector3r normal = hSize.col((axis + 1) % 3).cross(hSize.col((axis + 2) % 3)).normalized();
		const Real width = std::abs(normal.dot(hSize.col(axis)));
		for (const auto& body : *scene.bodies) {
			if (!(body->isDynamic() || body->isClumpMember())) continue;
			const Real extent = extentAlong(*body, normal);
			if (2 * extent < width) continue;
			std::ostringstream message;
			message << "ContactDynamicsCellController: body #" << body->getId() << " (" << body->shape->getClassName() << ") is " << extent
					<< " wide, and with this step the periodic cell would be " << width << " wide across its edge " << axis
					<< "; it must be more than twice as wide as a body, because YADE knows one contact of two bodies only, and none of a body with "
					   "itself. Use more bodies, or stop compressing the cell.";
			throw std::runtime_error(message.str());
		}
	}
}

void ContactDynamicsCellController::apply(Scene& scene, const Matrix3r& gradient, const Matrix3r& moment, const Matrix3r& otherStress)
{
	Cell& cell = *scene.cell;
	const Real volume = cell.hSize.determinant();
	currentStress = otherStress - moment / (scene.dt * volume);
	const Real added = scene.dt * volume * currentStress.cwiseProduct(0.5 * (cell.velGrad + gradient)).sum();
	work += added;
	int place = -1; // looked up by name, see ContactEnergy
	if (scene.trackEnergy) scene.energy->add(-added, "velGradWork", place);
	cell.nextVelGrad = gradient; // NewtonIntegrator puts it into effect
	cell.velGradChanged = true;
}

Matrix3r ContactDynamicsCellController::mobilityForRepair(const Scene& scene) const
{
	Matrix3r mobility = Matrix3r::Zero();
	if (!controlsStress(0, 0) || !controlsStress(1, 1) || !controlsStress(2, 2)) return mobility;
	const Real M = inertiaOfBodies(scene);
	if (!(M > 0)) return mobility;
	for (int i = 0; i < 3; i++)
		for (int j = 0; j < 3; j++)
			if (controlsStress(i, j)) mobility(i, j) = 1 / M;
	return mobility;
}

void ContactDynamicsCellController::yieldToRepair(Scene& scene, const Matrix3r& strain, const Matrix3r& otherStress)
{
	if (strain.isZero(0)) return;
	Cell& cell = *scene.cell;
	const Real volume = cell.hSize.determinant(), ofGoal = volume * stress.cwiseProduct(strain).sum();
	work += ofGoal;
	if (scene.trackEnergy)
		ContactEnergy::reportRepair(*scene.energy, ofGoal - volume * otherStress.cwiseProduct(strain).sum(), ofGoal, "velGradWork");
	cell.hSize += strain * cell.hSize;
	cell.trsf += strain * cell.trsf;
	cell.integrateAndUpdate(0); // all else that the cell derives from them
}

} // namespace yade
