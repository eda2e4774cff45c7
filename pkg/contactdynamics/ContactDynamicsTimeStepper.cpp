// SPDX-License-Identifier: GPL-2.0-or-later
#include "ContactDynamicsTimeStepper.hpp"
#include "AdmittedValues.hpp"
#include "LargestRates.hpp"
#include "RefuseAttribute.hpp"
#include <core/Scene.hpp>
#include <pkg/common/Collider.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace yade {

YADE_PLUGIN((ContactDynamicsTimeStepper));

namespace {
void require(bool fulfilled, const char* attribute, Real value, const char* allowed)
{
	if (!fulfilled) refuseAttribute(std::string("ContactDynamicsTimeStepper.") + attribute, value, allowed);
}
bool positive(Real value) { return value > 0 && std::isfinite(value); }
bool notNegative(Real value) { return value >= 0 && std::isfinite(value); }

/// The largest h with h (v + h g) <= way, without cancellation; infinite if nothing moves.
Real stepFor(Real way, Real speed, Real acceleration) { return 2 * way / (speed + std::sqrt(speed * speed + 4 * acceleration * way)); }

void requirePlace(const Scene& scene, const Engine& self)
{
	for (const auto& other : scene.engines) {
		if (other.get() == &self) return;
		if (!other || other->dead || !dynamic_cast<const Collider*>(other.get())) continue;
		throw std::runtime_error(
				"ContactDynamicsTimeStepper: it stands behind the collider (" + other->getClassName() +
				") in O.engines, which has to look for contacts as far as the new time step carries the bodies; put it before, behind ForceResetter. "
				"contactdynamics.engines(timeStepper=True) returns a list in the right order.");
	}
}
} // namespace

void ContactDynamicsTimeStepper::postLoad(ContactDynamicsTimeStepper&)
{
	admit(attributes(), admitted, [this] {
		require(positive(maxDisplacement), "maxDisplacement", maxDisplacement, "it must be positive and finite");
		require(positive(maxRotation), "maxRotation", maxRotation, "it must be positive and finite");
		require(notNegative(proximityDistance), "proximityDistance", proximityDistance, "it must be finite and not negative");
		require(notNegative(minTimeStep), "minTimeStep", minTimeStep, "it must be finite and not negative");
		require(notNegative(maxTimeStep), "maxTimeStep", maxTimeStep, "it must be finite and not negative");
		require(maxTimeStep == 0 || maxTimeStep >= minTimeStep, "maxTimeStep", maxTimeStep, "it must not be below minTimeStep");
		require(growth >= 1 && std::isfinite(growth), "growth", growth, "it must be finite and at least 1");
	});
}

void ContactDynamicsTimeStepper::computeTimeStep(Scene* scene)
{
	requirePlace(*scene, *this);
	const LargestRates rates(*scene);
	Real h = std::numeric_limits<Real>::infinity();
	limitedBy.clear();
	const auto bound = [&](Real largest, const char* name) {
		if (!(largest < h)) return;
		h = largest;
		limitedBy = name;
	};
	if (rates.smallestRadius > 0) bound(stepFor(maxDisplacement * rates.smallestRadius, rates.speed, rates.acceleration), "displacement");
	// Two bodies may come towards each other: each of them gets half of the distance.
	if (proximityDistance > 0) bound(stepFor(0.5 * proximityDistance, rates.speed, rates.acceleration), "proximity");
	if (rates.rotation > 0) bound(maxRotation / rates.rotation, "rotation");
	if (maxTimeStep > 0) bound(maxTimeStep, "maxTimeStep");
	if (!std::isfinite(h)) return;
	// The first step has no step before it to grow from; O.dt of then is whatever YADE starts with.
	if (scene->iter > 0 && scene->dt > 0) bound(growth * scene->dt, "growth");
	if (h < minTimeStep) {
		h = minTimeStep;
		limitedBy = "minTimeStep";
	}
	scene->dt = h;
}

} // namespace yade
