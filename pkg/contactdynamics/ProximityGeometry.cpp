// SPDX-License-Identifier: GPL-2.0-or-later
#include "ProximityGeometry.hpp"
#include "DeferredError.hpp"
#include "Prefetch.hpp"
#include "Reach.hpp"
#include <core/InteractionContainer.hpp>
#include <core/Scene.hpp>
#include <pkg/common/Sphere.hpp>
#include <pkg/dem/ScGeom.hpp>

namespace yade {

/// Another thread may be at work on what comes, and give it a geometry or the other order of ids: nothing but an address to fetch is read here,
/// whether the one of before or of after.
void prefetchComing(const Scene& scene, const Interaction& interaction)
{
	const InteractionContainer& all = *scene.interactions;
	const long at = interaction.linIx, count = all.end() - all.begin();
	if (at < 0) return; // made by hand, and in no container yet
	const auto bodiesOf = [&](const Interaction& one, const auto& visit) {
		for (const int id : {one.getId1(), one.getId2()})
			if (const Body* body = (*scene.bodies)[id].get()) visit(*body);
	};
	constexpr long soon = Prefetch::ahead / 2;
	if (at + Prefetch::farAhead < count) Prefetch::whole(all[at + Prefetch::farAhead].get());
	if (at + Prefetch::ahead < count) {
		const Interaction& coming = *all[at + Prefetch::ahead];
		bodiesOf(coming, [](const Body& body) { Prefetch::whole(&body); });
		Prefetch::probably<ScGeom>(coming.geom.get());
	}
	if (at + soon < count)
		bodiesOf(*all[at + soon], [](const Body& body) {
			Prefetch::between(&body.state->se3, &body.state->vel);
			Prefetch::probably<Sphere>(body.shape.get());
		});
}

bool beyondReach(const Scene& scene, const Interaction& interaction, Real gap, bool force)
{
	if (force || interaction.isReal()) return false; // only the law ends a contact
	return gap > Reach::ofPair(scene, interaction.getId1(), interaction.getId2());
}

void placeScGeom(Interaction& interaction, const Nearest& nearest)
{
	ScGeom& geom = static_cast<ScGeom&>(*interaction.geom);
	geom.normal = nearest.normal;
	geom.contactPoint = nearest.point + 0.5 * nearest.gap * nearest.normal;
	geom.penetrationDepth = -nearest.gap;
	geom.refR1 = nearest.radius1;
	geom.refR2 = nearest.radius2;
}

bool updateScGeom(const Scene& scene, const shared_ptr<Interaction>& interaction, const State& state1, const State& state2, const Vector3r& shift2,
				  const Nearest& nearest, bool fixedArms)
{
	const bool isNew = !interaction->geom;
	if (isNew) interaction->geom = boost::shared_ptr<ScGeom>(new ScGeom);
	ScGeom& geom = static_cast<ScGeom&>(*interaction->geom);
	const Vector3r before = geom.normal;
	placeScGeom(*interaction, nearest);
	if (!Reach::softLawsAct(scene)) return true; // a tenth of InteractionLoop
	geom.normal = before;						 // precompute() compares it with the new one
	geom.precompute(state1, state2, &scene, interaction, nearest.normal, isNew, shift2, fixedArms);
	return true;
}

bool lacksMaterial(const Scene& scene, const Interaction& interaction)
{
	for (const int id : {interaction.getId1(), interaction.getId2()}) {
		if ((*scene.bodies)[id]->material) continue;
		DeferredError::report(&scene, interaction.getId1(), interaction.getId2(),
							  "body #" + std::to_string(id) +
									  " has no material (Body.material is None), but touches another body: give it one, e.g. FrictMat().");
		return true;
	}
	return false;
}

} // namespace yade
