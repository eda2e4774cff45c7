// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/GlobalEngine.hpp>
#include <core/Body.hpp>
#include <limits>
#include <tuple>

namespace yade {

class ContactDynamicsTriaxialController : public GlobalEngine {
public:
	/// Puts force or velocity on the moving walls, for the step that ContactDynamicsEngine is about to solve.
	void action() override;
	/// Refuses inadmissible attributes at once (Python: ValueError) and puts the last admissible values back.
	void postLoad(ContactDynamicsTriaxialController&);
	virtual ~ContactDynamicsTriaxialController() = default;

	/// What may come in the next step of a moving wall, for those who look ahead: the reach of bodies, the time step.
	struct Outlook {
		int wall;		   ///< its id
		Real speed;		   ///< if the grains resist as in the last step [m/s]
		Real acceleration; ///< if they do not resist at all [m/s2]
	};
	/// None where the step itself will be refused.
	std::vector<Outlook> outlook(const Scene& scene) const;

private:
	void requireAdmissible() const;
	const Body& wall(const Scene& scene, int place) const;
	Vector3r measureSize(const Scene& scene) const;
	Real massFor(const Scene& scene) const;
	static Real resistance(const Body& body, int axis);
	void press(int axis, Real area);
	void drive(int axis);

public:
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS(ContactDynamicsTriaxialController,GlobalEngine,
		"Triaxial box for :yref:`ContactDynamicsEngine`: six walls (bodies of shape :yref:`Box` or :yref:`Wall`) around a packing, three of them fixed and the three opposite ones under a prescribed stress or at a prescribed strain rate. "
		"A wall under stress is a rigid body of mass :yref:`wallMassInUse<ContactDynamicsTriaxialController.wallMassInUse>` that moves along its normal only, with the force σ·A; it is solved together with the contacts. So the grains push back with that force, but for the mass of the wall times its acceleration, and to the tolerance of the solve once the wall rests. "
		"(YADE's :yref:`TriaxialStressController` moves the walls by contact stiffness, which rigid contacts do not have.) \n\nStands before :yref:`ContactDynamicsEngine` and behind :yref:`ForceResetter`. ``contactdynamics.triaxial`` builds the box and reports stress and strain. Gravity does not act on the moving walls. "
		"Errors (RuntimeError from the step, before anything moves) name attribute or body, value and what is allowed.",
		((vector<int>,walls,vector<int>(),Attr::triggerPostLoad,"Ids of the walls at −x, +x, −y, +y, −z, +z, the order of ``utils.aabbWalls()``. The first of each pair is held, the second moves along its axis; other degrees of freedom of both are blocked. Not six different ids ≥ 0: ValueError; a body that does not exist, or is no Box or Wall perpendicular to its axis: RuntimeError. Boxes touch boxes: let the six have a bit of :yref:`Body.mask` in common that is in :yref:`Collider.avoidSelfInteractionMask`, as ``contactdynamics.triaxial`` does."))
		((Vector3r,stress,Vector3r::Zero(),Attr::triggerPostLoad,"Goal along the axes under stress [Pa], positive in tension, so −p for a pressure p. A pull is not transmitted to grains: goals are ≤ 0, otherwise ValueError."))
		((Vector3r,strainRate,Vector3r::Zero(),Attr::triggerPostLoad,"Rate of logarithmic strain along the other axes [1/s], positive in extension: the wall moves with this rate times the present length of the box. Not finite: ValueError."))
		((int,stressMask,7,Attr::triggerPostLoad,"Which axes are under stress: sum of 1 (x), 2 (y) and 4 (z) [-], 0 … 7, as in :yref:`TriaxialStressController.stressMask`."))
		((Real,wallMass,0,Attr::triggerPostLoad,"Mass of each moving wall [kg], ≥ 0. 0 (default): a tenth of that of a layer of grains, which is the mass of all movable bodies but the walls over the cube root of their number. What the grains push back with differs from the goal by the mass of the wall times its acceleration: 0.2 % (root mean square) in slow shear, 1.3 % for a wall as heavy as the layer, for the same number of sweeps. Negative or not finite: ValueError."))
		((Real,maxStrainRate,std::numeric_limits<Real>::infinity(),Attr::triggerPostLoad,"Largest rate, in magnitude, to which the force accelerates a wall under stress, over the length of the box [1/s], > 0: a loose packing is compressed at this rate, with less than the goal. The force is at most what leads to this rate against twice the force that the grains pushed back with in the last step; if they give way all at once, the wall exceeds the bound for a step. Default: infinite."))
		((Real,wallMassInUse,0,Attr::readonly,"Mass of each moving wall in the last step [kg]; 0 before the first."))
		((Vector3r,size,Vector3r::Zero(),Attr::readonly,"Edges of the box between the inner faces of the walls, at the start of the last step [m]."))
		((Vector3r,referenceSize,Vector3r::Zero(),Attr::triggerPostLoad,"Edges from which strain is measured [m], > 0; all 0 (default): taken in the next step. Otherwise ValueError."))
		((Vector3r,strain,Vector3r::Zero(),Attr::readonly,"Logarithmic strain ln(size/referenceSize) along the axes, at the start of the last step [-], positive in extension."))
	);
	// clang-format on
private:
	std::tuple<vector<int>&, Vector3r&, Vector3r&, int&, Real&, Real&, Vector3r&> attributes()
	{
		return {walls, stress, strainRate, stressMask, wallMass, maxStrainRate, referenceSize};
	}
	std::tuple<vector<int>, Vector3r, Vector3r, int, Real, Real, Vector3r> admitted{attributes()};
};
REGISTER_SERIALIZABLE(ContactDynamicsTriaxialController);

} // namespace yade
