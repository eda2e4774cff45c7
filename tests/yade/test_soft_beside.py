# SPDX-License-Identifier: GPL-2.0-or-later
"""Soft contacts beside Contact Dynamics in one scene: one pair of materials soft, the others rigid."""

from __future__ import annotations

import math

import pytest
from yade import (
    CohFrictMat,
    FrictMat,
    Ig2_Box_Sphere_ScGeom,
    Ig2_Facet_Sphere_ScGeom,
    Ig2_Sphere_Sphere_ScGeom,
    Ig2_Sphere_Sphere_ScGeom6D,
    Ig2_Wall_Sphere_ScGeom,
    Ip2_CohFrictMat_CohFrictMat_CohFrictPhys,
    Ip2_FrictMat_FrictMat_CapillaryPhys,
    Ip2_FrictMat_FrictMat_FrictPhys,
    Ip2_ViscElMat_ViscElMat_ViscElPhys,
    Law2_ScGeom6D_CohFrictPhys_CohesionMoment,
    Law2_ScGeom_CapillaryPhys_Capillarity,
    Law2_ScGeom_FrictPhys_CundallStrack,
    Law2_ScGeom_ViscElPhys_Basic,
    O,
    Vector3,
    ViscElMat,
    utils,
)

from prediction import step_and_compare
from scenes import active, box, cd, contact, contacts, engine, equip, floor, grain, law, material, state, steps, until_rest, vec

H = 1e-4
STIFF, VISCOUS = 1e8, 1e6


def viscoelastic() -> ViscElMat:
    """Its contacts with itself have half of each constant, because YADE puts the two bodies in series."""
    kn, cn = 2 * STIFF, 2 * VISCOUS
    return ViscElMat(kn=kn, cn=cn, ks=kn, cs=cn, frictionAngle=math.atan(0.5), density=2600)


def soft_material() -> ViscElMat:
    """A new soft material of the scene."""
    return O.materials[O.materials.append(viscoelastic())]


def add_soft_law() -> None:
    loop = engine("InteractionLoop")
    loop.physDispatcher.functors = loop.physDispatcher.functors + [Ip2_ViscElMat_ViscElMat_ViscElPhys()]
    loop.lawDispatcher.functors = loop.lawDispatcher.functors + [Law2_ScGeom_ViscElPhys_Basic()]


def pile() -> tuple[int, int, int]:
    """A rigid ball on a soft ball on a fixed soft ball."""
    rigid, soft = material(), soft_material()
    base = grain((0, 0, 0), material=soft, fixed=True)
    middle = grain((0, 0, 2), material=soft)
    top = grain((0, 0, 4), material=rigid)
    equip(H, tolerance=1e-12, maxIterations=10000)
    add_soft_law()
    return base, middle, top


def test_rigid_ball_on_a_soft_one() -> None:
    """At rest the soft contact is compressed by the weight of both balls, the rigid one not at all.

    The two contacts are told apart by their class; k = STIFF is the stiffness that YADE's law reports.
    """
    base, middle, top = pile()
    # Critical damping is 2 sqrt(k m) = 3e6 for both balls together: the motion dies out within some 0.1 s.
    until_rest(1e-9, 40000, every=1000)
    weight = state(top).mass * 9.81
    soft = O.interactions[base, middle]
    assert type(soft.phys).__name__ == "ViscElPhys"
    assert type(O.interactions[middle, top].phys).__name__ == "ContactDynamicsPhys"
    assert soft.phys.normalForce.norm() == pytest.approx(2 * weight, rel=1e-6)
    assert 2 - (state(middle).pos - state(base).pos).norm() == pytest.approx(2 * weight / soft.phys.kn, rel=1e-6)
    assert O.interactions[middle, top].phys.normalForce.norm() == pytest.approx(weight, rel=1e-6)
    assert (state(top).pos - state(middle).pos).norm() == pytest.approx(2, abs=1e-9)
    assert cd().contacts == 1, "soft contacts are none of the engine's"


def test_prediction_includes_soft_forces() -> None:
    """Soft forces are external to the solve."""
    pile()
    for _ in range(50):
        step_and_compare(forces=2 * STIFF / state(1).mass * 1e-2)


def test_layers_of_soft_and_rigid_grains() -> None:
    """Five rigid balls fall on a bed of soft ones on a rigid floor; weights add up on the floor.

    Soft balls meet the floor and the rigid balls by Contact Dynamics: YADE takes the functor of the common base class.
    """
    rigid, soft = material(friction=0.6), soft_material()
    plate = floor(material=rigid)
    for x, y in ((-1, -1), (-1, 1), (1, -1), (1, 1)):
        grain((x, y, 1), material=soft)
    grain((0, 0, 1 + math.sqrt(2) + 0.01), material=rigid)
    for b in O.bodies:  # the bed stays together without walls
        if b.id in (1, 2, 3, 4):
            b.state.blockedDOFs = "xyXYZ"
    equip(H, tolerance=1e-6, maxIterations=10000)
    add_soft_law()
    steps(6000)
    weight = sum(b.state.mass for b in O.bodies if b.dynamic) * 9.81
    kinds = {type(i.phys).__name__ for i in O.interactions if i.isReal}
    assert kinds == {"ViscElPhys", "ContactDynamicsPhys"}
    assert vec(O.forces.f(plate))[2] == pytest.approx(-weight, rel=1e-4)
    # Four contacts with the floor; the ball needs two of its four, which share its load in many ways.
    assert len(active()) >= 6


def test_cohesive_soft_pair_in_a_scene_of_rigid_grains() -> None:
    """A ball glued to a fixed one (geometry of another class, ScGeom6D) hangs there; a rigid ball beside it rests."""
    rigid = material()
    strong = dict(isCohesive=True, normalCohesion=1e9, shearCohesion=1e9)
    glue = O.materials[O.materials.append(CohFrictMat(young=1e7, frictionAngle=0.5, density=2600, **strong))]
    hook = grain((0, 0, 20), material=glue, fixed=True)
    hung = grain((0, 0, 18), material=glue)
    floor(material=rigid)
    ball = grain((5, 0, 1), material=rigid)
    equip(H)
    add_cohesive_law()
    steps(200)
    pull = O.interactions[hook, hung].phys.normalForce.norm()
    assert pull > 0 and state(hung).pos[2] > 17.9
    assert vec(O.forces.f(ball))[2] == pytest.approx(state(ball).mass * 9.81, rel=1e-6)
    assert [type(i.phys).__name__ for i in contacts()] == ["ContactDynamicsPhys"]


def add_cundall_strack() -> None:
    """Plain FrictMats become soft, and pairs of ContactDynamicsMats rigid."""
    loop = engine("InteractionLoop")
    rigid = [f for f in loop.physDispatcher.functors if "ContactDynamicsMat" in type(f).__name__]
    loop.physDispatcher.functors = [Ip2_FrictMat_FrictMat_FrictPhys()] + rigid
    loop.lawDispatcher.functors = loop.lawDispatcher.functors + [Law2_ScGeom_FrictPhys_CundallStrack()]


def add_cohesive_law() -> None:
    """The collision functor with rotations serves every pair of spheres: our law takes its geometry as the base class."""
    loop = engine("InteractionLoop")
    others = [f for f in loop.geomDispatcher.functors if "Sphere_Sphere" not in type(f).__name__]
    loop.geomDispatcher.functors = others + [Ig2_Sphere_Sphere_ScGeom6D()]
    glued = Ip2_CohFrictMat_CohFrictMat_CohFrictPhys(setCohesionNow=True, setCohesionOnNewContacts=True)
    loop.physDispatcher.functors = loop.physDispatcher.functors + [glued]
    loop.lawDispatcher.functors = loop.lawDispatcher.functors + [Law2_ScGeom6D_CohFrictPhys_CohesionMoment()]


def test_cundall_strack_by_material_pair() -> None:
    """A rigid ball on a rigid ball on a soft one on a fixed soft one: the classes of the two materials decide, the mixed pair is soft.

    All radii are 1 m and all moduli 1e7 Pa, so YADE's stiffness is 1e7 N/m; the balls start in equilibrium and stay there.
    """
    stiffness = 1e7
    soft = O.materials[O.materials.append(FrictMat(young=stiffness, poisson=0.3, frictionAngle=0.5, density=2600))]
    rigid = law(young=stiffness)
    weight = 2600 * 4 / 3 * math.pi * 9.81
    first, second = 2 - 3 * weight / stiffness, 2 - 2 * weight / stiffness
    base, middle = grain((0, 0, 0), material=soft, fixed=True), grain((0, 0, first), material=soft)
    lower, upper = grain((0, 0, first + second), material=rigid), grain((0, 0, first + second + 2), material=rigid)
    equip(H, tolerance=1e-10)
    add_cundall_strack()
    steps(500)
    found = [O.interactions[pair].phys for pair in ((base, middle), (middle, lower), (lower, upper))]
    assert [type(phys).__name__ for phys in found] == ["FrictPhys", "FrictPhys", "ContactDynamicsPhys"]
    # The springs swing by the rounding of their positions, 1e-16 m, and the residual of the rigid pair, 1e-10 of its force.
    assert [phys.normalForce.norm() for phys in found] == pytest.approx([3 * weight, 2 * weight, weight], rel=1e-8)
    assert (state(upper).pos - state(lower).pos).norm() == pytest.approx(2, abs=1e-9)


SOFT_LAWS = {
    "viscoelastic": (viscoelastic, add_soft_law),
    "CundallStrack": (lambda: FrictMat(young=1e7, poisson=0.3, frictionAngle=0.5, density=2600), add_cundall_strack),
    "cohesive": (
        lambda: CohFrictMat(young=1e7, frictionAngle=0.5, density=2600, isCohesive=True, normalCohesion=1e5, shearCohesion=1e5),
        add_cohesive_law,
    ),
}


@pytest.mark.parametrize("kind", SOFT_LAWS)
def test_soft_pairs_keep_their_bits_beside_rigid_ones(kind: str) -> None:
    """Two soft balls that collide move the same to the bit with and without the engine, while rigid ones collide beside them."""
    tracks = []
    make, add = SOFT_LAWS[kind]
    for use in (True, False):
        O.reset()
        soft = O.materials[O.materials.append(make())]
        grain((0, 0, 0), velocity=(3, 0, 0), material=soft)
        grain((2.005, 0.5, 0), velocity=(-2, 0, 1), material=soft)
        if use:
            rigid = law()
            grain((0, 9, 0), velocity=(3, 0, 0), material=rigid)
            grain((2.005, 9.5, 0), velocity=(-2, 0, 1), material=rigid)
        equip(H, gravity=(0, 0, 0))
        add()
        if not use:
            O.engines = [e for e in O.engines if type(e).__name__ != "ContactDynamicsEngine"]
        track = []
        steps(400, lambda: track.append([tuple(state(n).vel) + tuple(state(n).angVel) for n in (0, 1)]))
        tracks.append(track)
        assert abs(state(0).vel[0] - 3) > 0.1, "the balls did not meet"
        if use:
            assert contact(2, 3) is not None and abs(state(2).vel[0] - 3) > 0.1, "nor did the rigid ones"
    assert tracks[0] == tracks[1]


@pytest.mark.parametrize("rigid_pair", [True, False])
def test_capillarity_engine_has_no_contacts_of_other_laws_beside_it(rigid_pair: bool, tmp_path, monkeypatch) -> None:
    """YADE's Law2_ScGeom_CapillaryPhys_Capillarity casts every interaction to its own class unseen: refused before it touches one of ours."""
    monkeypatch.chdir(tmp_path)  # it looks for its tables where YADE runs, and acts without them, too, with bridges of no force
    wet = O.materials[O.materials.append(FrictMat(young=1e7, poisson=0.3, frictionAngle=0.5, density=2600))]
    grain((0, 0, 8), material=wet)
    grain((0, 0, 10), material=wet, fixed=True)
    rigid = law()
    lower, upper = grain((5, 0, 0), material=rigid, fixed=True), grain((5, 0, 2 if rigid_pair else 3), material=rigid)
    equip(H)
    loop = engine("InteractionLoop")
    loop.physDispatcher.functors = [Ip2_FrictMat_FrictMat_CapillaryPhys()] + [
        f for f in loop.physDispatcher.functors if "ContactDynamicsMat" in type(f).__name__
    ]
    loop.lawDispatcher.functors = loop.lawDispatcher.functors + [Law2_ScGeom_FrictPhys_CundallStrack(neverErase=True)]
    dry = O.engines
    O.engines = dry[:3] + [Law2_ScGeom_CapillaryPhys_Capillarity(capillaryPressure=1)] + dry[3:]
    if not rigid_pair:
        steps(3)
        assert type(O.interactions[0, 1].phys).__name__ == "CapillaryPhys"
        return
    with pytest.raises(RuntimeError, match=f"#{lower}\\+#{upper}: Law2_ScGeom_CapillaryPhys_Capillarity.*ViscElCapMat"):
        O.step()
    assert not O.interactions[lower, upper].isReal and state(upper).vel[2] == 0
    O.engines = dry
    steps(2)
    assert contact(lower, upper).phys.normalForce.norm() == pytest.approx(state(upper).mass * 9.81, rel=1e-9)
    # Added while such contacts exist: the engine says so in the step before the other one acts.
    O.engines = dry + [Law2_ScGeom_CapillaryPhys_Capillarity(capillaryPressure=1)]
    with pytest.raises(RuntimeError, match="Capillarity"):
        O.step()


@pytest.mark.parametrize("target", ["sphere", "wall", "box", "facet"])
@pytest.mark.parametrize("kind", ["viscoelastic", "CundallStrack"])
def test_soft_contacts_follow_their_shear_as_with_the_stock_functors(kind: str, target: str) -> None:
    """A ball that rubs a fixed body gets the velocity and the spin that YADE's own Ig2 functors give it.

    Both take the increments of shear from the same function of YADE. Where the body is no sphere, YADE's functors find the gap by other formulas: round-off
    of 1e-16 of 1 m, over an overlap of 1e-3. On a wall they have the contact point in the wall, ours is in the middle of the overlap, half of which is
    5e-4 of the lever arm.
    """
    ends = []
    make, add = SOFT_LAWS[kind]
    for stock in (True, False):
        O.reset()
        soft = O.materials[O.materials.append(make())]
        if target == "sphere":
            grain((0, 0, 0), material=soft, fixed=True)
        elif target == "wall":
            O.bodies.append(utils.wall((0, 0, 1), axis=2, material=soft))
        elif target == "box":
            box((0, 0, 0), (9, 9, 1), material=soft)
        else:
            O.bodies.append(utils.facet([(-9, -9, 1), (9, -9, 1), (0, 9, 1)], material=soft, fixed=True))
        ball = grain((0, 0, 1.999), velocity=(1, 0.5, 0), material=soft)
        equip(H)
        add()
        loop = engine("InteractionLoop")
        if stock:
            loop.geomDispatcher.functors = [Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom(), Ig2_Box_Sphere_ScGeom(), Ig2_Facet_Sphere_ScGeom()]
        steps(100)
        found = [i for i in O.interactions if i.isReal]
        assert len(found) == 1 and found[0].phys.shearForce.norm() > 1
        ends.append([*state(ball).vel, *state(ball).angVel, *found[0].phys.shearForce])
    assert abs(ends[0][0] - 1) > 1e-3 and abs(ends[0][4]) > 1e-3, "the ball was not rubbed"
    assert ends[1] == pytest.approx(ends[0], rel=1e-3 if target == "wall" else 1e-9, abs=1e-9)


def test_shear_force_of_a_soft_contact_turns_with_it() -> None:
    """Two balls stuck together by friction and turned as one body by a quarter: the force stays tangential."""
    soft = O.materials[O.materials.append(FrictMat(young=1e7, poisson=0.3, frictionAngle=1.4, density=2600))]
    grain((0, 0, 0), material=soft, fixed=True)
    rolling = grain((0, 0, 1.999), velocity=(0.3, 0, 0), material=soft)
    equip(H, gravity=(0, 0, 0))
    add_cundall_strack()
    steps(100)
    # Round the first ball, both turning at the same rate.
    rate = 2.0
    for body in (0, rolling):
        O.bodies[body].state.blockedDOFs = "xyzXYZ"
        state(body).angVel = Vector3(0, rate, 0)
    phys, geom = O.interactions[0, rolling].phys, O.interactions[0, rolling].geom
    before = phys.shearForce.norm()
    for _ in range(int(math.pi / 2 / rate / H)):
        state(rolling).vel = Vector3(0, rate, 0).cross(state(rolling).pos)
        O.step()
    phys, geom = O.interactions[0, rolling].phys, O.interactions[0, rolling].geom
    assert abs(geom.normal[0]) > 0.99 and phys.shearForce.norm() == pytest.approx(before, rel=7854 * (rate * H) ** 2)
    # YADE turns it by small angles, w h = 2e-4 each: it leaves the plane, and grows, by the square of that a step, 7854 steps.
    assert abs(phys.shearForce.dot(geom.normal)) < 7854 * (rate * H) ** 2 * before
