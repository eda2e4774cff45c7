// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <functional>
#include <pkg/dem/FrictPhys.hpp>

namespace yade {

class ContactDynamicsPhys : public FrictPhys {
public:
	virtual ~ContactDynamicsPhys() = default;

	/// Whether nothing but Signorini's condition and Coulomb's law with one coefficient holds here: such contacts pass by at no cost.
	bool isPlain() const
	{
		return normalRestitution == 0 && tangentialRestitution == 0 && restitutionVelocity == 0 && staticFriction == 0 && cohesionForce == 0 &&
			   cohesionShear == 0 && kn == 0 && ks == 0 && normalDamping == 0 && rollingArm == 0 && twistingArm == 0;
	}
	/// Calls `refuse` with the first attribute that is not admissible, its value and what is allowed.
	void requireUsable(const std::function<void(const char*, Real, const char*)>& refuse) const;
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR(ContactDynamicsPhys,FrictPhys,
		"Impulse and status of one contact of :yref:`ContactDynamicsEngine`. :yref:`kn<NormPhys.kn>` and :yref:`ks<NormShearPhys.ks>` [N/m] are 0 for a rigid contact. "
		"After a step :yref:`normalForce<NormPhys.normalForce>` and :yref:`shearForce<NormShearPhys.shearForce>` [N] are the reaction impulse divided by the time step, "
		"sustained by body 2 of the interaction (YADE's sign), and :yref:`tangensOfFrictionAngle<FrictPhys.tangensOfFrictionAngle>` is Coulomb's coefficient μ ≥ 0.",
		((Vector3r,impulse,Vector3r::Zero(),,"Reaction impulse h·R of the last step on body 2 (body 1 receives the opposite), global axes [N·s]. Saved: the next solve starts from it, "
			"because among several admissible solutions the history of loading selects one (Jean 1999, section 8). Zero for a contact that has just been detected."))
		((string,status,"none",Attr::readonly,"Outcome of the last solve: ``none`` (no reaction), ``sticking`` (reaction inside Coulomb's cone) or ``sliding`` (reaction on its boundary, eq. 26)."))
		((Real,gap,NaN,Attr::readonly,"Gap g at the positions the last solve started from [m]; negative where the bodies overlap. YADE's positions are those of the paper's auxiliary "
			"displacement (36), so this is the consistent gap of (19)–(21). NaN before the first solve."))
		((Vector3r,localVelocity,Vector3r::Zero(),Attr::readonly,"Velocity U of body 2 relative to body 1 at the contact point after the last solve, in the local frame (normal, first tangent, second tangent) [m/s]; "
			"normal component positive when separating. The first tangent is the global axis least aligned with the normal made orthogonal to it, the second completes the right-handed frame."))
		((Real,normalRestitution,0,,"Newton's coefficient e_N [-], in [0, 1]; see :yref:`ContactDynamicsMat` for this and the following."))
		((Real,tangentialRestitution,0,,"Moreau's coefficient e_T [-], in [0, 1]."))
		((Real,restitutionVelocity,0,,"Approach speed up to which there is no restitution [m/s], ≥ 0."))
		((Real,staticFriction,0,,"Friction coefficient unless the contact slid in the last step [-], ≥ 0; counts if larger than :yref:`tangensOfFrictionAngle<FrictPhys.tangensOfFrictionAngle>`."))
		((Real,cohesionForce,0,,"Pull-off force of the bond [N], ≥ 0."))
		((Real,cohesionShear,0,,"Mohr–Coulomb shear strength c A of the bond without normal force [N], ≥ 0; adds c A/μ to the pull-off force."))
		((string,bond,"none",,"``none`` (not cohesive, or not touched yet), ``intact`` or ``broken``. Saved; a broken bond does not heal. In the step in which it breaks the force is still the strength."))
		((Real,normalDamping,0,,"Dashpot beside kn [N·s/m], ≥ 0."))
		((Real,rollingArm,0,,"Largest rolling torque over normal force [m], ≥ 0: rollingFriction times the reduced radius."))
		((Real,twistingArm,0,,"Largest twisting torque over normal force [m], ≥ 0."))
		((Vector3r,torqueImpulse,Vector3r::Zero(),Attr::readonly,"Impulse of rolling and twisting friction in the last step on body 2 (body 1 receives the opposite), global axes [N·m·s]. Saved: the next step starts from it."))
		((Vector3r,stretch,Vector3r::Zero(),Attr::readonly,"Elastic tangential displacement of a contact with ks, body 2 relative to body 1, global axes [m]."))
		((Vector3r,stretchRate,Vector3r::Zero(),(Attr::readonly|Attr::hidden),"Rate of the stretch in the last step [m/s]."))
		((Real,pseudoImpulse,0,(Attr::readonly|Attr::hidden),"Pseudo-impulse of penetration repair in the last step over the largest displacement asked for [kg]; the next one starts from it.")),
		createIndex()
	);
	// clang-format on
	REGISTER_CLASS_INDEX(ContactDynamicsPhys, FrictPhys);
};
REGISTER_SERIALIZABLE(ContactDynamicsPhys);

} // namespace yade
