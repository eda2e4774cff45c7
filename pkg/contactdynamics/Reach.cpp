// SPDX-License-Identifier: GPL-2.0-or-later
#include "Reach.hpp"
#include "BodySize.hpp"
#include "ContactDynamicsCellController.hpp"
#include "ContactDynamicsTriaxialController.hpp"
#include "Gravity.hpp"
#include "LawForUs.hpp"
#include "Prefetch.hpp"
#include <core/Cell.hpp>
#include <core/InteractionLoop.hpp>
#include <core/Scene.hpp>
#include <pkg/common/Box.hpp>
#include <pkg/common/Facet.hpp>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

namespace yade {
namespace {
constexpr Real marginOfRadius = 0.05; // the sum over a pair is YADE's customary interactionDetectionFactor of 1.05
/// Less for polyhedra, whose pairs have many points to be looked at.
constexpr Real marginOfPolyhedron = 0.01;
/// Below this way per step of the fastest body, in radii of the smallest sphere, its speed is granted to every body: the few more
/// candidates cost less than the grid.
constexpr Real slowStep = 0.5;
/// Edge of a grid cell in ways per step of the fastest body. A body gets the speed of its own and the 26 cells around, so a chain of
/// strikes is followed over at least this many free flights; inelastic strikes slow it down at each link.
constexpr Real flightsPerCell = 4;

struct Surroundings {
	std::vector<const Body*> bodies;		 // listed once: more may be appended from outside while a run goes on in the background
	std::vector<Real> speed, radius, margin; // by body id
	std::vector<std::uint8_t> driven;		 // likewise: nothing can be handed on to it
	Real smallestRadius = std::numeric_limits<Real>::infinity();
	Real largestSpeed = 0;	// of all bodies
	Real boundarySpeed = 0; // of bodies that are neither spheres nor polyhedra: they may be anywhere along their extent
};

/// What was worked out for a step of a scene.
struct Reaches {
	const Scene* scene = nullptr;
	long iter = 0;
	Real dt = 0;
	bool softLaws = false;
	std::vector<Real> reach;						// by body id [m]
	std::unique_ptr<std::atomic<bool>[]> boundMade; // by body id, in this pass of the collider

	bool knows(int id) const { return static_cast<std::size_t>(id) < reach.size(); }
	bool isOf(const Scene& asked) const { return scene == &asked && iter == asked.iter && dt == asked.dt && reach.size() == asked.bodies->size(); }
};
/// Two, because in a pass that begins, other threads may still read from those of before.
Reaches buffers[2];							// written under `guard`
std::atomic<const Reaches*> known{nullptr}; // one of the buffers
std::mutex guard;

/// Largest distance of a point of the surface from the body's position, for the part of its speed that comes from rotation.
Real turningRadius(const Shape& shape)
{
	if (asSphere(&shape)) return 0; // sweeps nothing
	if (const auto* box = dynamic_cast<const Box*>(&shape)) return box->extents.norm();
	if (const auto* facet = dynamic_cast<const Facet*>(&shape)) {
		Real largest = 0;
		for (const Vector3r& vertex : facet->vertices) largest = std::max(largest, vertex.norm());
		return largest;
	}
	return polyhedronRadius(shape);
}

/// Speed the surface of the body may have in the coming step. A NaN counts as 0: the engine names the body that carries it.
Real surfaceSpeed(const Scene& scene, const Body& body, Real radius, Real gravity, Real cellRate)
{
	const State& state = *body.state;
	Vector3r vel = state.vel;
	Real speed = 0;
	if (scene.isPeriodic) {
		vel -= scene.cell->velGrad * state.pos;
		speed += cellRate * radius;
	}
	speed += vel.norm();
	if (body.shape && state.angVel != Vector3r::Zero()) speed += state.angVel.norm() * turningRadius(*body.shape);
	if (body.isDynamic() || body.isClumpMember()) {
		speed += scene.dt * gravity;
		ForceContainer& forces = const_cast<Scene&>(scene).forces; // YADE's getters are not const
		if (forces.getPermForceUsed() && state.mass > 0) speed += scene.dt * forces.getPermForce(body.getId()).norm() / state.mass;
	}
	return std::isfinite(speed) ? speed : 0;
}

Surroundings measureSpeeds(const Scene& scene)
{
	Surroundings around;
	const Real gravity = gravityOf(scene).norm();
	Real cellRate = scene.isPeriodic ? scene.cell->velGrad.norm() : 0;
	std::unordered_map<int, Real> walls;
	for (const auto& engine : scene.engines) {
		if (const auto* cell = dynamic_cast<const ContactDynamicsCellController*>(engine.get()); cell && !cell->dead)
			cellRate = std::max(cellRate, std::min(cell->outlook(scene).rate, cell->largestStrain / scene.dt)); // more is refused
		if (const auto* box = dynamic_cast<const ContactDynamicsTriaxialController*>(engine.get()); box && !box->dead)
			for (const auto& wall : box->outlook(scene)) walls[wall.wall] = wall.speed;
	}
	const std::size_t count = scene.bodies->size();
	around.speed.assign(count, 0);
	around.radius.assign(count, 0);
	around.margin.assign(count, 0);
	around.driven.assign(count, 0);
	around.bodies.reserve(count);
	for (std::size_t id = 0; id < count; ++id)
		if (const Body* body = (*scene.bodies)[static_cast<unsigned>(id)].get()) around.bodies.push_back(body);
	const long existing = static_cast<long>(around.bodies.size());
	for (long i = 0; i < existing; ++i) {
		if (i + Prefetch::farAhead < existing) Prefetch::whole(around.bodies[i + Prefetch::farAhead]);
		if (i + Prefetch::ahead < existing) {
			const Body* coming = around.bodies[i + Prefetch::ahead];
			Prefetch::whole(coming->state.get());
			Prefetch::probably<Sphere>(coming->shape.get());
		}
		const Body* body = around.bodies[i];
		const int id = body->getId();
		around.driven[id] = !body->isDynamic() && !body->isClumpMember();
		if (body->isClump()) continue;
		const Real radius = grainRadius(*body);
		if (radius > 0) {
			around.radius[id] = radius;
			around.margin[id] = (asSphere(body->shape.get()) ? marginOfRadius : marginOfPolyhedron) * radius;
			around.smallestRadius = std::min(around.smallestRadius, radius);
		}
		Real speed = surfaceSpeed(scene, *body, around.radius[id], gravity, cellRate);
		if (const auto wall = walls.find(id); wall != walls.end() && std::isfinite(wall->second)) speed = std::max(speed, wall->second);
		around.speed[id] = speed;
		around.largestSpeed = std::max(around.largestSpeed, speed);
		if (!(radius > 0)) around.boundarySpeed = std::max(around.boundarySpeed, speed);
	}
	return around;
}

/// Largest speed of the spheres in a cube of space, by the cube's place in a grid of edge `edge`.
class SpeedGrid {
public:
	SpeedGrid(const Surroundings& around, Real edge_) : edge(edge_)
	{
		for (const Body* body : around.bodies) {
			if (around.radius[body->getId()] == 0 || !body->state->pos.allFinite()) continue;
			Real& largest = cells[key(body->state->pos, {0, 0, 0})];
			largest = std::max(largest, around.speed[body->getId()]);
		}
	}
	Real largestNear(const Vector3r& pos) const
	{
		Real largest = 0;
		for (int i = -1; i <= 1; i++)
			for (int j = -1; j <= 1; j++)
				for (int k = -1; k <= 1; k++) {
					const auto cell = cells.find(key(pos, {i, j, k}));
					if (cell != cells.end()) largest = std::max(largest, cell->second);
				}
		return largest;
	}

private:
	/// 21 bits an axis; places further out share keys, which only makes the answer larger than needed.
	std::uint64_t key(const Vector3r& pos, const std::array<int, 3>& offset) const
	{
		std::uint64_t value = 0;
		for (int axis = 0; axis < 3; axis++) {
			const Real place = std::clamp(std::floor(pos[axis] / edge), Real(-1e15), Real(1e15));
			value = (value << 21) | (static_cast<std::uint64_t>(static_cast<std::int64_t>(place) + offset[axis]) & 0x1fffff);
		}
		return value;
	}
	Real edge;
	std::unordered_map<std::uint64_t, Real> cells;
};

std::vector<Real> spreadReaches(const Scene& scene, const Surroundings& around)
{
	const Real h = scene.dt;
	std::vector<Real> near = std::vector<Real>(around.speed.size(), around.largestSpeed);
	// Positions in a periodic cell are not wrapped, so nearness cannot be told from them: there everybody gets the largest speed.
	if (h * around.largestSpeed > slowStep * around.smallestRadius && !scene.isPeriodic) {
		const Real largestRadius = *std::max_element(around.radius.begin(), around.radius.end());
		const SpeedGrid grid(around, flightsPerCell * (h * around.largestSpeed + 2 * largestRadius));
		for (const Body* body : around.bodies) {
			const int id = body->getId();
			if (around.radius[id] > 0 && body->state->pos.allFinite()) near[id] = std::max(around.boundarySpeed, grid.largestNear(body->state->pos));
		}
		// A struck clump carries all its members along.
		std::unordered_map<int, Real> clumps;
		for (const Body* body : around.bodies)
			if (body->isClumpMember()) clumps[body->clumpId] = std::max(clumps[body->clumpId], near[body->getId()]);
		for (const Body* body : around.bodies)
			if (body->isClumpMember()) near[body->getId()] = clumps[body->clumpId];
	}
	std::vector<Real> reach(around.speed.size(), 0);
	for (const Body* body : around.bodies) {
		const int id = body->getId();
		reach[id] = h * (around.driven[id] ? around.speed[id] : std::max(around.speed[id], near[id])) + around.margin[id];
	}
	return reach;
}

/// Whether an InteractionLoop of the scene has a law that is not ours.
bool hasSoftLaws(const Scene& scene)
{
	for (const auto& engine : scene.engines)
		if (const auto* loop = dynamic_cast<const InteractionLoop*>(engine.get()))
			for (const auto& law : loop->lawDispatcher->functors)
				if (!isLawForUs(law)) return true;
	return false;
}

/// Those of the scene's present step, worked out if they are not known or are `outdated`, which may be null.
/// @param passBegins  the collider asks; otherwise what is worked out now counts as outdated when it does
const Reaches& reachesOf(const Scene& scene, bool passBegins, const Reaches* outdated = nullptr)
{
	const auto usable = [&](const Reaches* its) { return its && its != outdated && its->isOf(scene); };
	if (const Reaches* its = known.load(std::memory_order_acquire); usable(its)) return *its;
	const std::lock_guard<std::mutex> lock(guard);
	if (const Reaches* its = known.load(); usable(its)) return *its;
	Reaches& fresh = buffers[known.load() == &buffers[0] ? 1 : 0];
	const std::size_t before = fresh.reach.size();
	fresh.scene = &scene;
	fresh.iter = scene.iter;
	fresh.dt = scene.dt;
	fresh.softLaws = hasSoftLaws(scene);
	fresh.reach = spreadReaches(scene, measureSpeeds(scene));
	if (!fresh.boundMade || before != fresh.reach.size()) fresh.boundMade.reset(new std::atomic<bool>[fresh.reach.size()]);
	for (std::size_t id = 0; id < fresh.reach.size(); ++id) fresh.boundMade[id].store(!passBegins, std::memory_order_relaxed);
	known.store(&fresh, std::memory_order_release);
	return fresh;
}
} // namespace

double Reach::ofBound(const Scene& scene, int id)
{
	if (!(scene.dt > 0)) return 0;
	const Reaches* its = &reachesOf(scene, true);
	if (!its->knows(id)) return 0; // appended from outside just now: from the next step on
	if (its->boundMade[id].exchange(true, std::memory_order_relaxed)) {
		its = &reachesOf(scene, true, its);
		if (!its->knows(id)) return 0;
		its->boundMade[id].store(true, std::memory_order_relaxed);
	}
	return its->reach[id];
}

double Reach::ofPair(const Scene& scene, int id1, int id2)
{
	if (!(scene.dt > 0)) return 0;
	const Reaches& its = reachesOf(scene, false);
	return its.knows(id1) && its.knows(id2) ? its.reach[id1] + its.reach[id2] : 0;
}

bool Reach::softLawsAct(const Scene& scene) { return !(scene.dt > 0) || reachesOf(scene, false).softLaws; }

void Reach::forget() { known.store(nullptr); }

} // namespace yade
