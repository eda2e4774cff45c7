// SPDX-License-Identifier: GPL-2.0-or-later
#include "ContactDynamicsManifoldPhys.hpp"
#include <boost/python/list.hpp>
#include <algorithm>
#include <cstdint>

namespace yade {

YADE_PLUGIN((ContactDynamicsManifoldPhys));

namespace {
std::size_t nearestTo(const Vector3r& place, const std::vector<Vector3r>& places)
{
	return std::min_element(places.begin(), places.end(),
							[&](const Vector3r& a, const Vector3r& b) { return (a - place).squaredNorm() < (b - place).squaredNorm(); }) -
		   places.begin();
}
} // namespace

void ContactDynamicsManifoldPhys::followPoints(const ManifoldGeom& geom, const Vector3r& origin)
{
	const std::vector<shared_ptr<ContactDynamicsPhys>> before = ofPoint;
	const std::vector<Vector3r> placesBefore = places;
	const std::size_t count = geom.points.size();
	std::vector<std::uint8_t> found(before.size(), 0);
	ofPoint.assign(count, nullptr);
	places.resize(count);
	for (std::size_t i = 0; i < count; i++) {
		places[i] = geom.points[i] - origin;
		const auto same = std::find(features.begin(), features.end(), geom.features[i]);
		if (same == features.end()) continue;
		const std::size_t j = same - features.begin();
		ofPoint[i] = before[j];
		found[j] = 1;
	}
	features = geom.features;
	for (std::size_t i = 0; i < count; i++) {
		if (ofPoint[i]) continue;
		ofPoint[i] = boost::make_shared<ContactDynamicsPhys>();
		if (before.empty()) continue;
		// A new corner of a patch that was there before remembers what its neighbour does: a broken bond does not heal by sliding.
		const ContactDynamicsPhys& neighbour = *before[nearestTo(places[i], placesBefore)];
		ofPoint[i]->status = neighbour.status;
		ofPoint[i]->bond = neighbour.bond;
	}
	// A corner that is gone hands its impulse on to the nearest one, so that the patch as a whole carries what it carried.
	for (std::size_t j = 0; j < before.size() && count > 0; j++)
		if (!found[j]) ofPoint[nearestTo(placesBefore[j], places)]->impulse += before[j]->impulse;
	for (const auto& point : ofPoint) {
		adoptLaw(*point, 1. / static_cast<Real>(count));
		if (impulse != knownImpulse) point->impulse = impulse / static_cast<Real>(count);
	}
}

void ContactDynamicsManifoldPhys::adoptLaw(ContactDynamicsPhys& point, Real share) const
{
	point.tangensOfFrictionAngle = tangensOfFrictionAngle;
	point.normalRestitution = normalRestitution;
	point.tangentialRestitution = tangentialRestitution;
	point.restitutionVelocity = restitutionVelocity;
	point.staticFriction = staticFriction;
	point.cohesionForce = share * cohesionForce;
	point.cohesionShear = share * cohesionShear;
	point.kn = share * kn;
	point.ks = share * ks;
	point.normalDamping = share * normalDamping;
	point.rollingArm = rollingArm;
	point.twistingArm = twistingArm;
}

void ContactDynamicsManifoldPhys::sumUp(ManifoldGeom& geom)
{
	impulse = normalForce = shearForce = localVelocity = Vector3r::Zero();
	gap = -geom.penetrationDepth;
	status = "none";
	bond = "none";
	Vector3r moment = Vector3r::Zero();
	Real weight = 0;
	for (std::size_t i = 0; i < ofPoint.size(); i++) {
		const ContactDynamicsPhys& point = *ofPoint[i];
		impulse += point.impulse;
		normalForce += point.normalForce;
		shearForce += point.shearForce;
		localVelocity += point.localVelocity / static_cast<Real>(ofPoint.size());
		if (point.status == "sticking" || status == "none") status = point.status;
		if (point.bond == "intact" || bond == "none") bond = point.bond;
		const Real normal = point.normalForce.norm();
		moment += normal * geom.points[i];
		weight += normal;
	}
	knownImpulse = impulse;
	if (weight > 0) geom.contactPoint = moment / weight;
}

boost::python::list ContactDynamicsManifoldPhys::pointPhys() const
{
	boost::python::list points;
	for (const auto& point : ofPoint) points.append(point);
	return points;
}

std::vector<Vector3r> ContactDynamicsManifoldPhys::pointImpulses() const
{
	std::vector<Vector3r> impulses;
	for (const auto& point : ofPoint) impulses.push_back(point->impulse);
	return impulses;
}

std::vector<Vector3r> ContactDynamicsManifoldPhys::pointForces() const
{
	std::vector<Vector3r> forces;
	for (const auto& point : ofPoint) forces.push_back(point->normalForce + point->shearForce);
	return forces;
}

} // namespace yade
