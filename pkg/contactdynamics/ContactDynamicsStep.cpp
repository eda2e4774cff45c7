// SPDX-License-Identifier: GPL-2.0-or-later
#include "ContactDynamicsStep.hpp"
#include "BodyCheck.hpp"
#include "BodySize.hpp"
#include "ContactDynamicsManifoldPhys.hpp"
#include "ParallelLoop.hpp"
#include "Prefetch.hpp"
#include <core/Cell.hpp>
#include <core/Clump.hpp>
#include <core/Interaction.hpp>
#include <core/InteractionContainer.hpp>
#include <core/Scene.hpp>
#include <pkg/common/Sphere.hpp>
#include <pkg/dem/ScGeom.hpp>
#include <pkg/solver/LocalDelassus.hpp>
#include <pkg/solver/RoomToGrow.hpp>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <typeinfo>
#include <utility>

namespace yade {
namespace {
bool isotropic(const contactdynamics::Body& body)
{
	return body.inverseMass == Vector3r::Constant(body.inverseMass[0]) &&
		   body.inverseInertia == Matrix3r(body.inverseInertia(0, 0) * Matrix3r::Identity());
}

template <class Value> [[noreturn]] void refuse(const Interaction& interaction, const char* what, const Value& value, const char* allowed)
{
	std::ostringstream message;
	message << "contact #" << interaction.getId1() << "+#" << interaction.getId2() << ": " << what << " is " << value << "; " << allowed << ".";
	throw std::runtime_error(message.str());
}

ContactDynamicsPhys* contactDynamicsPhys(const Interaction& interaction)
{
	IPhys* phys = interaction.phys.get();
	if (!phys || !interaction.geom) return nullptr;
	if (typeid(*phys) == typeid(ContactDynamicsPhys))
		return static_cast<ContactDynamicsPhys*>(phys); // the common case, without a walk through the bases
	return dynamic_cast<ContactDynamicsPhys*>(phys);
}

bool hasSeveralPoints(const Interaction& interaction, const ContactDynamicsPhys& phys)
{
	if (typeid(phys) == typeid(ContactDynamicsPhys)) return false; // the common case
	return dynamic_cast<const ManifoldGeom*>(interaction.geom.get()) && dynamic_cast<const ContactDynamicsManifoldPhys*>(&phys);
}

/// What describe() and writeBack() touch of the objects of a contact.
[[gnu::always_inline]] inline void prefetchGeom(const ScGeom& geom)
{
	Prefetch::between(&geom.normal, &geom.refR1);
	Prefetch::whole(&geom.penetrationDepth);
}
[[gnu::always_inline]] inline void prefetchResult(const ContactDynamicsPhys& phys) { Prefetch::between(&phys.normalForce, &phys.normalRestitution); }

const char* nameOf(contactdynamics::ContactStatus status)
{
	switch (status) {
	case contactdynamics::ContactStatus::sticking:
		return "sticking";
	case contactdynamics::ContactStatus::sliding:
		return "sliding";
	default:
		return "none";
	}
}
} // namespace

void ContactDynamicsStep::collectBodies(Scene& scene, const IntegratorPlan& plan)
{
	solved = false;
	h = plan.h;
	gravity = plan.gravity;
	velGrad = plan.velGrad;
	displacementAsVelocity = plan.velocityOfDisplacement();
	const long count = static_cast<long>(scene.bodies->size());
	views.assign(count, BodyView());
	idOfIndex.clear();
	for (int id = 0; id < count; id++) {
		if (id + Prefetch::ahead < count) Prefetch::whole((*scene.bodies)[id + Prefetch::ahead].get());
		const auto& body = (*scene.bodies)[id];
		if (!body) continue;
		views[id].state = body->state.get();
		views[id].member = body->isClumpMember();
		if (views[id].member) continue;
		views[id].index = static_cast<int>(idOfIndex.size());
		idOfIndex.push_back(id);
	}
	motions.resize(idOfIndex.size());
	problem.bodies.resize(idOfIndex.size());
	problem.meanField.reset();
	const Matrix3r edges = scene.isPeriodic ? scene.cell->hSize : Matrix3r(Matrix3r::Identity()), toCell = edges.inverse();

	const long movers = static_cast<long>(idOfIndex.size());
	parallelLoop(movers, [&](long index) {
		if (index + Prefetch::ahead < movers) {
			const int coming = idOfIndex[index + Prefetch::ahead];
			Prefetch::whole((*scene.bodies)[coming].get());
			Prefetch::whole(views[coming].state);
		}
		const int id = idOfIndex[index];
		const Body& body = *(*scene.bodies)[id];
		Vector3r force = scene.forces.getForce(id);
		Vector3r torque = scene.forces.getTorque(id);
		if (body.isClump()) {
			for (const auto& member : static_cast<const Clump&>(*body.shape).members) {
				const Vector3r& onMember = scene.forces.getForce(member.first);
				force += onMember;
				torque += scene.forces.getTorque(member.first) + ((*scene.bodies)[member.first]->state->pos - body.state->pos).cross(onMember);
			}
		}
		const auto [motion, mobility] = predictFreeMotion(scene, plan, body, force, torque);
		motions[index] = motion;
		Vector3r centre = body.state->pos;
		if (scene.isPeriodic) { // neighbours drift many cells apart, as YADE counts positions: back into the first one
			const Vector3r cells = (toCell * centre).array().floor();
			centre -= edges * cells;
		}
		problem.bodies[index] = {motion.velocity, motion.angularVelocity, mobility.inverseMass, mobility.inverseInertia, centre};
	});

	parallelLoop(count, [&](long id) {
		if (id + Prefetch::farAhead < count) Prefetch::whole((*scene.bodies)[id + Prefetch::farAhead].get());
		if (id + Prefetch::ahead < count)
			if (const Body* coming = (*scene.bodies)[id + Prefetch::ahead].get()) Prefetch::probably<Sphere>(coming->shape.get());
		const auto& body = (*scene.bodies)[id];
		if (!body) return;
		BodyView& view = views[id];
		if (view.member) {
			view.index = views[body->clumpId].index;
			if (view.index < 0)
				throw std::runtime_error("body #" + std::to_string(id) + " is a member of clump #" + std::to_string(body->clumpId) +
										 ", which does not exist (any more).");
		}
		if (const Sphere* sphere = asSphere(body->shape.get())) {
			requirePositiveRadius(*body, sphere->radius); // the collider passes over a sphere without a size, which then falls through all others
			view.radius = sphere->radius;
		}
		view.fixed = motions[view.index].heldDOFs == State::DOF_ALL;
		view.belt = !motions[view.index].moved;
		view.ball = view.fixed || (view.radius > 0 && !view.member && isotropic(problem.bodies[view.index]));
	});
}

/// The order of YADE's list depends on the history of the run, and O.load makes another one. Counted into place by the larger id and then, in that
/// order, by the smaller one, the interactions are in an order that depends on nothing but ids. A walk through the trees of interactions that the
/// bodies keep gives it as well, but nothing in it can be fetched ahead: it took 60 ms of 150 for 200,000 interactions. Swaps into place,
/// each of which waits for the one before, took 2.5 times as long. A second array of all that was gathered was given up for its 32 bytes a contact.
void ContactDynamicsStep::orderById()
{
	gathered.erase(std::remove_if(gathered.begin(), gathered.end(), [](const Gathered& one) { return !one.phys; }), gathered.end());
	const auto count = static_cast<int>(gathered.size());
	const auto countInto = [&](std::vector<int>& order, const auto& idOf, const auto& before) {
		firstOfId.assign(views.size() + 1, 0);
		for (const Gathered& one : gathered) firstOfId[idOf(one) + 1]++;
		std::partial_sum(firstOfId.begin(), firstOfId.end(), firstOfId.begin());
		contactdynamics::resizeWithRoom(order, count);
		for (int k = 0; k < count; k++) order[firstOfId[idOf(gathered[before(k)])]++] = before(k);
	};
	const auto largerId = [](const Gathered& one) { return std::max(one.id1, one.id2); };
	const auto smallerId = [](const Gathered& one) { return std::min(one.id1, one.id2); };
	countInto(byLargerId, largerId, [](int k) { return k; });
	countInto(byIds, smallerId, [&](int k) { return byLargerId[k]; });
	constexpr int done = -1;
	for (int start = 0; start < count; start++) {
		if (byIds[start] == done) continue;
		const Gathered first = gathered[start];
		int place = start;
		for (int from = std::exchange(byIds[place], done); from != start; from = std::exchange(byIds[place], done)) {
			gathered[place] = gathered[from];
			place = from;
		}
		gathered[place] = first;
	}
}

void ContactDynamicsStep::gatherInteractions(const Scene& scene)
{
	const InteractionContainer& all = *scene.interactions;
	const long inList = all.end() - all.begin();
	contactdynamics::resizeWithRoom(gathered, inList);
	parallelLoop(inList, [&](long i) {
		if (i + Prefetch::farAhead < inList) Prefetch::whole(all[i + Prefetch::farAhead].get());
		if (i + Prefetch::ahead < inList) __builtin_prefetch(all[i + Prefetch::ahead]->phys.get()); // what type it has
		Interaction& interaction = *all[i];
		const int id1 = interaction.getId1(), id2 = interaction.getId2();
		const auto exists = [&](int id) { return id >= 0 && id < static_cast<int>(views.size()) && views[id].state; };
		ContactDynamicsPhys* phys = contactDynamicsPhys(interaction);
		if (!exists(id1) || !exists(id2)) phys = nullptr;
		gathered[i] = {&interaction, phys, id1, id2, 0, phys && hasSeveralPoints(interaction, *phys)};
	});
	orderById();
	settleBlockSeamsOf(scene);
	manifolds.clear();
	for (const Gathered& one : gathered)
		if (one.severalPoints)
			manifolds.push_back(
					{static_cast<ManifoldGeom*>(one.interaction->geom.get()), static_cast<ContactDynamicsManifoldPhys*>(one.phys), one.interaction});
	parallelLoop(static_cast<long>(manifolds.size()), [&](long i) {
		const Interaction& interaction = *manifolds[i].interaction;
		const int smaller = std::min(interaction.getId1(), interaction.getId2());
		manifolds[i].phys->followPoints(*manifolds[i].geom, views[smaller].state->pos);
	});
	const auto pointsOf = [](const Gathered& one) -> std::vector<shared_ptr<ContactDynamicsPhys>>& {
		return static_cast<ContactDynamicsManifoldPhys*>(one.phys)->ofPoint;
	};
	int points = 0;
	for (Gathered& one : gathered) {
		one.firstLink = points;
		points += one.severalPoints ? static_cast<int>(pointsOf(one).size()) : 1;
	}
	contactdynamics::resizeWithRoom(links, points);
	parallelLoop(static_cast<long>(gathered.size()), [&](long i) {
		const Gathered& one = gathered[i];
		const auto link = [&](int place, ContactDynamicsPhys* phys, int point) { links[place] = {one.interaction, phys, point, one.id1, one.id2}; };
		if (!one.severalPoints) return link(one.firstLink, one.phys, -1);
		for (int k = 0; k < static_cast<int>(pointsOf(one).size()); k++) link(one.firstLink + k, pointsOf(one)[k].get(), k);
	});
}

/// Overwrites what a contact of the step before has left here, but for status and velocity, which the solve gives, and impulse and gap velocity. (To
/// begin with a Contact() would cost a quarter more.)
void ContactDynamicsStep::describe(const Scene& scene, Link& link, contactdynamics::Contact& contact) const
{
	const Interaction& interaction = *link.interaction;
	const ScGeom& geom = static_cast<const ScGeom&>(*interaction.geom);
	const BodyView& view1 = views[link.id1];
	const BodyView& view2 = views[link.id2];
	const Vector3r shift = scene.isPeriodic ? Vector3r(scene.cell->hSize * interaction.cellDist.cast<Real>()) : Vector3r(Vector3r::Zero());

	// The contact point lies in the middle of gap or overlap. For spheres the arms come from the radii, exactly along the normal.
	contact.normal = geom.normal;
	link.gap = -geom.penetrationDepth;
	Vector3r point = geom.contactPoint;
	if (link.point >= 0) {
		const ManifoldGeom& manifold = static_cast<const ManifoldGeom&>(geom);
		link.gap = manifold.gaps[link.point];
		point = manifold.points[link.point];
	}
	link.arm1 = view1.radius > 0 ? Vector3r((view1.radius + 0.5 * link.gap) * geom.normal) : Vector3r(point - view1.state->pos);
	link.arm2 = view2.radius > 0 ? Vector3r(-(view2.radius + 0.5 * link.gap) * geom.normal) : Vector3r(point - view2.state->pos - shift);
	contact.body1 = view1.index;
	contact.body2 = view2.index;
	contact.ball = view1.ball && view2.ball;
	contact.normalCompliance = contact.tangentialCompliance = 0;
	// An image is carried by the cell: at the next step it stands at pos + hSize·cellDist with the hSize of then.
	contact.imageVelocity = scene.isPeriodic && !problem.meanField ? Vector3r(velGrad * shift) : Vector3r(Vector3r::Zero());

	const auto fromMassCentre = [&](const BodyView& view, const Vector3r& arm) {
		return view.member ? Vector3r(arm + view.state->pos - views[idOfIndex[view.index]].state->pos) : arm;
	};
	contact.arm1 = fromMassCentre(view1, link.arm1);
	contact.arm2 = fromMassCentre(view2, link.arm2);
	// The velocity of a fixed body at the contact point is known. Given as a shift it leaves no arm across the normal, so that a ball
	// on a turning box keeps the closed form. A mean field needs the arms.
	if (problem.meanField) contact.ball = contact.ball && view1.radius > 0 && view2.radius > 0;
	if (view1.fixed && !problem.meanField) {
		contact.imageVelocity -= motions[view1.index].angularVelocity.cross(contact.arm1);
		contact.arm1 = Vector3r::Zero();
	}
	if (view2.fixed && !problem.meanField) {
		contact.imageVelocity += motions[view2.index].angularVelocity.cross(contact.arm2);
		contact.arm2 = Vector3r::Zero();
	}

	if (view1.belt || view2.belt)
		contact.imageVelocity += beltVelocity(view2, link.arm2, contact.normal) - beltVelocity(view1, link.arm1, contact.normal);

	link.swapped = (link.point >= 0 || (view1.radius > 0 && view2.radius > 0)) && link.id1 > link.id2;
	if (link.swapped) {
		std::swap(contact.body1, contact.body2);
		std::swap(contact.arm1, contact.arm2);
		contact.normal = -contact.normal;
		contact.imageVelocity = -contact.imageVelocity;
	}
	contact.friction = link.phys->tangensOfFrictionAngle;
	link.solved = link.solved && contact.body1 != contact.body2 && !(view1.fixed && view2.fixed) &&
				  (contact.ball || link.phys->kn > 0 || movesApart(contact));
}

/// Whether an impulse along the normal moves the bodies, or they are held along it for good. Not where they are held but for round-off, such as two
/// balls side by side whose sideways motion is blocked: huge impulses would make up for directions that are right to the last digits only, and
/// friction would wedge the balls. In a step the gap changes by less than 1e-5 of the way then.
bool ContactDynamicsStep::movesApart(const contactdynamics::Contact& contact) const
{
	constexpr Real sineSquared = 1e-10;
	Real along = 0, most = 0;
	for (const auto& [index, arm] : {std::pair{contact.body1, contact.arm1}, std::pair{contact.body2, contact.arm2}}) {
		const contactdynamics::Body& body = problem.bodies[index];
		if (body.inverseMass.minCoeff() > 0) return true;
		const Vector3r turning = arm.cross(contact.normal);
		along += contact.normal.dot(body.inverseMass.cwiseProduct(contact.normal)) + turning.dot(body.inverseInertia * turning);
		most += body.inverseMass.maxCoeff() + body.inverseInertia.trace() * arm.squaredNorm();
	}
	return problem.meanField || along == 0 || along > sineSquared * most;
}

/// A body outside NewtonIntegrator.mask stays where it is, whatever its velocity says; along its surface that velocity acts, as that of a conveyor
/// belt.
/// @param arm  from the position of the body, not of its clump
Vector3r ContactDynamicsStep::beltVelocity(const BodyView& view, const Vector3r& arm, const Vector3r& normal) const
{
	if (!view.belt) return Vector3r::Zero();
	const State& whole = *views[idOfIndex[view.index]].state; // the members of a clump that YADE does not move have velocities of their own
	const Vector3r velocity = whole.vel + whole.angVel.cross(arm + view.state->pos - whole.pos);
	return velocity - velocity.dot(normal) * normal;
}

/// Likewise its turning [rad/s].
Vector3r ContactDynamicsStep::beltTurning(int index) const
{
	const BodyView& view = views[idOfIndex[index]];
	return view.belt ? view.state->angVel : Vector3r(Vector3r::Zero());
}

void ContactDynamicsStep::requireUsable(const Link& link, const contactdynamics::Contact& contact) const
{
	if (!std::isfinite(link.gap) || !contact.normal.allFinite())
		refuse(*link.interaction, "the gap", link.gap, "it must be finite; see size and position of the two bodies");
	if (!(contact.friction >= 0 && std::isfinite(contact.friction)))
		refuse(*link.interaction, "the friction coefficient (ContactDynamicsPhys.tangensOfFrictionAngle)", contact.friction,
			   "it must be finite and not negative");
	const std::string& bond = link.phys->bond;
	if (bond != "none" && bond != "intact" && bond != "broken")
		refuse(*link.interaction, "ContactDynamicsPhys.bond", '"' + bond + '"', "allowed are none, intact and broken");
	if (!link.phys->isPlain())
		link.phys->requireUsable([&](const char* what, Real value, const char* allowed) { refuse(*link.interaction, what, value, allowed); });
	if (!link.phys->impulse.allFinite())
		refuse(*link.interaction, "the stored impulse (ContactDynamicsPhys.impulse)", link.phys->impulse.sum(), "it must be finite");
}

ContactDynamicsStep::Twist ContactDynamicsStep::atStart(int index) const
{
	if (!motions[index].moved) return {Vector3r::Zero(), Vector3r::Zero()};
	const State& state = *views[idOfIndex[index]].state;
	return {state.vel, state.angVel};
}

Vector3r ContactDynamicsStep::relativeVelocity(const contactdynamics::Contact& contact, const Twist& of1, const Twist& of2) const
{
	Vector3r U =
			of2.velocity + of2.angularVelocity.cross(contact.arm2) + contact.imageVelocity - of1.velocity - of1.angularVelocity.cross(contact.arm1);
	if (problem.meanField) U += velGrad * shiftOf(contact);
	return U;
}

/// Whether contact is forecast in the sense of (23): the gap is closed, or will be with the velocity of now or with the free velocity.
bool ContactDynamicsStep::forecast(const Link& link, const contactdynamics::Contact& contact) const
{
	if (link.gap <= 0) return true;
	const auto closes = [&](const Vector3r& velocity) { return link.gap + h * contact.normal.dot(velocity) <= 0; };
	return closes(relativeVelocity(contact, freeOf(contact.body1), freeOf(contact.body2))) || closes(velocityAtStart(contact));
}

void ContactDynamicsStep::collectContacts(const Scene& scene, const std::string& contactLaw, Real warmStart)
{
	const bool velocitySignorini = contactLaw == "velocitySignorini", quasiInelasticShock = contactLaw == "quasiInelasticShock";
	gatherInteractions(scene);
	settleSurfaceSeams(scene);
	contactdynamics::resizeWithRoom(problem.contacts, links.size());
	const long count = static_cast<long>(links.size());
	parallelLoop(count, [&](long i) {
		if (i + Prefetch::farAhead < count)
			Prefetch::between(&links[i + Prefetch::farAhead].interaction->geom, &links[i + Prefetch::farAhead].interaction->linIx);
		if (i + Prefetch::ahead < count) {
			prefetchGeom(static_cast<const ScGeom&>(*links[i + Prefetch::ahead].interaction->geom));
			Prefetch::whole(links[i + Prefetch::ahead].phys);
		}
		Link& link = links[i];
		contactdynamics::Contact& contact = problem.contacts[i];
		describe(scene, link, contact);
		requireUsable(link, contact);
		link.plain = link.phys->isPlain();
		link.pseudoImpulse = link.phys->pseudoImpulse;
		if (link.phys->rollingArm == 0 && link.phys->twistingArm == 0 && link.phys->torqueImpulse != Vector3r::Zero())
			link.phys->torqueImpulse = Vector3r::Zero(); // of arms that have been set to 0
		contact.impulse = (link.swapped ? -warmStart : warmStart) * link.phys->impulse;
		contact.gapVelocity = velocitySignorini ? 0 : (quasiInelasticShock ? std::max(Real(0), link.gap) : link.gap) / h;
		if (velocitySignorini) link.solved = link.solved && (forecast(link, contact) || ShiftedContacts::isBonded(*link.phys));
		if (!link.solved) leaveOut(link);
	});
	std::size_t kept = 0;
	for (std::size_t i = 0; i < links.size(); i++) {
		if (!links[i].solved) continue;
		if (kept != i) {
			links[kept] = links[i];
			problem.contacts[kept] = problem.contacts[i];
		}
		kept++;
	}
	links.resize(kept);
	problem.contacts.resize(kept);
	shiftContacts(warmStart);
}

void ContactDynamicsStep::shiftContacts(Real warmStart)
{
	shifted.clear(h);
	problem.rolling.clear();
	for (std::size_t i = 0; i < links.size(); i++) {
		const Link& link = links[i];
		if (link.plain) continue;
		const contactdynamics::Contact& contact = problem.contacts[i];
		shifted.shift(problem, static_cast<int>(i), *link.phys, {link.gap, velocityAtStart(contact), forecast(link, contact), link.swapped});
		if (link.phys->rollingArm > 0 || link.phys->twistingArm > 0)
			problem.rolling.push_back({static_cast<int>(i), link.phys->rollingArm, link.phys->twistingArm,
									   beltTurning(contact.body2) - beltTurning(contact.body1),
									   (link.swapped ? -warmStart : warmStart) * link.phys->torqueImpulse});
	}
}

/// A pair that takes no part in the solve: no reaction, and the local velocity left from an earlier step would mislead.
void ContactDynamicsStep::leaveOut(Link& link)
{
	link.phys->gap = link.gap;
	link.phys->status = "none";
	link.phys->impulse = Vector3r::Zero();
	link.phys->normalForce = Vector3r::Zero();
	link.phys->shearForce = Vector3r::Zero();
	link.phys->localVelocity = Vector3r::Zero();
	link.phys->pseudoImpulse = 0;
	link.phys->stretch = link.phys->stretchRate = link.phys->torqueImpulse = Vector3r::Zero();
}

void ContactDynamicsStep::writeBack(const Link& link, const contactdynamics::Contact& contact) const
{
	ContactDynamicsPhys& phys = *link.phys;
	const Real sign = link.swapped ? -1 : 1;
	const Vector3r normal = sign * contact.normal;
	const Vector3r force = sign / h * contact.impulse;
	phys.impulse = sign * contact.impulse;
	phys.normalForce = normal.dot(force) * normal;
	phys.shearForce = force - phys.normalForce;
	phys.gap = link.gap;
	phys.localVelocity = contactdynamics::contactFrame(normal) * (sign * contact.relativeVelocity);
	phys.status = nameOf(contact.status);
}

void ContactDynamicsStep::apply(Scene& scene)
{
	bonded.assign(scene.trackEnergy ? links.size() : 0, 0);
	for (std::size_t i = 0; i < bonded.size(); i++) bonded[i] = ShiftedContacts::isBonded(*links[i].phys);
	shifted.restore(problem, tolerance);
	for (const contactdynamics::RollingFriction& one : problem.rolling)
		links[one.contact].phys->torqueImpulse = (links[one.contact].swapped ? -1 : 1) * one.torque;
	const long count = static_cast<long>(links.size());
	parallelLoop(count, [&](long i) {
		if (i + Prefetch::ahead < count) prefetchResult(*links[i + Prefetch::ahead].phys);
		writeBack(links[i], problem.contacts[i]);
	});
	parallelLoop(static_cast<long>(manifolds.size()), [&](long i) { manifolds[i].phys->sumUp(*manifolds[i].geom); });

	// One sum a body, in the order of the contacts: adding from several threads would make the last bits depend on their number.
	loads.assign(views.size(), {Vector3r::Zero(), Vector3r::Zero()});
	activeContacts = 0;
	maxPenetration = 0;
	Real penetrations = 0;
	for (std::size_t i = 0; i < links.size(); i++) {
		const contactdynamics::Contact& contact = problem.contacts[i];
		const Link& link = links[i];
		const Real penetration = std::max(Real(0), -link.gap);
		maxPenetration = std::max(maxPenetration, penetration);
		if (contact.impulse == Vector3r::Zero()) continue;
		activeContacts++;
		penetrations += penetration;
		const Vector3r force = (link.swapped ? -1 : 1) / h * contact.impulse;
		Load& on1 = loads[link.id1];
		Load& on2 = loads[link.id2];
		on1.force -= force;
		on1.torque -= link.arm1.cross(force);
		on2.force += force;
		on2.torque += link.arm2.cross(force);
	}
	meanPenetration = activeContacts > 0 ? penetrations / activeContacts : 0;
	for (const contactdynamics::RollingFriction& one : problem.rolling) {
		const Link& link = links[one.contact];
		const Vector3r torque = link.phys->torqueImpulse / h;
		loads[link.id1].torque -= torque;
		loads[link.id2].torque += torque;
	}
	if (scene.trackEnergy) trackEnergy(scene);

	for (std::size_t id = 0; id < loads.size(); id++) {
		if (loads[id].force != Vector3r::Zero()) scene.forces.addForce(static_cast<int>(id), loads[id].force);
		if (loads[id].torque != Vector3r::Zero()) scene.forces.addTorque(static_cast<int>(id), loads[id].torque);
	}
	scene.forces.sync(); // some recorders and controllers behind the engine read without syncing
}

} // namespace yade
