// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

namespace yade {

class Scene;

/// How far a body may go within the coming step. Contacts are looked for up to the sum of two reaches, so that whatever two bodies
/// can close in a step is seen before it happens:
///
///     reach = h max(s, S) + r/20, for polyhedra r/100
///
/// h is the time step, r the radius of a sphere or of the ball around a polyhedron (0 for other shapes), s the speed of the body's surface plus h
/// times its acceleration by gravity and permanent force, and S the largest s near the body. Why S: an inelastic collision hands on at most the speed
/// of the faster body, and within one step the struck body may strike a third. Why only near it: one fast body must not make candidates of all
/// neighbours in a large dense packing. "Near" is a coarse grid whose cells are several steps of the fastest body wide, see Reach.cpp. A velocity
/// gradient of the periodic cell counts by the velocity difference it makes over r. Cell and walls that a controller of ours drives count with the
/// motion that they may have in the coming step, not only with that of the last one.
namespace Reach {
/// Reach of one body for its bound [m]; 0 when the time step is not positive (the engine refuses such a step). A pass of the collider asks once for
/// each body: the second time a body is asked for, another pass has begun, and all is worked out anew.
double ofBound(const Scene& scene, int id);
/// Sum of the reaches of two bodies of `scene` [m].
double ofPair(const Scene& scene, int id1, int id2);
/// Whether other laws act beside ours, which need to know of a contact how it is sheared. Worked out together with the reaches.
bool softLawsAct(const Scene& scene);
/// The reaches are worked out once a step; this is called when the step is over (also after an error), and after what a user does to single pairs,
/// because positions and velocities may be changed by hand before the next pass.
void forget();
} // namespace Reach

} // namespace yade
