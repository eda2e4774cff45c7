// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/TimeStepper.hpp>
#include <tuple>

namespace yade {

class ContactDynamicsTimeStepper : public TimeStepper {
public:
	void computeTimeStep(Scene* scene) override;
	/// Refuses inadmissible attributes at once (Python: ValueError) and puts the last admissible values back.
	void postLoad(ContactDynamicsTimeStepper&);
	virtual ~ContactDynamicsTimeStepper() = default;

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS(ContactDynamicsTimeStepper,TimeStepper,
		"Sets ``O.dt`` before every step from the motion of the bodies, for :yref:`ContactDynamicsEngine`: rigid contacts have no stiffness to take a time step from, so what limits the step is how far bodies go in it. "
		"With v the largest speed of a body (and the strain rate of a periodic cell times the smallest radius), g the magnitude of gravity (and permanent force over mass, and what a prescribed stress accelerates cell or wall with), d the way allowed and ω the largest rate of rotation, h is the largest step with h·(v + h·g) ≤ d and h·ω ≤ :yref:`maxRotation<ContactDynamicsTimeStepper.maxRotation>`. "
		"It shrinks at once and grows by at most :yref:`growth<ContactDynamicsTimeStepper.growth>` a step. A fast body does not tunnel, because candidates for contact are looked for as far as the step can carry it (``..._Proximity`` functors), "
		"and does not slow the scene down by more than its own way requires. Impulses kept for the warm start are rescaled by the engine. \n\n"
		"Stands behind :yref:`ForceResetter` and before the collider, which has to know the step to come (``contactdynamics.engines(timeStepper=True)``); behind the collider RuntimeError. If nothing moves and nothing accelerates, ``O.dt`` stays as it is. "
		"Positions and velocities that are not finite are left to the engine, which names the body.",
		((Real,maxDisplacement,0.25,Attr::triggerPostLoad,"Largest way of a body in a step, in radii of the smallest sphere or of the ball inside the thinnest block [-], > 0. The direction of contacts is taken at the start of the step, so this is also the angle by which a contact can be misjudged. Default 0.25."))
		((Real,maxRotation,0.5,Attr::triggerPostLoad,"Largest turn of a body in a step [rad], > 0; also the largest strain of the periodic cell in a step [-]. Default 0.5."))
		((Real,proximityDistance,0,Attr::triggerPostLoad,"For functors with a fixed distance of detection: largest gap at which they make a contact [m], for YADE's spheres (interactionDetectionFactor − 1) times the sum of the two smallest radii. Two bodies then do not approach by more than that in a step. "
			"0 (default): no such limit, the ``..._Proximity`` functors adapt themselves."))
		((Real,minTimeStep,0,Attr::triggerPostLoad,"Smallest time step [s], ≥ 0; wins over all limits from motion. Default 0: none."))
		((Real,maxTimeStep,0,Attr::triggerPostLoad,"Largest time step [s], ≥ 0 and not below :yref:`minTimeStep<ContactDynamicsTimeStepper.minTimeStep>`; 0 (default): none but those from motion. "
			"Springs do not enter the motion looked at: scenes with compliant contacts (:yref:`kn<ContactDynamicsMat.kn>`) need a fiftieth of their period here, those with soft laws the stable step of these."))
		((Real,growth,1.2,Attr::triggerPostLoad,"Largest ratio of two successive time steps [-], ≥ 1. Default 1.2: after an impact the step is back at ten times its length in 13 steps."))
		((string,limitedBy,"",Attr::readonly,"What determined the last time step: ``displacement``, ``rotation``, ``proximity``, ``growth``, ``minTimeStep``, ``maxTimeStep``, or nothing (empty) if nothing moves."))
	);
	// clang-format on
private:
	std::tuple<Real&, Real&, Real&, Real&, Real&, Real&> attributes()
	{
		return {maxDisplacement, maxRotation, proximityDistance, minTimeStep, maxTimeStep, growth};
	}
	std::tuple<Real, Real, Real, Real, Real, Real> admitted{attributes()};
};
REGISTER_SERIALIZABLE(ContactDynamicsTimeStepper);

} // namespace yade
