// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once
#include "ContactDynamicsPhys.hpp"
#include "ManifoldGeom.hpp"
#include <boost/serialization/shared_ptr.hpp>
#include <boost/serialization/vector.hpp>

namespace yade {

class ContactDynamicsManifoldPhys : public ContactDynamicsPhys {
public:
	virtual ~ContactDynamicsManifoldPhys() = default;

	/// Before a solve: one entry of `ofPoint` for each point of the geometry, with the impulse and memory of the same point in the last step.
	/// @param origin  a point that goes with body 1 [m]
	void followPoints(const ManifoldGeom& geom, const Vector3r& origin);
	/// After a solve: resultant of the points, and its place in the geometry.
	void sumUp(ManifoldGeom& geom);

	boost::python::list pointPhys() const;
	std::vector<Vector3r> pointImpulses() const;
	std::vector<Vector3r> pointForces() const;

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR_PY(ContactDynamicsManifoldPhys,ContactDynamicsPhys,
		"Impulses of a contact with several points, :yref:`ManifoldGeom`. Each point is a contact of its own in the solve, with its gap, lever arms, warm start and status. Here stand the sums: :yref:`normalForce<NormPhys.normalForce>`, :yref:`shearForce<NormShearPhys.shearForce>`, :yref:`impulse<ContactDynamicsPhys.impulse>`; "
		"the smallest :yref:`gap<ContactDynamicsPhys.gap>`; the mean :yref:`localVelocity<ContactDynamicsPhys.localVelocity>`; and the :yref:`status<ContactDynamicsPhys.status>`: ``sticking`` if any point sticks, else ``sliding`` if any slides, else ``none``. "
		"The law of the pair is set here, before a step; coefficients hold at each point, but forces and stiffnesses of the pair (cohesionForce, cohesionShear, kn, ks, normalDamping) are shared equally by its points. Assigning :yref:`impulse<ContactDynamicsPhys.impulse>` shares it equally, too.",
		((std::vector<shared_ptr<ContactDynamicsPhys>>,ofPoint,,(Attr::readonly|Attr::hidden),"One for each point of the geometry, in its order."))
		((std::vector<int>,features,,(Attr::readonly|Attr::hidden),"Of the points, see ManifoldGeom."))
		((std::vector<Vector3r>,places,,(Attr::readonly|Attr::hidden),"Of the points, from the position of body 1 [m]."))
		((Vector3r,knownImpulse,Vector3r::Zero(),(Attr::readonly|Attr::hidden),"Sum of the points' impulses when it was last worked out; another value in ``impulse`` has been assigned."))
		,
		createIndex();
		,
		.def("pointPhys",&ContactDynamicsManifoldPhys::pointPhys,"List of one :yref:`ContactDynamicsPhys` for each point, in the order of :yref:`ManifoldGeom.points` as of the last step.")
		.add_property("pointImpulses",&ContactDynamicsManifoldPhys::pointImpulses,"Impulse on body 2 at each point in the last step, global axes [N·s].")
		.add_property("pointForces",&ContactDynamicsManifoldPhys::pointForces,"Force on body 2 at each point in the last step, global axes [N].")
	);
	// clang-format on
	REGISTER_CLASS_INDEX(ContactDynamicsManifoldPhys, ContactDynamicsPhys);

private:
	void adoptLaw(ContactDynamicsPhys& point, Real share) const;
};
REGISTER_SERIALIZABLE(ContactDynamicsManifoldPhys);

} // namespace yade
