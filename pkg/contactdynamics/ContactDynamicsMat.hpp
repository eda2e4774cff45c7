// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <pkg/common/ElastMat.hpp>
#include <tuple>

namespace yade {

class ContactDynamicsMat : public FrictMat {
public:
	/// Refuses inadmissible attributes at once (Python: ValueError) and puts the last admissible values back.
	void postLoad(ContactDynamicsMat&);
	virtual ~ContactDynamicsMat() = default;

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR(ContactDynamicsMat,FrictMat,
		"Material whose contacts bounce, stick, yield or resist rolling under :yref:`ContactDynamicsEngine`. Everything is off by default, then it is a :yref:`FrictMat`. Restitution: :yref:`normalRestitution<ContactDynamicsMat.normalRestitution>`, tangentialRestitution, restitutionVelocity; friction that is larger at rest: staticFrictionAngle; bonds: cohesionForce, cohesionStress; springs and dashpots in the contact: kn, ks, normalDamping; "
		"resistance to rolling: rollingFriction, twistingFriction. For example ``ContactDynamicsMat(frictionAngle=0.4, rollingFriction=0.05, normalRestitution=0.3)``. As with all materials of YADE a change takes effect on contacts that are made afterwards. The laws enter by a change of variable (Jean 1999, sections 1.2, 2.1, 2.2): "
		"Signorini's condition and Coulomb's law (26) hold for shifted velocities or impulses. Pairs: :yref:`Ip2_ContactDynamicsMat_ContactDynamicsMat_ContactDynamicsPhys`; beside a plain FrictMat the values given here count alone, but for friction, where the smaller angle does. "
		"A value that is negative, not finite or out of range raises ValueError.",
		((Real,normalRestitution,0,Attr::triggerPostLoad,"Newton's coefficient e_N in U⁺ = −e_N U⁻ [-], in [0, 1]; U⁻ is the normal velocity at the start of the step in which the gap would close. Applies at any approach speed above :yref:`restitutionVelocity<ContactDynamicsMat.restitutionVelocity>`. "
			"The impact is completed in one step, wherever in it the gap closes. Takes (1 − e_N²) of the energy of the normal approach of two spheres; with friction and several coupled contacts Newton's law may add energy. Default 0: condition (25)."))
		((Real,tangentialRestitution,0,Attr::triggerPostLoad,"Moreau's coefficient e_T [-], in [0, 1]: Coulomb's law at an impact holds for U_T⁺ + e_T U_T⁻, so a contact that sticks leaves with −e_T U_T⁻. Never adds energy to an impact of two spheres. Default 0."))
		((Real,restitutionVelocity,0,Attr::triggerPostLoad,"Approach speed up to which an impact is without restitution [m/s], ≥ 0. Default 0: no threshold."))
		((Real,staticFrictionAngle,0,Attr::triggerPostLoad,"Friction angle [rad] of contacts that did not slide in the last step (new ones included), in [0, π/2); :yref:`frictionAngle<FrictMat.frictionAngle>` is that of sliding ones. Values below it count as equal to it. Default 0: no difference."))
		((Real,cohesionForce,0,Attr::triggerPostLoad,"Pull-off force of a bond [N], ≥ 0. A bond forms when the bodies touch, holds up to this tension, and is lost for good where it opens or slides. Adds μ times itself to the shear strength. Default 0."))
		((Real,cohesionStress,0,Attr::triggerPostLoad,"Mohr–Coulomb cohesion c [Pa], ≥ 0: a bond shears at |R_T| = c A + μ R_N and pulls off at c A/μ, with A = π r² the cross-section of the smaller sphere. Needs friction. Default 0."))
		((Real,kn,0,Attr::triggerPostLoad,"Normal stiffness of the contact (mortar) [N/m], ≥ 0: R_N = −kn g. Default 0: rigid. Oscillations that the step resolves keep their energy, unresolved ones are damped; kn → ∞ tends to the rigid contact that pushes overlaps out (24)."))
		((Real,ks,0,Attr::triggerPostLoad,"Tangential stiffness of the contact [N/m], ≥ 0: a contact that sticks is held by a spring, Coulomb's limit stays. Default 0: rigid."))
		((Real,normalDamping,0,Attr::triggerPostLoad,"Dashpot beside :yref:`kn<ContactDynamicsMat.kn>` [N·s/m], ≥ 0: acts while the bodies overlap and never pulls. Without kn it has no effect. Default 0."))
		((Real,rollingFriction,0,Attr::triggerPostLoad,"Rolling friction coefficient of spheres [-], ≥ 0: the torque against rolling is at most this times ρ R_N, with ρ = r₁r₂/(r₁+r₂), or the radius on a flat body (half of what ``etaRoll`` and ``eta`` of YADE's soft laws give between equal spheres, the same on a flat body); without effect where no sphere is in the pair; of a cohesive contact the pull-off force is added to R_N. Only takes energy. Default 0."))
		((Real,twistingFriction,0,Attr::triggerPostLoad,"Twisting friction coefficient of spheres [-], ≥ 0: the torque about the contact normal is at most this times ρ R_N, with ρ as for :yref:`rollingFriction<ContactDynamicsMat.rollingFriction>`. Only takes energy. Default 0."))
		,
		createIndex();
	);
	// clang-format on
	REGISTER_CLASS_INDEX(ContactDynamicsMat, FrictMat);

private:
	std::tuple<Real&, Real&, Real&, Real&, Real&, Real&, Real&, Real&, Real&, Real&, Real&> attributes()
	{
		return {normalRestitution, tangentialRestitution, restitutionVelocity, staticFrictionAngle, cohesionForce, cohesionStress, kn, ks,
				normalDamping,	   rollingFriction,		  twistingFriction};
	}
	std::tuple<Real, Real, Real, Real, Real, Real, Real, Real, Real, Real, Real> admitted{attributes()};
};
REGISTER_SERIALIZABLE(ContactDynamicsMat);

} // namespace yade
