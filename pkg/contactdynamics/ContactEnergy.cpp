// SPDX-License-Identifier: GPL-2.0-or-later
#include "ContactEnergy.hpp"
#include "ContactDynamicsPhys.hpp"
#include <core/EnergyTracker.hpp>
#include <algorithm>

namespace yade {
namespace {
void addTo(EnergyTracker& tracker, const char* name, Real value, bool ofNow = false)
{
	int place = -1; // looked up by name: a remembered place would be wrong after O.energy.clear() or O.load()
	tracker.add(value, name, place, ofNow);
}
} // namespace

void ContactEnergy::add(const ContactDynamicsPhys& phys, const Vector3r& normal, const Vector3r& impulse, const Vector3r& start, const Vector3r& end,
						Real gap, bool isImpact, bool bonded)
{
	const Real normalImpulse = impulse.dot(normal);
	const Vector3r mean = 0.5 * (start + end);
	const Real normalLoss = -normalImpulse * mean.dot(normal);
	const Real tangentialLoss = -impulse.dot(mean) - normalLoss;
	(phys.kn > 0 ? compliant : bonded ? cohesion : isImpact ? restitution : impact) += normalLoss;
	(phys.ks > 0 ? compliant : friction) += tangentialLoss;
	if (phys.kn > 0 && (normalImpulse > 0 || bonded)) stored += 0.5 * phys.kn * (bonded ? gap * gap : std::pow(std::min(gap, Real(0)), 2));
}

void ContactEnergy::addStretch(const ContactDynamicsPhys& phys, Real timeStep)
{
	if (phys.ks > 0) stored += 0.5 * phys.ks * (phys.stretch - 0.5 * timeStep * phys.stretchRate).squaredNorm();
}

void ContactEnergy::reportRepair(EnergyTracker& tracker, Real work, Real known, const char* term)
{
	addTo(tracker, "contactRepair", work);
	if (known != 0) addTo(tracker, term, -known);
}

Real ContactEnergy::report(EnergyTracker& tracker, Real storedBefore) const
{
	const auto tell = [&](const char* name, Real value, bool ofNow = false) {
		if (value != 0 || ofNow) addTo(tracker, name, value, ofNow);
	};
	tell("contactFriction", friction);
	tell("contactRolling", rolling);
	tell("contactImpact", impact);
	tell("contactRestitution", restitution);
	tell("contactCohesion", cohesion);
	tell("contactBoundary", boundary);
	if (stored != 0 || storedBefore != 0) tell("contactElastic", stored, true);
	tell("contactDamping", compliant - (stored - storedBefore));
	return stored;
}

} // namespace yade
