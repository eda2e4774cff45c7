// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/GlobalEngine.hpp>
#include <boost/python.hpp>
#include <memory>
#include <tuple>

namespace yade {

class ContactDynamicsCellController;

class ContactDynamicsEngine : public GlobalEngine {
public:
	/// One step: gather the scene into a problem, solve it in place, scatter the reactions into O.forces and the contacts.
	void action() override;
	/// Refuses inadmissible attributes at once (Python: ValueError) and puts the last admissible values back.
	void postLoad(ContactDynamicsEngine&);
	virtual ~ContactDynamicsEngine();

	boost::python::list freeVelocities() const;
	boost::python::list predictedVelocities() const;
	boost::python::list predictedAngularMomenta() const;
	boost::python::dict lastProblem() const;
	boost::python::dict convergenceNorms() const;

private:
	struct Step; // problem, solver and what connects them with the scene; kept between steps so that memory is allocated once
	std::shared_ptr<Step> step;
	ContactDynamicsCellController* cellController = nullptr; // of this step
	Matrix3r otherStress = Matrix3r::Zero();				 // of interactions that are not part of the solve, where the cell has a controller [Pa]

	void collect();
	void solve();
	void apply();
	void repair();
	void warnOfOverlap();

	void requireAdmissible() const;
	bool warnedOfUnconverged = false, warnedOfUnsolvable = false, warnedOfOverlap = false;

public:
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(ContactDynamicsEngine,GlobalEngine,
		"Non-smooth contact dynamics (M. Jean, The non-smooth contact dynamics method, CMAME 177, 1999; equation numbers are his): solves the implicit Signorini–Coulomb problem "
		"of all contacts whose physics is :yref:`ContactDynamicsPhys` and adds the reactions to ``O.forces``, so that the :yref:`NewtonIntegrator` behind it arrives at velocities that satisfy "
		"the contact law. Stands just before ``NewtonIntegrator(damping=0)`` and after :yref:`ForceResetter`, the collider and :yref:`InteractionLoop`; soft contact laws may act beside it, their forces count as external. "
		"``contactdynamics.engines()`` makes the whole list. \n\nThe velocity without contact (free velocity) is predicted exactly as the integrator computes it: blocked degrees of freedom, clumps, "
		":yref:`mask<NewtonIntegrator.mask>`, density scaling, permanent forces and the periodic cell included. For :yref:`aspherical<Body.aspherical>` bodies the integrator advances the angular momentum; the contact law then holds "
		"for the angular velocity with the orientation at the start of the step, and the ``angVel`` seen afterwards differs by the turn of one step (order ``O.dt``). \n\nThe result is the same, bit for bit, for any number of threads and across ``O.save``/``O.load``. "
		"Errors (RuntimeError from ``O.step()``/``O.run(wait=True)``, scene left as it was before the integrator): engines in the wrong order or damping ≠ 0; ``O.dt`` ≤ 0 or not finite; position, velocity, mass, inertia, friction or gap not finite or not admissible.",
		((Real,tolerance,1e-4,Attr::triggerPostLoad,"Bound on :yref:`residual<ContactDynamicsEngine.residual>` at which the solve stops [-], > 0. 1e-3 serves quasi-static flow, 1e-6 and less force chains and verification. Default: overlaps stay below about 1e-4 of a radius. While a scene with polyhedra or moving boxes stands still (less kinetic energy than one step of the forces from rest would give), up to 200 sweeps go on to round-off (1e-12, or what the round-off of the coordinates allows), so that stacks do not sway."))
		((int,maxIterations,3000,Attr::triggerPostLoad,"Largest number of sweeps over all contacts in a step [-], ≥ 1. Default: nearly all steps of packings with friction are solved by then (with the customary 1000, one in 5 to 100 of some is not, and what is left comes back in the next step). What happens when it is reached is decided by :yref:`onNonConvergence<ContactDynamicsEngine.onNonConvergence>`."))
		((string,contactLaw,"quasiInelasticShock",Attr::triggerPostLoad,"Contact condition with U⁺ the normal velocity after the step, g the gap and h the time step: ``quasiInelasticShock`` 0 ≤ U⁺ + max(0,g)/h ⟂ R ≥ 0 (25), default, for collections of rigid bodies; "
			"``velocitySignorini`` 0 ≤ U⁺ ⟂ R ≥ 0 (23) if contact is forecast, that is g ≤ 0 or g + hU ≤ 0 for the velocity at the start of the step or the free velocity; ``signorini`` 0 ≤ U⁺ + g/h ⟂ R ≥ 0 (22), (24), which also pushes overlaps apart and so may add energy to large collections of rigid bodies. Another name raises ValueError."))
		((bool,warmStart,true,,"Start the solve from the impulses of the last step, scaled to the present time step. Default True: saves most of the sweeps and selects the solution that follows the history of loading (Jean 1999, section 8). False starts from zero."))
		((string,onNonConvergence,"warn",Attr::triggerPostLoad,"What to do when :yref:`maxIterations<ContactDynamicsEngine.maxIterations>` sweeps leave the residual above the tolerance: ``warn`` (default) says so once on standard error and goes on with the impulses reached (admissible: inside the cone), ``raise`` stops the step with a RuntimeError before the bodies move, ``ignore`` goes on. "
			":yref:`converged<ContactDynamicsEngine.converged>` tells in every case."))
		((string,acceleration,"default",Attr::triggerPostLoad,"What is done between the sweeps of the nonlinear block Gauss–Seidel loop (section 5.4): ``default`` momentum with restart, parts that it cannot settle solved on their own, and plain sweeps set against it where it stalls; ``none`` nothing, the plain loop of the paper, contact after contact from the impulses handed over. Both stop on the same certificate, so velocities agree to the tolerance; where the impulses are not unique (section 8) ``none`` stays "
			"closest to the history of loading and ``default`` needs far fewer sweeps. The order of the contacts follows from where the bodies are, the same for both and for any number of threads. Another name raises ValueError."))
		((int,contacts,0,Attr::readonly,"Number of contacts in the last solve: candidates that the two bodies may close within a step, touching or not [-]."))
		((int,activeContacts,0,Attr::readonly,"Number of contacts that carry an impulse after the last solve [-]."))
		((int,iterations,0,Attr::readonly,"Sweeps of the last solve [-]; sweeps over some of the contacts count by their share."))
		((int,newtonSteps,0,Attr::readonly,"Newton steps of the last solve [-], for a few contacts at a time, around those that sweeps make go round in circles (a light grain between heavy ones, friction near its limit); each takes as long as 4 (24 contacts) to 70 (100 contacts) sweeps over a thousand contacts. 0 in most steps, and with :yref:`acceleration<ContactDynamicsEngine.acceleration>` ``none``."))
		((Real,residual,0,Attr::readonly,"Certificate of the last solve [-]: norm of the natural map F = r − P(r − (u + μ|u_T|n)/W_NN) of all contacts over the norm of their impulses r, both weighted with the local Delassus operator W (so it does not depend on units); P projects on Coulomb's cone. Rolling and twisting friction add the maps of their torques to both. It is the error of the projection equations (2), (7) at the impulses applied, not the size of the last update."))
		((bool,converged,true,Attr::readonly,"Whether the last residual met the tolerance, and not by impulses that grow without bound: where a grain is squeezed between walls with given motion there is no solution, and False is said although any residual relative to the impulses becomes small in the end."))
		((string,plane,"",Attr::readonly,"Plane of a two-dimensional scene, recognised in every step: ``xy``, ``yz`` or ``zx`` if all movable bodies have the other translation and rotations blocked (:yref:`blockedDOFs<State.blockedDOFs>` ``zXY``, ``xYZ``, ``yZX``) and all contacts lie in that plane; empty otherwise. "
			"Contacts are then solved by the closed form (34). ``contactdynamics.plane`` makes the disks."))
		((int,ambiguousContacts,0,Attr::readonly,"Number of contacts in the last solve that violate the condition (33) for a unique solution, μ|W_TN| < W_NN with W the local Delassus operator and W_TN its coupling of tangential impulse and normal velocity [-]. Such a contact of a rigid body has several solutions or none (Painlevé's paradox): one of them is taken, sticking before sliding. "
			"In three dimensions |W_TN| is the norm of both components and the condition is sufficient. Spheres that are not in clumps always fulfil it."))
		((Real,maxPenetration,0,Attr::readonly,"Largest overlap of two bodies at the positions the last solve started from [m], ≥ 0."))
		((Real,meanPenetration,0,Attr::readonly,"Mean overlap of the active contacts at the positions the last solve started from, those with a gap counted as 0 [m]."))
		((Real,maxApproachSpeed,0,Attr::readonly,"Largest speed at which a contact still violates its condition after the last solve, max(0, −(U_N + max(0,g)/h)) for the default law [m/s]; divided by the speed gravity gives in a step, h·g, it tells what the residual means in motion."))
		((Real,repairRate,0.1,Attr::triggerPostLoad,"Share of the overlap beyond :yref:`allowedOverlap<ContactDynamicsEngine.allowedOverlap>` that penetration repair takes away in a step [-], 0 … 1, all overlaps in the same proportion: so much that the deepest one shrinks by 1e-4 of its contact's size, but at least 0.006 and at most this rate. "
			"Overlaps, left by the residual of the solve or by a packing made with a soft law, are removed by displacing the bodies (pseudo-velocities from a frictionless contact problem in which loaded contacts stay closed; true masses, no rotation, blocked translations kept; a periodic cell with all normal components under stress is strained with them); velocities and impulses do not change, so no kinetic energy comes from it. What bodies gain in weight times height is ``contactRepair`` in ``O.energy``. "
			"Default 0.1: gentle enough that supported grains stay supported; takes 2 % of a step of many sweeps, up to a tenth of one with a few, nothing in a step without overlaps (``scripts/bench repair``). 0 switches it off; then overlaps stay as they are. It rests while a :yref:`ContactDynamicsCellController` prescribes some, but not all three normal components of stress, because a jammed packing may then have nowhere to go. A value outside raises ValueError. A step without overlaps is the same, bit for bit, with and without repair."))
		((Real,allowedOverlap,1e-5,Attr::triggerPostLoad,"Overlap that :yref:`repairRate<ContactDynamicsEngine.repairRate>` leaves alone, in sizes of the contact [-], ≥ 0: the radius of the smaller sphere, the shorter lever arm where there is no sphere. Deeper ones are brought to half of it; of several points between two blocks, the shallowest that carries a force decides, and deeper ones stay, up to 1e-3 sizes. Default 1e-5: contacts at rest stay closed instead of opening and closing by round-off. A negative value raises ValueError."))
		((Real,remainingOverlap,0,Attr::readonly,"Largest overlap left at the end of the last step, after repair [m], ≥ 0; an overlap counts that is there at the start of the step and that its motion does not remove. A warning is given, once, when two bodies would end a step, without repair, with an overlap of more than 0.1 of the smaller radius (half the thickness of a block along the normal): placed so, or ``O.dt`` too large."))
		((Real,repairDisplacement,0,Attr::readonly,"Largest displacement of a body by penetration repair in the last step [m], relative to a cell that it strains, plus the largest change of the distance of two neighbours by that strain; at most 1e-2 of the smallest size of a contact."))
		((Real,impulseTimeStep,0,(Attr::readonly|Attr::hidden),"Time step of the impulses stored with the contacts [s]."))
		((Real,elasticEnergy,0,(Attr::readonly|Attr::hidden),"Elastic energy of compliant contacts after the last step with O.trackEnergy [J]."))
		,
		/*ctor*/ timingDeltas = boost::shared_ptr<TimingDeltas>(new TimingDeltas); createStep();
		,
		/*py*/
		.def("freeVelocities",&ContactDynamicsEngine::freeVelocities,"Free velocities of the last step by body id: (velocity [m/s], angular velocity [rad/s]) at the end of the step without contact impulses; ``None`` for ids that NewtonIntegrator does not move itself (erased bodies, clump members, bodies left out by its mask).")
		.def("predictedVelocities",&ContactDynamicsEngine::predictedVelocities,"Velocities at the end of the last step with the contact impulses, as :yref:`freeVelocities<ContactDynamicsEngine.freeVelocities>`; NewtonIntegrator arrives at the same but for round-off (angular velocity of aspherical bodies: but for the turn of one step; where penetration repair strains a periodic cell by E: but for L·E·x, the difference of the mean field over the way E·x).")
		.def("predictedAngularMomenta",&ContactDynamicsEngine::predictedAngularMomenta,"Angular momenta [kg·m²/s] at the end of the last step by body id, of aspherical bodies with exact rotation; ``None`` for all other ids.")
		.def("lastProblem",&ContactDynamicsEngine::lastProblem,"The contact problem of the last step with its solution, as a dictionary: u = W r + q, per contact 0 ≤ u_N ⟂ r_N ≥ 0 and Coulomb's law. ``dimension`` 3; W [1/kg] by rows of 3×3 blocks: those of row i are rowStart[i] … rowStart[i+1]−1 of ``column`` and ``blocks`` (nine numbers each, row by row); "
			"``q`` [m/s] relative velocity without contact impulses (torques of rolling friction, found with them, are in it), gap velocity max(0,g)/h (by contactLaw) added to its normal component; ``friction`` [-]; ``impulse`` r [N·s] and ``velocity`` u [m/s] of the solution, three numbers a contact in the frame of :yref:`ContactDynamicsPhys.localVelocity`, normal first; ``bodies`` the two ids of each contact (the clump of a member). "
			"W is assembled by this call. Where a :yref:`ContactDynamicsCellController` holds a stress, the motion of the cell is part of W: it is full then, and written out for at most 1000 contacts; a component of the strain rate that stands at its bound counts as given. ``contactdynamics.fclib.write`` puts all into a file. RuntimeError when no step has been solved, or when there are too many contacts for a full W.")
		.def("convergenceNorms",&ContactDynamicsEngine::convergenceNorms,"What other programs and papers call the error, at the solution of the last step, as a dictionary of numbers [-]; none steers the solver, and W is assembled by this call. With u = W r + q as in :yref:`lastProblem<ContactDynamicsEngine.lastProblem>`, ΔR the change of a contact's impulse R by one more exact local solution with all others held, ΔV = W_cc ΔR, "
			"sums and means over the ``active`` contacts (an impulse before or after): ``naturalMap`` the :yref:`residual<ContactDynamicsEngine.residual>` once more, from the assembled W (without the torques of rolling friction, which are in q); ``siconos`` √Σ|r − P(r − u − μ|u_T|n)|² / max(|q|, |r|, |u|), which adds impulses and velocities and so depends on units; ``quadDV`` √mean|ΔV|² / √mean|W_cc R|², "
			"``quadDVR`` √mean(|ΔV|²|R|²) / mean(R·W_cc R), ``meanDVoR`` Σ R·ΔV / Σ R·W_cc R: the norm Quad of LMGC90, which stops when all three are below its tolerance in magnitude; ``quadraticAccuracy`` √(Σ|ΔR|² / Σ|R|²) and ``largestAccuracy`` max|ΔR| / √mean|R|²: the quadratic and the max distance of section 8, in which the accuracy of 0.15 % in section 9.1 is read "
			"(the paper gives no formula). RuntimeError when no step has been solved.")
	);
	// clang-format on
private:
	void createStep();
	std::tuple<Real&, int&, string&, string&, string&, Real&, Real&> attributes()
	{
		return {tolerance, maxIterations, contactLaw, onNonConvergence, acceleration, repairRate, allowedOverlap};
	}
	std::tuple<Real, int, string, string, string, Real, Real> admitted{attributes()};
};
REGISTER_SERIALIZABLE(ContactDynamicsEngine);

} // namespace yade
