// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <pkg/dem/FrictPhys.hpp>

namespace yade {

class ContactDynamicsPhys : public FrictPhys {
public:
	virtual ~ContactDynamicsPhys() = default;
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR(ContactDynamicsPhys,FrictPhys,
		"Impulse and status of one contact of :yref:`ContactDynamicsEngine`. Rigid: :yref:`kn<NormPhys.kn>` and :yref:`ks<NormShearPhys.ks>` stay 0. "
		"After a step :yref:`normalForce<NormPhys.normalForce>` and :yref:`shearForce<NormShearPhys.shearForce>` [N] are the reaction impulse divided by the time step, "
		"sustained by body 2 of the interaction (YADE's sign), and :yref:`tangensOfFrictionAngle<FrictPhys.tangensOfFrictionAngle>` is Coulomb's coefficient μ ≥ 0.",
		((Vector3r,impulse,Vector3r::Zero(),,"Reaction impulse h·R of the last step on body 2 (body 1 receives the opposite), global axes [N·s]. Saved: the next solve starts from it, "
			"because among several admissible solutions the history of loading selects one (Jean 1999, section 8). Zero for a contact that has just been detected."))
		((string,status,"none",Attr::readonly,"Outcome of the last solve: ``none`` (no reaction), ``sticking`` (reaction inside Coulomb's cone) or ``sliding`` (reaction on its boundary, eq. 26)."))
		((Real,gap,NaN,Attr::readonly,"Gap g at the positions the last solve started from [m]; negative where the bodies overlap. YADE's positions are those of the paper's auxiliary "
			"displacement (36), so this is the consistent gap of (19)–(21). NaN before the first solve."))
		((Vector3r,localVelocity,Vector3r::Zero(),Attr::readonly,"Velocity U of body 2 relative to body 1 at the contact point after the last solve, in the local frame (normal, first tangent, second tangent) [m/s]; "
			"normal component positive when separating. The first tangent is the global axis least aligned with the normal made orthogonal to it, the second completes the right-handed frame.")),
		createIndex()
	);
	// clang-format on
	REGISTER_CLASS_INDEX(ContactDynamicsPhys, FrictPhys);
};
REGISTER_SERIALIZABLE(ContactDynamicsPhys);

} // namespace yade
