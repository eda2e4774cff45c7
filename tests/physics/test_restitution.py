# SPDX-License-Identifier: GPL-2.0-or-later
"""Newton's and Moreau's restitution against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest
from yade import O, Vector3, utils

from blocks import block
from scenes import G, dumbbell, equip, floor, grain, impulse_on, kinetic_energy, law, material, state, steps, vec

# One contact is solved in closed form: what is left are some tens of roundings of 1.1e-16.
CLOSED_FORM = 1e-13


@pytest.mark.parametrize("h", [1e-4, 1e-3, 7e-3])
@pytest.mark.parametrize("e", [0.1, 0.5, 0.9, 1.0])
def test_ratio_of_velocities_across_an_impact(e: float, h: float) -> None:
    """Every impact of a bouncing ball that arrives faster than gravity alone makes it in a step, slow ones included."""
    law(normalRestitution=e)
    floor()
    ball = grain((0, 0, 1.3))
    equip(h)
    ratios, arrival = [], []
    for _ in range(int(2 / h)):
        before = state(ball).vel[2]
        O.step()
        if before < -4 * G * h and impulse_on(ball)[2] > 0:
            ratios.append(state(ball).vel[2] / before)
            arrival.append(-before)
    assert len(ratios) >= 1
    assert np.allclose(ratios, -e, rtol=0, atol=CLOSED_FORM)
    if h == 1e-4 and e == 0.5:
        assert min(arrival) < 0.05, "no threshold hides slow impacts"


@pytest.mark.parametrize("h", [1e-4, 1e-3, 7e-3])
def test_no_restitution_stops_in_two_steps(h: float) -> None:
    """e = 0: condition (25) closes the gap in one step and ends the approach in the next; the ratio across both is 0."""
    law(normalRestitution=0)
    floor()
    ball = grain((0, 0, 1.3))
    equip(h)
    while impulse_on(ball)[2] == 0:
        O.step()
    O.step()
    assert abs(state(ball).vel[2]) < CLOSED_FORM


def test_threshold() -> None:
    for speed, expected in ((0.99, 0.0), (1.01, 0.5 * 1.01)):
        O.reset()
        law(normalRestitution=0.5, restitutionVelocity=1)
        floor()
        ball = grain((0, 0, 1), velocity=(0, 0, -speed))
        equip(1e-3, gravity=(0, 0, 0))
        O.step()
        assert state(ball).vel[2] == pytest.approx(expected, abs=CLOSED_FORM)


@pytest.mark.parametrize("e", [0.7, 0.9])
def test_apex_heights_converge_with_first_order(e: float) -> None:
    """Apex n of a ball dropped from a height H is e^(2n) H; first order in h.

    The place of an impact within its step is chance, so errors are compared over a factor 16 of h, and 4 is asked for.
    """

    def worst(h: float) -> float:
        O.reset()
        law(normalRestitution=e)
        floor()
        ball = grain((0, 0, 2))
        equip(h)
        apexes = []
        for _ in range(int(1.6 / h)):
            before = state(ball).vel[2]
            O.step()
            if before > 0 >= state(ball).vel[2]:
                apexes.append(state(ball).pos[2] - 1)
        return max(abs(a - e ** (2 * n)) for n, a in enumerate(apexes[:2], start=1))

    coarse, fine = worst(3.2e-3), worst(2e-4)
    # A step moves the fastest ball by v h = 4.4 h; two impacts and the apex itself.
    assert coarse <= 3 * 4.43 * 3.2e-3 and fine <= 3 * 4.43 * 2e-4
    assert fine < coarse / 4


@pytest.mark.parametrize("seed", range(8))
def test_oblique_impact_of_unequal_spinning_balls(seed: int) -> None:
    """Solid balls: W_T = 3.5 W_N, so P_N = -(1+e_N) U_N / W_N, P_T = -(1+e_T) U_T / W_T inside the cone of mu P_N."""
    generator = np.random.default_rng(seed)
    e_n, e_t, mu = generator.uniform(0.05, 1), generator.uniform(0, 1), generator.choice([0.05, 0.4, 3.0])
    mats = [
        law(normalRestitution=e_n, tangentialRestitution=e_t, frictionAngle=math.atan(mu), density=d) for d in (2000, 5000)
    ]
    n = generator.normal(size=3)
    n /= np.linalg.norm(n)
    r1, r2 = generator.uniform(0.5, 1.5, 2)
    one = grain((0, 0, 0), r1, velocity=generator.uniform(-1, 1, 3) + 2 * n, spin=generator.uniform(-1, 1, 3), material=mats[0])
    two = grain((r1 + r2) * n, r2, velocity=generator.uniform(-1, 1, 3) - 2 * n, spin=generator.uniform(-1, 1, 3), material=mats[1])
    u = vec(state(two).vel) - np.cross(vec(state(two).angVel), r2 * n)
    u -= vec(state(one).vel) + np.cross(vec(state(one).angVel), r1 * n)
    w = 1 / state(one).mass + 1 / state(two).mass
    ut = u - (u @ n) * n
    normal = -(1 + e_n) * (u @ n) / w
    tangential = -(1 + e_t) * ut / (3.5 * w)
    size = np.linalg.norm(tangential)
    if size > mu * normal:
        tangential *= mu * normal / size
    before = kinetic_energy()
    equip(1e-3, gravity=(0, 0, 0), tolerance=1e-13)
    O.step()
    assert impulse_on(two) == pytest.approx(normal * n + tangential, abs=1e-12 * normal)
    assert kinetic_energy() <= before * (1 + 1e-12)


def chain(gap: float, e: float, h: float = 1e-3) -> list[int]:
    law(normalRestitution=e, frictionAngle=0)
    ids = [grain((k * (2 + gap), 0, 0)) for k in range(5)]
    state(ids[0]).vel = Vector3(1, 0, 0)
    equip(h, gravity=(0, 0, 0), tolerance=1e-12, maxIterations=10000)
    return ids


@pytest.mark.parametrize("e", [1.0, 0.6])
def test_cradle_of_separate_balls_passes_the_blow_on(e: float) -> None:
    """Gaps longer than the way of a step: one impact after the other, ball n leaves with ((1+e)/2)^(n-1) v."""
    ids = chain(0.01, e)
    fastest = [0.0] * 5
    for _ in range(80 if e == 1 else 150):
        O.step()
        fastest = [max(f, state(i).vel[0]) for f, i in zip(fastest, ids)]
    assert fastest == pytest.approx([1.0] + [((1 + e) / 2) ** k for k in range(1, 5)], rel=1e-10)
    if e == 1:
        assert [state(i).vel[0] for i in ids] == pytest.approx([0, 0, 0, 0, 1], abs=1e-10)


@pytest.mark.parametrize("e", [1.0, 0.6])
def test_cradle_of_touching_balls_is_one_impact(e: float) -> None:
    """Newton's law per contact: the four balls at rest move on as one body of four masses; at e = 1 no energy is lost."""
    ids = chain(0.0, e)
    before = kinetic_energy()
    O.step()
    together = (1 + e) / 5
    assert [state(i).vel[0] for i in ids] == pytest.approx([1 - 4 * together] + 4 * [together], abs=1e-9)
    # Reduced mass 4/5 of a ball: the loss is (1 - e^2)/2 times it.
    assert before - kinetic_energy() == pytest.approx(0.4 * (1 - e**2) * state(ids[0]).mass, abs=1e-7 * before)


def test_mixed_with_a_plain_material() -> None:
    """A FrictMat has no say in restitution, and the smaller friction counts."""
    bouncing, plain = law(normalRestitution=0.5, frictionAngle=math.atan(0.8)), material(friction=0.2)
    floor(material=plain)
    ball = grain((0, 0, 1), velocity=(10, 0, -2), material=bouncing)
    equip(1e-3, gravity=(0, 0, 0))
    O.step()
    assert vec(state(ball).vel) == pytest.approx([10 - 0.2 * 3, 0, 1], abs=1e-12)


def test_rest_after_bouncing() -> None:
    """The infinite series of bounces ends in the floor contact, without a jitter of one step."""
    law(normalRestitution=0.5)
    floor()
    ball = grain((0, 0, 1.2))
    equip(1e-3)
    steps(1500)
    for _ in range(20):
        O.step()
        assert abs(state(ball).vel[2]) < 1e-12


def _surface(kind: str) -> None:
    """A fixed body of this kind with its surface in the plane z = 0 around the origin (a large ball: its top)."""
    corners = [(-9, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0)]
    if kind == "wall":
        O.bodies.append(utils.wall(0.0, axis=2, material=O.materials[0]))
    elif kind == "facets":
        for a, b, c in ((0, 1, 2), (0, 2, 3)):
            O.bodies.append(utils.facet([Vector3(*corners[k]) for k in (a, b, c)], material=O.materials[0]))
    elif kind == "polyhedron":
        state(block((0, 0, -1), (9, 9, 1))).blockedDOFs = "xyzXYZ"
    else:
        grain((0, 0, -5), radius=5, fixed=True)


@pytest.mark.parametrize("contact_law", ["quasiInelasticShock", "velocitySignorini", "signorini"])
@pytest.mark.parametrize("kind", ["wall", "facets", "polyhedron", "ball"])
@pytest.mark.parametrize("faller", ["ball", "clump"])
def test_ratio_on_every_surface_under_every_condition(kind: str, contact_law: str, faller: str) -> None:
    """One impact at 2 m/s without gravity; a clump of two balls side by side comes down on both at once."""
    law(normalRestitution=0.7, frictionAngle=0)
    _surface(kind)
    if faller == "clump":
        spread = 1.0 if kind != "ball" else 0.5
        high = 0.5005 if kind != "ball" else math.sqrt(5.5005**2 - spread**2) - 5
        number, _ = dumbbell([(-spread, 0.1 * (kind != "ball"), high), (spread, 0.1 * (kind != "ball"), high)], radius=0.5)
    else:
        number = grain((0, 0, 1.0005))
    state(number).vel = Vector3(0, 0, -2)
    equip(1e-3, gravity=(0, 0, 0), contactLaw=contact_law, tolerance=1e-13, maxIterations=5000)
    steps(3)
    # Two contacts solved to 1e-13 of the impulse.
    assert state(number).vel[2] == pytest.approx(1.4, abs=1e-11)
