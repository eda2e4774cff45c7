// SPDX-License-Identifier: GPL-2.0-or-later
#include "ProximityGeometry.hpp"
#include "DeferredError.hpp"
#include "Reach.hpp"
#include <core/Scene.hpp>
#include <pkg/dem/ScGeom.hpp>

namespace yade {

bool beyondReach(const Scene& scene, const Interaction& interaction, Real gap, bool force)
{
	if (force || interaction.isReal()) return false; // only the law ends a contact
	return gap > Reach::ofPair(scene, interaction.getId1(), interaction.getId2());
}

bool updateScGeom(Interaction& interaction, const Nearest& nearest)
{
	if (!interaction.geom) interaction.geom = boost::shared_ptr<ScGeom>(new ScGeom);
	ScGeom& geom = static_cast<ScGeom&>(*interaction.geom);
	geom.normal = nearest.normal;
	geom.contactPoint = nearest.point + 0.5 * nearest.gap * nearest.normal;
	geom.penetrationDepth = -nearest.gap;
	geom.refR1 = nearest.radius1;
	geom.refR2 = nearest.radius2;
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
