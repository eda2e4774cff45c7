// SPDX-License-Identifier: GPL-2.0-or-later
#include "Ig2_Box_Box_ManifoldGeom.hpp"
#include "ManifoldContact.hpp"

namespace yade {

YADE_PLUGIN((Ig2_Box_Box_ManifoldGeom));

bool Ig2_Box_Box_ManifoldGeom::go(const shared_ptr<Shape>& shape1, const shared_ptr<Shape>& shape2, const State& state1, const State& state2,
								  const Vector3r& shift2, const bool& force, const shared_ptr<Interaction>& interaction)
{
	return updateManifold(*scene, *interaction, shape1, shape2, state1, state2, shift2, force);
}

} // namespace yade
