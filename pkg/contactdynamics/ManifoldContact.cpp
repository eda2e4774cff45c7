// SPDX-License-Identifier: GPL-2.0-or-later
#include "ManifoldContact.hpp"
#include "ConvexShapes.hpp"
#include "DeferredError.hpp"
#include "ManifoldGeom.hpp"
#include "ProximityGeometry.hpp"
#include "Reach.hpp"
#include <core/Cell.hpp>
#include <pkg/geometry/Manifold.hpp>
#include <algorithm>
#include <typeinfo>

namespace yade {
namespace {
using contactdynamics::DecidingFeature;
using contactdynamics::ManifoldPoint;
using contactdynamics::PlacedShape;

/// Work space, so that memory is allocated once a thread.
struct Work {
	PlacedShape one, two;
	std::vector<ManifoldPoint> points;
};
thread_local Work work;

/// Whether no impulse can move either body, such as two boxes of a container: there is nothing to solve.
bool nothingMoves(const Scene& scene, const Interaction& interaction)
{
	const auto moves = [&](int id) {
		const Body& body = *(*scene.bodies)[id];
		return body.isDynamic() || body.isClumpMember();
	};
	return !moves(interaction.getId1()) && !moves(interaction.getId2());
}

/// @param force  the pair is made by hand, utils.createInteraction(): velocities may still change before the next step
Real reachOf(const Scene& scene, const Interaction& interaction, bool force)
{
	const Real reach = Reach::ofPair(scene, interaction.getId1(), interaction.getId2());
	if (force) Reach::forget();
	return reach;
}

/// @param origin  what was subtracted from all positions [m]
bool fill(Interaction& interaction, const contactdynamics::Separation& separation, const std::vector<ManifoldPoint>& points, const Vector3r& origin,
		  const Vector3r& position1, const Vector3r& position2)
{
	if (!interaction.geom) interaction.geom = boost::make_shared<ManifoldGeom>();
	auto& geom = static_cast<ManifoldGeom&>(*interaction.geom);
	geom.normal = separation.normal;
	geom.deciding = Vector3i(separation.feature.kind, separation.feature.one, separation.feature.two);
	geom.penetrationDepth = -separation.gap;
	geom.points.clear();
	geom.gaps.clear();
	geom.features.clear();
	Vector3r mean = Vector3r::Zero();
	for (const ManifoldPoint& point : points) {
		geom.points.push_back(origin + point.place);
		geom.gaps.push_back(point.gap);
		geom.features.push_back(point.feature);
		mean += point.place / static_cast<Real>(points.size());
	}
	geom.contactPoint = origin + (points.empty() ? separation.witness : mean);
	geom.refR1 = (geom.contactPoint - position1).norm();
	geom.refR2 = (geom.contactPoint - position2).norm();
	return true;
}

/// Puts both bodies into the work space. YADE may call the bodies of a pair of equal shape classes in either order, another one after O.load: the
/// smaller id comes first here, so that the last bits do not depend on it. Coordinates are taken from the middle of the smaller body, where contact
/// points are near.
struct Placing {
	bool swapped;
	Vector3r origin;

	Placing(const Interaction& interaction, const contactdynamics::ConvexShape& convex1, const contactdynamics::ConvexShape& convex2, bool sameClass,
			const State& state1, const State& state2, const Vector3r& position2)
		: swapped(sameClass && interaction.getId1() > interaction.getId2()),
		  origin(convex1.radius < convex2.radius || (convex1.radius == convex2.radius && swapped) ? state1.pos : position2)
	{
		work.one.place(swapped ? convex2 : convex1, (swapped ? state2 : state1).ori.toRotationMatrix(), (swapped ? position2 : state1.pos) - origin);
		work.two.place(swapped ? convex1 : convex2, (swapped ? state1 : state2).ori.toRotationMatrix(), (swapped ? state1.pos : position2) - origin);
	}
};

DecidingFeature lastFeature(const Interaction& interaction)
{
	const auto* geom = dynamic_cast<const ManifoldGeom*>(interaction.geom.get());
	return geom ? DecidingFeature{geom->deciding[0], geom->deciding[1], geom->deciding[2]} : DecidingFeature();
}
} // namespace

const contactdynamics::ConvexShape* convexShape(const Scene& scene, const Interaction& interaction, const shared_ptr<Shape>& shape, int id)
{
	try {
		return &ConvexShapes::of(shape);
	} catch (const std::invalid_argument& error) {
		DeferredError::report(&scene, interaction.getId1(), interaction.getId2(), "body #" + std::to_string(id) + ": " + error.what() + ".");
		return nullptr;
	}
}

bool updateManifold(const Scene& scene, Interaction& interaction, const shared_ptr<Shape>& shape1, const shared_ptr<Shape>& shape2,
					const State& state1, const State& state2, const Vector3r& shift2, bool force)
{
	if (!force && nothingMoves(scene, interaction)) return false;
	const Vector3r position2 = state2.pos + shift2;
	// The engine names a body whose position is not finite; here it would only give a frame that is not.
	if (!(state1.pos.allFinite() && position2.allFinite() && state1.ori.coeffs().allFinite() && state2.ori.coeffs().allFinite())) return false;
	const auto* convex1 = convexShape(scene, interaction, shape1, interaction.getId1());
	const auto* convex2 = convex1 ? convexShape(scene, interaction, shape2, interaction.getId2()) : nullptr;
	if (!convex2 || lacksMaterial(scene, interaction)) return false;

	const bool ends = !force && !interaction.isReal(); // only the law ends a contact
	const Real reach = reachOf(scene, interaction, force);
	// Balls around the two bodies that are apart: most pairs of bounding boxes end here.
	if (ends && (position2 - state1.pos).norm() > convex1->radius + convex2->radius + reach) return false;

	const Placing placing(interaction, *convex1, *convex2, typeid(*shape1) == typeid(*shape2), state1, state2, position2);
	// A real pair that goes apart has to be seen beyond the reach, too: the law ends it then by its gap.
	contactdynamics::Separation separation = findManifold(work.one, work.two, reach, lastFeature(interaction), work.points);
	if (ends && separation.gap > reach) return false;
	if (placing.swapped) separation.normal = -separation.normal;
	return fill(interaction, separation, work.points, placing.origin, state1.pos, position2);
}

void turnManifold(const Scene& scene, Interaction& interaction, const Vector3r& normal, Real beside)
{
	const Body &body1 = *(*scene.bodies)[interaction.getId1()], &body2 = *(*scene.bodies)[interaction.getId2()];
	const Vector3r position2 =
			body2.state->pos + (scene.isPeriodic ? Vector3r(scene.cell->hSize * interaction.cellDist.cast<Real>()) : Vector3r(Vector3r::Zero()));
	const Placing placing(interaction, ConvexShapes::of(body1.shape), ConvexShapes::of(body2.shape), typeid(*body1.shape) == typeid(*body2.shape),
						  *body1.state, *body2.state, position2);
	const Real reach = Reach::ofPair(scene, interaction.getId1(), interaction.getId2());
	contactdynamics::Separation separation =
			findManifoldAlong(work.one, work.two, placing.swapped ? Vector3r(-normal) : normal, reach, beside, work.points);
	separation.normal = normal;
	fill(interaction, separation, work.points, placing.origin, body1.state->pos, position2);
}

bool updateManifoldOnWall(const Scene& scene, Interaction& interaction, const Wall& wall, const shared_ptr<Shape>& shape2, const State& state1,
						  const State& state2, const Vector3r& shift2, bool force)
{
	if (!force && nothingMoves(scene, interaction)) return false;
	const Vector3r position2 = state2.pos + shift2;
	if (!(state1.pos.allFinite() && position2.allFinite() && state2.ori.coeffs().allFinite())) return false;
	const Real distance = position2[wall.axis] - state1.pos[wall.axis], side = wall.sense != 0 ? wall.sense : distance < 0 ? -1 : 1;
	const Vector3r normal = side * Vector3r::Unit(wall.axis);
	const auto* convex2 = convexShape(scene, interaction, shape2, interaction.getId2());
	if (!convex2 || lacksMaterial(scene, interaction)) return false;
	const Real reach = reachOf(scene, interaction, force), height = side * distance;
	const bool ends = !force && !interaction.isReal();
	if (ends && height > convex2->radius + reach) return false;

	work.two.place(*convex2, state2.ori.toRotationMatrix(), Vector3r::Zero());
	work.points.clear();
	contactdynamics::Separation separation;
	separation.normal = normal;
	separation.gap = work.two.lowest(normal) + height;
	separation.witness = -height * normal;
	if (ends && separation.gap > reach) return false;
	if (ends && wall.sense != 0 && work.two.highest(normal) + height < 0) return false; // wholly behind a one-sided wall
	// Every vertex near enough is a point: the gap of a polyhedron over a plane is least at its vertices.
	for (std::size_t i = 0; i < work.two.vertices.size(); i++) {
		const Vector3r& vertex = work.two.vertices[i];
		const Real gap = normal.dot(vertex) + height;
		if (gap <= reach) work.points.push_back({vertex - 0.5 * gap * normal, gap, contactdynamics::featureOfVertex(1, static_cast<int>(i))});
	}
	return fill(interaction, separation, work.points, position2, position2 - height * normal, position2);
}

} // namespace yade
