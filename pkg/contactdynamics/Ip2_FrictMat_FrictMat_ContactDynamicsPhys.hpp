// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include <core/Dispatching.hpp>
#include <pkg/common/ElastMat.hpp>
#include <pkg/common/MatchMaker.hpp>

namespace yade {

class Ip2_FrictMat_FrictMat_ContactDynamicsPhys : public IPhysFunctor {
public:
	void go(const shared_ptr<Material>& material1, const shared_ptr<Material>& material2, const shared_ptr<Interaction>& interaction) override;
	FUNCTOR2D(FrictMat, FrictMat);
	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS(Ip2_FrictMat_FrictMat_ContactDynamicsPhys,IPhysFunctor,
		"Create a :yref:`ContactDynamicsPhys` from two :yref:`FrictMats<FrictMat>`: the contact is rigid, so of the materials only the friction angle counts; "
		"Young's modulus and Poisson's ratio are not used. Pairs of a :yref:`ContactDynamicsMat` and a plain FrictMat come here, too: what only the former knows (restitution, cohesion, compliance, rolling friction) counts as it is, and of friction angles the smaller one. The friction coefficient is computed when the contact is made, as in :yref:`Ip2_FrictMat_FrictMat_FrictPhys`.",
		((shared_ptr<MatchMaker>,frictAngle,,,"Instance of :yref:`MatchMaker` that gives the friction angle [rad] of a pair of materials, admissible in [0, π/2). "
			"Default ``None``: the smaller angle of the two materials, as YADE's own friction functors do. A negative, too large or non-finite angle stops the step with an error that names the contact."))
	);
	// clang-format on
};
REGISTER_SERIALIZABLE(Ip2_FrictMat_FrictMat_ContactDynamicsPhys);

} // namespace yade
