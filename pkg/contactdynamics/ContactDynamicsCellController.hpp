// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/GlobalEngine.hpp>
#include <pkg/solver/GrainProblem.hpp>
#include <limits>
#include <tuple>

namespace yade {

class ContactDynamicsCellController : public GlobalEngine {
public:
	/// Only checks that a ContactDynamicsEngine is there: it moves the cell, within its solve.
	void action() override;
	/// Refuses inadmissible attributes at once (Python: ValueError) and puts the last admissible values back.
	void postLoad(ContactDynamicsCellController&);
	virtual ~ContactDynamicsCellController() = default;

	/// Free motion of the cell in this step: its velocity gradient without contact impulses, and its inertia.
	/// @param otherStress  of interactions that are not part of the solve [Pa]
	/// @throws std::runtime_error  not periodic, homoDeform 0, or an attribute that is not admissible
	contactdynamics::MeanField freeMotion(const Scene& scene, const Matrix3r& otherStress);
	/// @throws std::runtime_error  the step would deform the cell so far that pairs in contact are no longer those the collider found
	static void requireSmallStrain(const Scene& scene, const Matrix3r& gradient);
	/// Hands the gradient at the solution to the cell and reports.
	/// @param moment  see ContactDynamicsStep::moment() [N m s]
	void apply(Scene& scene, const Matrix3r& gradient, const Matrix3r& moment, const Matrix3r& otherStress);
	/// How far the cell gives way to penetration repair, 1/M by component of the strain [1/(kg m2)]: if all three normal components are under stress,
	/// those under stress with the default inertia, because the one in use may be of any size, and here it is only a measure. Zero otherwise.
	Matrix3r mobilityForRepair(const Scene& scene) const;
	/// Strains the cell with penetration repair, without velocity. The work of the stress is booked as that of forces is, see
	/// ContactEnergy::reportRepair().
	void yieldToRepair(Scene& scene, const Matrix3r& strain, const Matrix3r& otherStress);

	/// What may come in the next step, for those who look ahead: the reach of bodies, the time step.
	struct Outlook {
		Real rate = 0;		   ///< norm of the velocity gradient if the contacts resist as in the last step [1/s]
		Real acceleration = 0; ///< norm of its rate of change if they do not resist at all [1/s2]
	};
	Outlook outlook(const Scene& scene) const;
	static constexpr Real largestStrain = 0.5; ///< of a step [-]: beyond, pairs in contact are no longer those the collider found
	/// @throws std::runtime_error  with the gradient of the coming step a movable body would reach over half of the cell, and so touch another one
	///         twice, or itself
	static void requireRoom(const Scene& scene, const Matrix3r& gradient);

private:
	void requireAdmissible() const;
	bool controlsStress(int row, int column) const;
	Real inertiaFor(const Scene& scene) const;
	static Real inertiaOfBodies(const Scene& scene);

public:
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS(ContactDynamicsCellController,GlobalEngine,
		"Deforms the periodic cell at prescribed stress or prescribed rate, component by component, for :yref:`ContactDynamicsEngine`. Rigid contacts have no stiffness from which a servo could tell how far to move the cell, and a jammed packing of rigid grains resists any compression whatever; "
		"so the cell is a body of the contact problem. Its velocity gradient L enters the relative velocity of every contact as L·b, b the vector between the two centres across periods, and obeys, for the components under stress, \n\n"
		".. math:: M\\,(L^{+} - L^{-}) = h\\,V\\,(\\sigma_{\\mathrm{goal}} - \\sigma), \\qquad V\\sigma = -\\sum_c \\mathrm{sym}(R_c \\otimes b_c) \n\n"
		"in the same solve, at the end of the same step, as Signorini's condition and Coulomb's law. At rest the stress is the goal, to the tolerance of the solve; in motion it differs by M·dL/dt/V. "
		"Stress is that of ``utils.getStress()``: Cauchy stress of the contact forces, positive in tension, without the kinetic part; soft contacts of the scene count. \n\n"
		"Stands anywhere before :yref:`ContactDynamicsEngine` in ``O.engines``; :yref:`homoDeform<Cell.homoDeform>` must not be 0 and :yref:`NewtonIntegrator.mask` 0. It determines ``O.cell.velGrad``: what a script writes there has no effect while the controller is alive. :yref:`Cell.trsf` tells the strain, that by penetration repair included: overlaps of a jammed packing leave it only if the cell grows. "
		"An engine of YADE that steers the cell (:yref:`PeriTriaxController`, :yref:`Peri3dController`, :yref:`PeriIsoCompressor`) may not be alive beside it. Errors (RuntimeError from the step, before anything moves) name attribute, value and what is allowed.",
		((Matrix3r,stress,Matrix3r::Zero(),Attr::triggerPostLoad,"Goal of the components under stress [Pa], positive in tension, so ``-p`` on the diagonal for a pressure p; symmetric. Others are ignored. May be changed at any time. Not symmetric or not finite: ValueError."))
		((Matrix3r,velGrad,Matrix3r::Zero(),Attr::triggerPostLoad,"Velocity gradient of the components not under stress [1/s], ``velGrad[i,j]`` = ∂v_i/∂x_j, as :yref:`Cell.velGrad`. Of a shear component under stress the difference ``velGrad[i,j] - velGrad[j,i]``, a rotation of the cell, remains prescribed. Not finite: ValueError."))
		((int,stressMask,7,Attr::triggerPostLoad,"Which components are under stress: sum of 1 (xx), 2 (yy), 4 (zz), 8 (yz), 16 (zx) and 32 (xy) [-], 0 … 63, as in :yref:`Peri3dController.stressMask`. Default 7: pressure on three sides, shear at given rate."))
		((Real,inertia,0,Attr::triggerPostLoad,"Inertia M of the cell [kg·m²], ≥ 0; its kinetic energy is M·(L:L)/2 over the components under stress. 0 (default): a third of the mass of all movable bodies times (V/N)^(2/3), N their number and V the volume in the first step, that is about the square of a diameter; kept in :yref:`inertiaInUse<ContactDynamicsCellController.inertiaInUse>`. "
			"At that the cell follows within a time d·sqrt(density/pressure), like the grains, and costs the solver few sweeps; a lighter cell holds the stress closer in fast motion but needs more sweeps, a heavier one lets it fluctuate more. Negative or not finite: ValueError."))
		((Real,maxStrainRate,std::numeric_limits<Real>::infinity(),Attr::triggerPostLoad,"Largest magnitude of a component of the symmetric velocity gradient under stress [1/s], > 0, held by whatever force it takes (strain by penetration repair does not count): a loose assembly is then compressed at this rate instead of being accelerated. Where the bound acts the stress is below its goal. Default: infinite."))
		((Matrix3r,currentStress,Matrix3r::Zero(),Attr::readonly,"Stress in the last step [Pa], as :yref:`stress<ContactDynamicsCellController.stress>`; equal to ``utils.getStress()`` evaluated behind :yref:`ContactDynamicsEngine`, before the bodies move, but for what penetration repair has moved them and the cell by."))
		((Real,inertiaInUse,0,Attr::readonly,"Inertia in the last step [kg·m²]; 0 before the first."))
		((Real,work,0,Attr::readonly,"Work done by the cell on its contents since the start [J]: sum of h·V·σ:(L⁻+L⁺)/2, and of V·σ_goal:E for strains E by penetration repair. With ``O.trackEnergy`` its negative is ``O.energy['velGradWork']``, as of :yref:`PeriTriaxController`."))
	);
	// clang-format on
private:
	std::tuple<Matrix3r&, Matrix3r&, int&, Real&, Real&> attributes() { return {stress, velGrad, stressMask, inertia, maxStrainRate}; }
	std::tuple<Matrix3r, Matrix3r, int, Real, Real> admitted{attributes()};
};
REGISTER_SERIALIZABLE(ContactDynamicsCellController);

} // namespace yade
