// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "ContactDynamicsMat.hpp"
#include <core/Dispatching.hpp>
#include <pkg/common/MatchMaker.hpp>

namespace yade {

class Ip2_ContactDynamicsMat_ContactDynamicsMat_ContactDynamicsPhys : public IPhysFunctor {
public:
	void go(const shared_ptr<Material>& material1, const shared_ptr<Material>& material2, const shared_ptr<Interaction>& interaction) override;
	FUNCTOR2D(ContactDynamicsMat, ContactDynamicsMat);
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS(Ip2_ContactDynamicsMat_ContactDynamicsMat_ContactDynamicsPhys,IPhysFunctor,
		"Create a :yref:`ContactDynamicsPhys` from two :yref:`ContactDynamicsMats<ContactDynamicsMat>`, when the contact is made. Each property has a :yref:`MatchMaker` of its own; without one, the pair gets the smaller value of the two, "
		"but the larger one for restitutionVelocity, and two mortars in series, k = k₁k₂/(k₁+k₂), for kn, ks and normalDamping (a material with kn = 0 is rigid: the other's values count). "
		"A pair of a ContactDynamicsMat and a plain FrictMat goes to :yref:`Ip2_FrictMat_FrictMat_ContactDynamicsPhys`. A pair value out of range, cohesionStress without friction, or restitution together with compliance stops the step with an error that names the contact.",
		((shared_ptr<MatchMaker>,frictAngle,,,"Friction angle [rad], in [0, π/2)."))
		((shared_ptr<MatchMaker>,staticFrictAngle,,,"Static friction angle [rad], in [0, π/2); counts if larger than the friction angle."))
		((shared_ptr<MatchMaker>,normalRestitution,,,"e_N [-], in [0, 1]."))
		((shared_ptr<MatchMaker>,tangentialRestitution,,,"e_T [-], in [0, 1]."))
		((shared_ptr<MatchMaker>,restitutionVelocity,,,"Threshold of restitution [m/s], ≥ 0."))
		((shared_ptr<MatchMaker>,cohesionForce,,,"Pull-off force [N], ≥ 0."))
		((shared_ptr<MatchMaker>,cohesionStress,,,"Mohr–Coulomb cohesion [Pa], ≥ 0."))
		((shared_ptr<MatchMaker>,kn,,,"Normal stiffness [N/m], ≥ 0."))
		((shared_ptr<MatchMaker>,ks,,,"Tangential stiffness [N/m], ≥ 0."))
		((shared_ptr<MatchMaker>,normalDamping,,,"Dashpot [N·s/m], ≥ 0."))
		((shared_ptr<MatchMaker>,rollingFriction,,,"Rolling friction [-], ≥ 0."))
		((shared_ptr<MatchMaker>,twistingFriction,,,"Twisting friction [-], ≥ 0."))
		((bool,bonding,true,,"Whether contacts made from now on can form cohesive bonds. Set it to False once a packing is glued: bonds that exist stay, new contacts and those of parted bodies that meet again are not cohesive."))
	);
	// clang-format on
};
REGISTER_SERIALIZABLE(Ip2_ContactDynamicsMat_ContactDynamicsMat_ContactDynamicsPhys);

} // namespace yade
