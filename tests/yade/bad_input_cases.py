# SPDX-License-Identifier: GPL-2.0-or-later
"""Wrong values, one per function: a clear error, then the value is repaired and the scene goes on.

They run in another YADE, with two threads, because an exception that leaves a parallel loop, or YADE's own `exit(1)`
for a missing law, would end the process and with it all other tests.
"""

from __future__ import annotations

import json
import math
import re
import traceback
from typing import Callable

import pytest
from yade import Ig2_Sphere_Sphere_L3Geom, Matrix3, O, Vector3

from contactdynamics import *  # noqa: F403
from refusal import refused
from scenes import cd, contact, engine, equip, floor, grain, material, state, steps, vec

NAN, INF = float("nan"), float("inf")
BALL, H = 1, 5e-3


def scene(height: float = 1.0) -> None:
    """Floor #0, ball #1 on or above it, ball #2 falling elsewhere."""
    material(friction=0.5)
    floor()
    grain((0, 0, height))
    grain((5, 0, 1.5))
    equip(H)


def goes_on() -> None:
    """After the repair both balls come to rest on the floor and weigh what they weigh."""
    steps(120)
    for number in (BALL, 2):
        assert abs(state(number).pos[2] - 1) < 1e-9, f"#{number} is at {state(number).pos}"
        assert state(number).vel.norm() < 1e-9
        assert abs(vec(O.forces.f(number))[2] / (9.81 * state(number).mass) - 1) < 1e-6


def _number(attribute: str, value, good, *words: str, height: float = 1.0) -> None:
    scene(height)
    steps(2)
    setattr(state(BALL), attribute, value)
    refused(*words)
    setattr(state(BALL), attribute, good)
    if attribute != "vel":
        state(BALL).vel = Vector3(0, 0, 0)
    goes_on()


def position_nan() -> None:
    _number("pos", Vector3(NAN, 0, 1), Vector3(0, 0, 1), r"#?\b1\b", "pos", "nan")


def position_infinite() -> None:
    _number("pos", Vector3(0, 0, INF), Vector3(0, 0, 1), r"#?\b1\b", "pos", "inf")


def position_nan_in_the_air() -> None:
    _number("pos", Vector3(0, NAN, 1.2), Vector3(0, 0, 1.2), r"#?\b1\b", "pos", "nan", height=1.2)


def velocity_nan() -> None:
    _number("vel", Vector3(0, NAN, 0), Vector3(0, 0, 0), r"#?\b1\b", "vel", "nan")


def velocity_infinite() -> None:
    _number("vel", Vector3(0, 0, -INF), Vector3(0, 0, 0), r"#?\b1\b", "vel", "inf")


def velocity_nan_in_the_air() -> None:
    _number("vel", Vector3(NAN, 0, 0), Vector3(0, 0, 0), r"#?\b1\b", "vel", "nan", height=1.3)


def angular_velocity_nan() -> None:
    _number("angVel", Vector3(0, NAN, 0), Vector3(0, 0, 0), r"#?\b1\b", "angVel|angular", "nan")


def angular_momentum_nan() -> None:
    scene()
    O.bodies[BALL].aspherical = True
    state(BALL).inertia = Vector3(4e3, 5e3, 6e3)
    steps(2)
    state(BALL).angMom = Vector3(NAN, 0, 0)
    refused(r"#?\b1\b", "angMom|momentum", "nan")
    state(BALL).angMom = Vector3(0, 0, 0)
    goes_on()


def mass_nan() -> None:
    mass = 4 / 3 * math.pi * 2600
    _number("mass", NAN, mass, r"#?\b1\b", "mass", "nan")


def mass_zero() -> None:
    mass = 4 / 3 * math.pi * 2600
    _number("mass", 0, mass, r"#?\b1\b", "mass", r"\b0")


def mass_negative() -> None:
    mass = 4 / 3 * math.pi * 2600
    _number("mass", -2, mass, r"#?\b1\b", "mass", "-2")


def mass_infinite() -> None:
    mass = 4 / 3 * math.pi * 2600
    _number("mass", INF, mass, r"#?\b1\b", "mass", "inf")


def inertia_zero() -> None:
    good = Vector3(1, 1, 1) * (0.4 * 4 / 3 * math.pi * 2600)
    _number("inertia", Vector3(0, 1, 1), good, r"#?\b1\b", "inertia", r"\b0")


def inertia_negative() -> None:
    good = Vector3(1, 1, 1) * (0.4 * 4 / 3 * math.pi * 2600)
    _number("inertia", Vector3(1, -3, 1), good, r"#?\b1\b", "inertia", "-3")


def inertia_nan() -> None:
    good = Vector3(1, 1, 1) * (0.4 * 4 / 3 * math.pi * 2600)
    _number("inertia", Vector3(1, 1, NAN), good, r"#?\b1\b", "inertia", "nan")


def force_nan() -> None:
    """A load that is no number would make every velocity one; the mistake is named before that."""
    scene()
    O.forces.setPermF(BALL, Vector3(NAN, 0, 0))
    refused(r"#?\b1\b", "force", "nan")
    O.forces.setPermF(BALL, Vector3(0, 0, 0))
    goes_on()


def radius_nan() -> None:
    _radius(NAN, "nan")


def radius_negative() -> None:
    _radius(-1.0, "-1")


def _radius(value: float, shown: str) -> None:
    """From the first step on: the collider never sees such a sphere, so that no contact could complain."""
    scene()
    O.bodies[BALL].shape.radius = value
    refused(r"#?\b1\b", "radius", shown)
    O.bodies[BALL].shape.radius = 1
    goes_on()


def velocity_gradient_nan() -> None:
    O.periodic = True
    O.cell.setBox(100, 100, 100)
    material()
    grain((1, 2, 3))
    equip(H, gravity=(0, 0, 0))
    O.cell.velGrad = Matrix3(0, NAN, 0, 0, 0, 0, 0, 0, 0)
    refused("O.cell.velGrad", "nan")
    O.cell.velGrad = Matrix3(0, 0, 0, 0, 0, 0, 0, 0, 0)
    O.step()
    assert (state(0).pos - Vector3(1, 2, 3)).norm() == 0


def values_of_fixed_bodies_do_not_matter() -> None:
    """Mass and inertia of what cannot move are never used: no error."""
    scene()
    for wrong in (0, -1, NAN):
        state(0).mass = wrong
        state(0).inertia = Vector3(wrong, wrong, wrong)
        O.step()
    goes_on()


def mass_of_a_body_blocked_in_translation() -> None:
    """Only the free degrees of freedom need a positive mass: no error for blocked ones."""
    scene()
    state(BALL).blockedDOFs = "xyz"
    state(BALL).mass = 0
    O.step()
    O.step()


def step_zero() -> None:
    _time_step(0.0, r"\b0")


def step_negative() -> None:
    """YADE itself refuses the assignment, unless a TimeStepper is in the list (negative: an automatic step)."""
    scene()
    steps(2)
    try:
        O.dt = -1e-3
    except RuntimeError:
        pass
    else:
        refused("dt|time step", "-0?.?0*1")
        O.dt = H
    goes_on()


def step_nan() -> None:
    _time_step(NAN, "nan")


def _time_step(value: float, shown: str) -> None:
    scene()
    steps(2)
    O.dt = value
    refused("dt|time step", shown)
    O.dt = H
    goes_on()


def friction_negative_in_material() -> None:
    _friction(-0.2, "-0?.?[0-9]")


def friction_nan_in_material() -> None:
    _friction(NAN, "nan")


def friction_right_angle_in_material() -> None:
    """The tangent of pi/2 + a little is negative."""
    _friction(math.pi / 2 + 0.1, "fric")


def _friction(angle: float, shown: str) -> None:
    scene()
    O.materials[0].frictionAngle = angle
    refused("fric", shown)
    O.materials[0].frictionAngle = 0.5
    goes_on()


def friction_negative_in_contact() -> None:
    _contact_friction(-0.3, "-0?.3")


def friction_nan_in_contact() -> None:
    _contact_friction(NAN, "nan")


def _contact_friction(value: float, shown: str) -> None:
    scene()
    O.step()
    contact(0, BALL).phys.tangensOfFrictionAngle = value
    refused("fric", r"#?\b1\b", shown)
    contact(0, BALL).phys.tangensOfFrictionAngle = 0.5
    goes_on()


def unknown_contact_law_at_construction() -> None:
    names = ("quasiInelasticShock", "velocitySignorini", "signorini")
    _raises(lambda: ContactDynamicsEngine(contactLaw="newtonLaw"), "contactLaw", "newtonLaw", *names)


def unknown_contact_law_by_assignment() -> None:
    scene()
    steps(2)

    def assign_and_step() -> None:
        cd().contactLaw = "shock"
        O.step()

    _raises(assign_and_step, "contactLaw", "shock", "quasiInelasticShock")
    cd().contactLaw = "quasiInelasticShock"
    goes_on()


def unknown_answer_to_non_convergence() -> None:
    def make_and_step() -> None:
        scene()
        cd().onNonConvergence = "panic"
        O.step()

    _raises(make_and_step, "onNonConvergence", "panic", "warn", "raise", "ignore")
    cd().onNonConvergence = "warn"
    goes_on()


def unknown_acceleration() -> None:
    def make_and_step() -> None:
        scene()
        cd().acceleration = "fast"
        O.step()

    _raises(make_and_step, "acceleration", "fast", "default", "none")
    assert cd().acceleration == "default"
    goes_on()


def tolerance_out_of_range() -> None:
    scene()
    for wrong in (0.0, -1.0, NAN):

        def assign_and_step() -> None:
            cd().tolerance = wrong
            O.step()

        _raises(assign_and_step, "tolerance")
        cd().tolerance = 1e-4
    goes_on()


def iterations_out_of_range() -> None:
    scene()
    for wrong in (0, -3):

        def assign_and_step() -> None:
            cd().maxIterations = wrong
            O.step()

        _raises(assign_and_step, "maxIterations", str(wrong))
        cd().maxIterations = 1000
    goes_on()


def _raises(action: Callable[[], None], *words: str) -> None:
    try:
        action()
    except (RuntimeError, ValueError) as error:
        for word in words:
            assert re.search(re.escape(word), str(error)), f"{word!r} is missing in the message: {error}"
        return
    raise AssertionError("no error was raised")


def no_material() -> None:
    scene()
    good = O.bodies[BALL].material
    O.bodies[BALL].material = None
    refused(r"#?\b1\b", "material")
    O.bodies[BALL].material = good
    goes_on()


def no_material_in_the_air() -> None:
    """A ball without material that touches nothing yet is named as well, or falls until it is."""
    scene(height=1.2)
    good = O.bodies[BALL].material
    O.bodies[BALL].material = None
    for _ in range(120):
        try:
            O.step()
        except (RuntimeError, ValueError) as error:
            assert re.search("material", str(error)) and re.search(r"\b1\b", str(error)), str(error)
            break
    else:
        raise AssertionError("the ball without material came to rest without an error")
    O.bodies[BALL].material = good
    goes_on()


def body_erased_between_steps() -> None:
    """Erasing is allowed in YADE: the contacts of the body vanish, what lay on it falls, nothing else changes."""
    scene()
    upper = grain((0, 0, 3))
    steps(10)
    # The default tolerance of 1e-4 leaves up to that part of g h in the velocities of a column of two, in each step.
    assert abs(state(upper).pos[2] - 3) < 10 * 1e-4 * 9.81 * H * H
    O.bodies.erase(BALL)
    O.step()
    assert contact(0, BALL) is None and cd().freeVelocities()[BALL] is None
    steps(300)
    assert abs(state(upper).pos[2] - 1) < 1e-9 and abs(state(2).pos[2] - 1) < 1e-9


def body_erased_while_in_contact_and_a_new_one_in_its_place() -> None:
    """Nothing of the old contact passes on to a new body at the same place."""
    scene()
    steps(10)
    O.bodies.erase(BALL)
    new = grain((0, 0, 1.5))
    O.step()
    assert contact(0, new) is None or contact(0, new).phys.impulse.norm() == 0
    steps(300)
    assert abs(state(new).pos[2] - 1) < 1e-9


def geometry_that_the_law_does_not_know() -> None:
    """Without a word from us YADE would end the process here."""
    scene()
    grain((5, 0, 3.5))
    loop = engine("InteractionLoop")
    known = list(loop.geomDispatcher.functors)
    others = [f for f in known if "Sphere_Sphere" not in type(f).__name__]
    loop.geomDispatcher.functors = others + [Ig2_Sphere_Sphere_L3Geom()]
    collision_starts = False
    for _ in range(200):
        try:
            O.step()
        except (RuntimeError, ValueError) as error:
            assert re.search("L3Geom", str(error)) and re.search("ScGeom", str(error)), str(error)
            collision_starts = True
            break
    assert collision_starts, "the spheres met without an error"
    loop = engine("InteractionLoop")
    loop.geomDispatcher.functors = known
    steps(120)
    # Ball on ball on floor, one after the other: e = 0 leaves no motion but the roundings of an unstable balance.
    assert abs(state(2).pos[2] - 1) < 1e-6 and abs(state(3).pos[2] - 3) < 1e-6


def error_is_raised_by_a_run_in_the_background() -> None:
    """O.run without waiting reports the error when it is waited for; the step can be repaired as well."""
    scene()
    O.step()
    state(BALL).vel = Vector3(NAN, 0, 0)
    try:
        O.run(5)
        O.wait()
    except RuntimeError as error:
        assert "vel" in str(error)
    else:
        raise AssertionError("no error was raised")
    state(BALL).vel = Vector3(0, 0, 0)
    goes_on()


def run_cases(protocol: str, *names: str) -> None:
    """Run the named cases; append one line each to the file `protocol`: name and traceback, empty if all went well."""
    for name in names:
        O.reset()
        try:
            globals()[name]()
            result = ""
        except (Exception, pytest.fail.Exception):  # the latter, of an error that did not come, is no Exception
            result = traceback.format_exc()
        with open(protocol, "a") as file:
            file.write(json.dumps([name, result]) + "\n")


def cases() -> list[str]:
    """Names of all cases of this module."""
    helpers = {"scene", "goes_on", "cases", "run_cases"}
    own = [n for n, f in globals().items() if callable(f) and getattr(f, "__module__", "") == __name__]
    return [n for n in own if not n.startswith("_") and n not in helpers]
