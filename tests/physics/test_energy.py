# SPDX-License-Identifier: GPL-2.0-or-later
"""O.energy: the balance closes, and every term has its sign.

The leapfrog has its velocities in the middle of a step: there potential energies are taken, z - h v / 2, and then the work
of gravity is exactly m g (z change).
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from yade import O, Vector3

from scenes import G, box, cd, contact, equip, floor, grain, kinetic_energy, law, state, steps


def potential(g: float) -> float:
    return sum(b.state.mass * g * (b.state.pos[2] - 0.5 * O.dt * b.state.vel[2]) for b in O.bodies if b.dynamic)


def terms() -> dict[str, float]:
    return {name: O.energy[name] for name in O.energy.keys() if name.startswith("contact")}


def gas(gravity: float, **attributes) -> float:
    """60 balls fly about in a box; returns the energy exchanged, for scale."""
    generator = np.random.default_rng(3)
    law(**attributes)
    for axis in range(3):
        for sign in (-1, 1):
            center, half = [0, 0, 0], [9, 9, 9]
            center[axis], half[axis] = 8 * sign, 1
            box(center, half)
    for k in range(60):
        place = 3 * np.array([k % 4 - 1.5, k // 4 % 4 - 1.5, k // 16 - 1.5])
        grain(place, radius=generator.uniform(0.7, 1), velocity=generator.uniform(-4, 4, 3), spin=generator.uniform(-2, 2, 3))
    equip(5e-3, gravity=(0, 0, -gravity), tolerance=1e-6, maxIterations=5000)
    O.trackEnergy = True
    return kinetic_energy()


EVERYTHING = dict(normalRestitution=0.5, tangentialRestitution=0.3, restitutionVelocity=0.1, frictionAngle=0.3, staticFrictionAngle=0.6)
EVERYTHING.update(cohesionForce=1e4, cohesionStress=1e3, rollingFriction=0.05, twistingFriction=0.05)


@pytest.mark.parametrize(
    "attributes, seen",
    [
        (dict(normalRestitution=0.8, frictionAngle=0.3), {"contactFriction", "contactRestitution"}),
        (dict(frictionAngle=0.3), {"contactFriction", "contactImpact"}),
        (
            dict(normalRestitution=0.6, tangentialRestitution=0.4, rollingFriction=0.05, twistingFriction=0.05),
            {"contactFriction", "contactRestitution", "contactRolling"},
        ),
        (dict(cohesionForce=2e4), {"contactCohesion", "contactFriction", "contactImpact"}),
        (dict(kn=2e8, ks=1e8, normalDamping=1e4), {"contactDamping"}),
        (EVERYTHING, {"contactCohesion", "contactFriction", "contactRestitution", "contactRolling"}),
    ],
)
@pytest.mark.parametrize("gravity", [0.0, G])
def test_balance_of_a_gas(gravity: float, attributes: dict, seen: set) -> None:
    scale = gas(gravity, **attributes)
    start = kinetic_energy() + potential(gravity)
    steps(300)
    lost = terms()
    # Round-off only, whatever the residual of the solves: some 1e4 sums of relative error 1e-16.
    assert kinetic_energy() + potential(gravity) + sum(lost.values()) == pytest.approx(start, abs=1e-10 * scale)
    assert seen <= set(lost)
    for name in seen:
        assert lost[name] > 1e-4 * scale, name


def test_conserving_gas() -> None:
    """e = 1 without friction: nothing is lost, to the residual of the solves."""
    scale = gas(0, normalRestitution=1, frictionAngle=0)
    steps(300)
    # Impacts of several balls at once are solved to 1e-6 of the impulse; a few hundred of them.
    assert abs(sum(terms().values())) < 1e-3 * scale


def test_sliding_block() -> None:
    """Friction takes mu m g times the way, with the way in the middle of the steps."""
    law(frictionAngle=math.atan(0.3))
    floor()
    ball = grain((0, 0, 1), velocity=(3, 0, 0))
    state(ball).blockedDOFs = "XYZ"
    equip(1e-3, tolerance=1e-12)
    O.trackEnergy = True
    before = state(ball).pos[0] - 0.5 * O.dt * state(ball).vel[0]
    steps(500)
    way = state(ball).pos[0] - 0.5 * O.dt * state(ball).vel[0] - before
    assert O.energy["contactFriction"] == pytest.approx(0.3 * state(ball).mass * G * way, rel=1e-10)


def test_pushing_an_overlap_out_shows_as_negative_impact() -> None:
    """Condition (24) gives a ball with overlap d the velocity d/h, out of nothing."""
    law()
    floor()
    ball = grain((0, 0, 0.999))
    equip(1e-3, gravity=(0, 0, 0), contactLaw="signorini")
    O.trackEnergy = True
    O.step()
    assert O.energy["contactImpact"] == pytest.approx(-0.5 * state(ball).mass, rel=1e-9)


def test_bond_takes_energy_when_it_breaks() -> None:
    """In the step of the break the bond pulls with its strength: its work is strength times the way of that step."""
    law(cohesionForce=1000)
    grain((0, 0, 0), fixed=True)
    ball = grain((0, 0, 2))
    equip(1e-3, gravity=(0, 0, 0))
    O.trackEnergy = True
    O.forces.setPermF(ball, Vector3(0, 0, 3000))
    O.step()
    assert O.energy["contactCohesion"] == pytest.approx(1000 * 0.5 * O.dt * state(ball).vel[2], rel=1e-9)


def test_balance_of_a_pour() -> None:
    """Some hundred grains from the fall to rest, with penetration repair: what it lifts is a term of its own."""
    generator = np.random.default_rng(8)
    law(frictionAngle=math.atan(0.4))
    floor()
    for sign in (-1, 1):
        box((7 * sign, 0, 10), (1, 10, 30))
        box((0, 7 * sign, 10), (10, 1, 30))
    for k in range(250):
        place = 2.3 * np.array([k % 5 - 2, k // 5 % 5 - 2, k // 25 + 0.6])
        grain(place + generator.uniform(-0.1, 0.1, 3), radius=generator.uniform(0.8, 1), velocity=generator.uniform(-3, 3, 3))
    equip(0.05 / math.sqrt(G), maxIterations=300, onNonConvergence="ignore")
    O.trackEnergy = True
    start, first = kinetic_energy() + potential(G), potential(G)
    lifted = 0.0

    def count() -> None:
        nonlocal lifted
        lifted += cd().repairDisplacement

    steps(500, count)
    lost, exchanged = terms(), first - potential(G)
    assert kinetic_energy() < 1e-3 * exchanged, "the pour is meant to have come to rest"
    # Round-off, whatever the residual: 500 steps with sums over 1e3 contacts and positions of relative error 1e-16.
    assert kinetic_energy() + potential(G) + sum(lost.values()) == pytest.approx(start, abs=1e-10 * exchanged)
    assert lost["contactFriction"] > 0 and lost["contactImpact"] > 0
    assert lifted > 0 and abs(lost["contactRepair"]) < 1e-2 * exchanged


@pytest.mark.parametrize("attributes", [dict(), dict(rollingFriction=0.1), dict(staticFrictionAngle=0.7)])
def test_balance_of_a_sheared_box(attributes: dict) -> None:
    """Grains between a floor and a lid of balls that is driven sideways, each of them pressed down: the lid puts in force times way."""
    generator = np.random.default_rng(9)
    law(frictionAngle=math.atan(0.5), **attributes)
    floor()
    for sign in (-1, 1):
        box((9 * sign, 0, 5), (1, 20, 15))
        box((0, 5 * sign, 5), (20, 1, 15))
    for k in range(96):
        place = 2 * np.array([k % 8 - 3.5, k // 8 % 4 - 1.5, k // 32 + 0.5])
        grain(place, radius=generator.uniform(0.85, 1))
    lid = [grain((1.5 * x, 1.5 * y, 6.95), fixed=True) for x in range(-4, 5) for y in range(-2, 3)]
    for number in lid:
        state(number).blockedDOFs = "xyXYZ"
    equip(5e-3, tolerance=1e-4, maxIterations=2000)
    O.trackEnergy = True
    for number in lid:
        O.forces.setPermF(number, Vector3(0, 0, -3 * state(number).mass * G))
    steps(100)
    for number in lid:
        state(number).vel = Vector3(1.0, 0, state(number).vel[2])

    def pressed() -> float:
        """Potential energy of the permanent forces."""
        return sum(3 * state(n).mass * G * (state(n).pos[2] - 0.5 * O.dt * state(n).vel[2]) for n in lid)

    def mechanical() -> float:
        return kinetic_energy() + potential(G) + pressed()

    before, booked, put_in = mechanical(), terms(), 0.0

    def work() -> None:
        nonlocal put_in
        # The force on the lid is what the grains resist with; its sideways velocity is the same at both ends of the step.
        put_in -= sum(O.dt * O.forces.f(n)[0] for n in lid)

    steps(400, work)
    grown = {name: value - booked.get(name, 0) for name, value in terms().items()}
    assert put_in > 0 and grown["contactFriction"] > 0.5 * put_in
    assert grown["contactBoundary"] == pytest.approx(-put_in, rel=1e-9), "what the lid gives is booked as its work"
    assert abs(mechanical() - before + sum(grown.values())) < 1e-9 * put_in
    if "rollingFriction" in attributes:
        assert terms()["contactRolling"] > 0


def test_repair_books_what_it_lifts() -> None:
    """A ball with an overlap is lifted by it: weight times height, negative because it is given, and part of YADE's gravWork as well."""
    law()
    floor()
    ball = grain((0, 0, 0.99))
    equip(1e-3)
    O.trackEnergy = True
    steps(200)
    lifted = state(ball).mass * G * (state(ball).pos[2] - 0.99)
    assert lifted > 0.9 * state(ball).mass * G * 0.01
    assert O.energy["contactRepair"] == pytest.approx(-lifted, rel=1e-9)
    assert O.energy["gravWork"] == pytest.approx(lifted, rel=1e-9)
    assert kinetic_energy() == 0


def test_laws_that_only_take() -> None:
    """Friction with one or two coefficients, rolling and twisting friction, plain impacts: in no step of a free gas is energy given.

    Together, r . (U- + U+) / 2 = r . U+ - r . W r / 2 is not positive; the split among the terms of one step may be.
    """
    for attributes in (dict(frictionAngle=0.3, staticFrictionAngle=0.6), dict(rollingFriction=0.1, twistingFriction=0.1), dict()):
        O.reset()
        gas(0, **attributes)
        booked, rises = 0.0, []
        for _ in range(150):
            O.step()
            rises.append(sum(terms().values()) - booked)
            booked += rises[-1]
        # r . U+ is negative but for the residual, 1e-6 of the impulses.
        assert min(rises) >= -1e-6 * max(rises) and booked > 0
        assert all(value > 0 for value in terms().values()), terms()


def test_tangential_spring_stores_what_the_ball_gives() -> None:
    """A ball that can only slide, pressed by a constant overlap: kinetic energy goes to and fro between it and ks s^2 / 2, nothing is damped.

    The springs are averaged over neighbouring steps, which keeps the energy of an oscillation but for a share p = x^2, x = h^2 ks / m = 2.5e-4 here, of
    the force (ShiftedContacts.hpp), that is p x = 1.5e-11 of the energy a step.
    """
    kn, ks, overlap = 1e9, 1e6, 1e-3
    plate = floor(material=law(frictionAngle=math.atan(5)))
    ball = grain((0, 0, 1 - overlap), velocity=(1e-3, 0, 0), material=law(kn=kn, ks=ks, frictionAngle=math.atan(5)))
    state(ball).blockedDOFs = "zXYZ"
    h = 2 * math.pi * math.sqrt(state(ball).mass / ks) / 400
    equip(h, gravity=(0, 0, 0), tolerance=1e-13, repairRate=0)
    O.trackEnergy = True
    start = kinetic_energy()
    normal = 0.5 * kn * overlap**2
    x = h * h * ks / state(ball).mass
    stretches = []
    for _ in range(500):
        O.step()
        phys = contact(plate, ball).phys
        # Half-way between the last two positions, as all energies are.
        middle = phys.stretch[0] - 0.5 * h * state(ball).vel[0]
        stretches.append(phys.stretch[0])
        assert phys.status == "sticking"
        assert O.energy["contactElastic"] - normal == pytest.approx(0.5 * ks * middle**2, abs=1e-12 * normal)
    assert max(stretches) == pytest.approx(1e-3 * math.sqrt(state(ball).mass / ks), rel=1e-3)
    # The overlap is there from the start: its energy comes from nowhere. And the velocity given at the start belongs to the middle of the step before,
    # where the stretch was -v h / 2: the energy of that, ks (v h / 2)^2 / 2, counts as lost.
    assert O.energy["contactDamping"] + normal == pytest.approx(0.25 * x * start, rel=1e-2, abs=1e-12 * normal)
