# SPDX-License-Identifier: GPL-2.0-or-later
"""The public classes as a YADE user meets them: attributes, defaults, documentation, keywords, labels, timing."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
import yade.timing
from yade import FrictPhys, MatchMaker, Matrix3, O, PyRunner, Vector3, wrapper

import contactdynamics
from contactdynamics import *  # noqa: F403  (that this works is part of the interface)
from scenes import active, cd, contact, contacts, engine, equip, floor, grain, material, state, steps, vec

CLASSES = sorted(contactdynamics._plugin.registerClasses())  # all that the plugin brings into YADE; called again it only says their names
FUNCTORS = [name for name in CLASSES if issubclass(getattr(wrapper, name), wrapper.Functor)]


def _pair(number: float) -> MatchMaker:
    return MatchMaker(matches=((0, 1, number),))


# Of each class that has any, all attributes of its own that can be written: the default, and another value that is admissible beside the others.
SETTINGS: dict[str, dict[str, tuple]] = {
    "ContactDynamicsEngine": {
        "tolerance": (1e-4, 3e-7),
        "maxIterations": (3000, 321),
        "contactLaw": ("quasiInelasticShock", "velocitySignorini"),
        "warmStart": (True, False),
        "onNonConvergence": ("warn", "raise"),
        "acceleration": ("default", "none"),
        "repairRate": (0.1, 0.05),
        "allowedOverlap": (1e-5, 2e-4),
    },
    "ContactDynamicsCellController": {
        "stress": (Matrix3.Zero, Matrix3(-3, 1, 0, 1, -4, 0, 0, 0, -5)),
        "velGrad": (Matrix3.Zero, Matrix3(0, 0.1, 0.2, 0.3, 0, 0.4, 0.5, 0.6, 0)),
        "stressMask": (7, 38),
        "inertia": (0, 2.5),
        "maxStrainRate": (math.inf, 0.7),
    },
    "ContactDynamicsTriaxialController": {
        "walls": ([], [5, 4, 3, 2, 1, 0]),
        "stress": (Vector3.Zero, Vector3(-1, -2, -3)),
        "strainRate": (Vector3.Zero, Vector3(0.1, -0.2, 0.3)),
        "stressMask": (7, 5),
        "wallMass": (0, 2.5),
        "maxStrainRate": (math.inf, 0.7),
        "referenceSize": (Vector3.Zero, Vector3(1, 2, 3)),
    },
    "ContactDynamicsTimeStepper": {
        "maxDisplacement": (0.25, 0.2),
        "maxRotation": (0.5, 0.3),
        "proximityDistance": (0, 0.02),
        "minTimeStep": (0, 1e-6),
        "maxTimeStep": (0, 2e-3),
        "growth": (1.2, 1.5),
    },
    "ContactDynamicsMat": {
        "normalRestitution": (0, 0.1),
        "tangentialRestitution": (0, 0.2),
        "restitutionVelocity": (0, 0.3),
        "staticFrictionAngle": (0, 0.4),
        "cohesionForce": (0, 0.5),
        "cohesionStress": (0, 0.6),
        "kn": (0, 7e8),
        "ks": (0, 8e7),
        "normalDamping": (0, 0.9),
        "rollingFriction": (0, 0.01),
        "twistingFriction": (0, 0.02),
    },
    "ContactDynamicsPhys": {
        "impulse": (Vector3.Zero, Vector3(1, 2, 3)),
        "normalRestitution": (0, 0.1),
        "tangentialRestitution": (0, 0.2),
        "restitutionVelocity": (0, 0.3),
        "staticFriction": (0, 0.4),
        "cohesionForce": (0, 0.5),
        "cohesionShear": (0, 0.6),
        "bond": ("none", "broken"),
        "normalDamping": (0, 0.9),
        "rollingArm": (0, 0.01),
        "twistingArm": (0, 0.02),
    },
    "Ip2_FrictMat_FrictMat_ContactDynamicsPhys": {"frictAngle": (None, _pair(0.25))},
    "Ip2_ContactDynamicsMat_ContactDynamicsMat_ContactDynamicsPhys": {
        "frictAngle": (None, _pair(0.25)),
        "staticFrictAngle": (None, _pair(0.35)),
        "normalRestitution": (None, _pair(0.1)),
        "tangentialRestitution": (None, _pair(0.2)),
        "restitutionVelocity": (None, _pair(0.3)),
        "cohesionForce": (None, _pair(0.5)),
        "cohesionStress": (None, _pair(0.6)),
        "kn": (None, _pair(7e8)),
        "ks": (None, _pair(8e7)),
        "normalDamping": (None, _pair(0.9)),
        "rollingFriction": (None, _pair(0.01)),
        "twistingFriction": (None, _pair(0.02)),
        "bonding": (True, False),
    },
}
OTHERS = {name: {attribute: other for attribute, (_, other) in settings.items()} for name, settings in SETTINGS.items()}
OF_CONTACT = ["normalForce", "shearForce", "tangensOfFrictionAngle", "impulse", "status", "gap", "localVelocity"]


def class_of(name: str) -> type:
    return getattr(wrapper, name)


def own_attributes(name: str) -> dict[str, property]:
    """Those that the class does not share with the one it is derived from."""
    cls = class_of(name)
    inherited = {n for base in cls.__mro__[1:] for n in vars(base)}
    return {n: v for n, v in vars(cls).items() if isinstance(v, property) and n not in inherited}


def text_of(documented) -> str:
    """What is written about it, without the default, type and flags that YADE adds to every attribute by itself."""
    return re.sub(r":y(default|attrtype|attrflags):`[^`]*`", "", documented.__doc__ or "").strip()


@pytest.mark.parametrize("name", CLASSES)
def test_class_is_documented(name: str) -> None:
    """Every class and every attribute of its own says what it is; numbers say their unit."""
    assert len(text_of(class_of(name))) > 40
    for attribute, documented in own_attributes(name).items():
        assert len(text_of(documented)) > 10, f"{name}.{attribute} has no documentation"  # more than a unit


def test_every_setting_is_looked_at() -> None:
    """An attribute that can be written and is not in the table would be in no test of defaults and of saving."""
    writable = {name: {n for n, v in own_attributes(name).items() if v.fset} for name in CLASSES}
    assert writable == {name: set(SETTINGS.get(name, ())) for name in CLASSES}


@pytest.mark.parametrize("name", SETTINGS)
def test_settings_have_the_default_that_their_text_says(name: str) -> None:
    made, attributes = class_of(name)(), own_attributes(name)
    for attribute, (default, other) in SETTINGS[name].items():
        assert getattr(made, attribute) == default != other
        text = text_of(attributes[attribute])
        for before, after in re.findall(r"[Dd]efault:? ([\d.e+-]*\d)|([\d.e+-]*\d) \(default\)", text):
            said = float(before or after)
            assert default in (said, Vector3(said, said, said)), text
        if name == "ContactDynamicsEngine":
            assert "default" in text.lower()


@pytest.mark.parametrize(
    "cls, name, unit",
    [
        ("ContactDynamicsEngine", "maxPenetration", "m"),
        ("ContactDynamicsEngine", "meanPenetration", "m"),
        ("ContactDynamicsPhys", "impulse", "N s"),
        ("ContactDynamicsPhys", "gap", "m"),
        ("ContactDynamicsPhys", "localVelocity", "m/s"),
    ],
)
def test_quantities_say_their_unit(cls: str, name: str, unit: str) -> None:
    text = getattr(class_of(cls), name).__doc__
    assert any(form in text for form in (f"[{unit}]", f"({unit})", f" {unit}", f"{unit.replace(' ', '·')}")), text


@pytest.mark.parametrize("name", SETTINGS)
def test_settings_are_read_back_and_constructor_takes_keywords(name: str) -> None:
    made = class_of(name)(**OTHERS[name])
    assert {n: getattr(made, n) for n in OTHERS[name]} == OTHERS[name]
    told = made.dict()
    assert {n: told[n] for n in OTHERS[name]} == OTHERS[name]


@pytest.mark.parametrize("name", CLASSES)
def test_unknown_keyword_is_refused(name: str) -> None:
    with pytest.raises(AttributeError, match="noSuchAttribute"):
        class_of(name)(noSuchAttribute=1)


def test_engine_takes_a_label() -> None:
    assert ContactDynamicsEngine(label="name").label == "name"


@pytest.mark.parametrize("name", CLASSES)
def test_results_cannot_be_written(name: str) -> None:
    made = class_of(name)()
    for attribute in own_attributes(name).keys() - SETTINGS.get(name, {}).keys():
        with pytest.raises(AttributeError):
            setattr(made, attribute, getattr(made, attribute))


def test_contact_class_is_a_friction_contact_of_yade() -> None:
    """YADE's readers of forces find what they know."""
    made = ContactDynamicsPhys()
    assert isinstance(made, FrictPhys)
    for name in OF_CONTACT:
        getattr(made, name)
    assert made.status == "none" and vec(made.impulse) == pytest.approx([0, 0, 0], abs=0)


def test_list_of_engines() -> None:
    """The list is complete, in order, and passes its arguments on."""
    given = dict(tolerance=1e-6, maxIterations=5, contactLaw="signorini", warmStart=False)
    made = contactdynamics.engines(gravity=(1, 2, -3), **given)
    names = [type(e).__name__ for e in made]
    first = ["ForceResetter", "InsertionSortCollider", "InteractionLoop"]
    order = first + ["ContactDynamicsEngine", "NewtonIntegrator"]
    assert [n for n in names if n in order] == order
    solver, newton = made[names.index("ContactDynamicsEngine")], made[names.index("NewtonIntegrator")]
    assert {name: getattr(solver, name) for name in given} == given
    assert solver.label == "cd"
    assert newton.damping == 0 and vec(newton.gravity) == pytest.approx([1, 2, -3], abs=0)
    plain = contactdynamics.engines()
    assert vec(plain[names.index("NewtonIntegrator")].gravity) == pytest.approx([0, 0, -9.81], abs=0)


def test_label_is_a_name_in_scripts() -> None:
    """`cd` is usable as in YADE: as a bare name in commands and through O.labeledEngine."""
    material()
    floor()
    grain((0, 0, 1))
    equip(1e-3)
    O.engines = O.engines + [PyRunner(command="O.tags['seen'] = str(cd.contacts)", iterPeriod=1, initRun=True)]
    O.step()
    assert O.tags["seen"] == "1"
    assert O.labeledEngine("cd").contacts == cd().contacts == 1


def test_results_of_a_step() -> None:
    """One ball at rest on the floor, one in the air."""
    material()
    floor()
    grain((0, 0, 0.999))
    grain((5, 0, 10))
    equip(1e-3)
    O.step()
    solver = cd()
    assert solver.contacts == 1 and solver.activeContacts == 1
    assert solver.converged is True and 0 <= solver.residual <= solver.tolerance
    assert 0 <= solver.iterations <= solver.maxIterations
    # Subtraction of lengths near 1 m: a few roundings of 1.1e-16.
    assert solver.maxPenetration == pytest.approx(1e-3, abs=1e-14)
    assert solver.meanPenetration == pytest.approx(1e-3, abs=1e-14)


def test_scene_without_contacts() -> None:
    grain((0, 0, 0))
    equip(1e-3)
    O.step()
    assert (cd().contacts, cd().activeContacts, cd().maxPenetration, cd().meanPenetration) == (0, 0, 0, 0)
    assert cd().converged is True


def test_empty_scene() -> None:
    equip(1e-3)
    steps(3)
    assert cd().contacts == 0 and cd().freeVelocities() == []


def test_force_is_impulse_over_step_on_body_two() -> None:
    """The parts of the force in YADE's terms, and what O.forces holds after the step."""
    material(friction=0.3)
    floor()
    ball = grain((0, 0, 1), velocity=(3, 1, 0))
    equip(1e-3)
    O.step()
    i = contact(0, ball)
    assert i.id2 == ball, "sphere is body 2 of a contact with a box"
    n = vec(i.geom.normal)
    force = vec(i.phys.impulse) / O.dt
    size = np.linalg.norm(force)
    assert np.allclose(vec(i.phys.normalForce), (force @ n) * n, rtol=0, atol=1e-14 * size)
    assert np.allclose(vec(i.phys.normalForce) + vec(i.phys.shearForce), force, rtol=0, atol=1e-14 * size)
    assert np.allclose(vec(O.forces.f(ball)), force, rtol=0, atol=1e-14 * size)
    assert np.allclose(vec(O.forces.f(0)), -force, rtol=0, atol=1e-14 * size)
    arm = vec(i.geom.contactPoint) - np.array([0, 0, 1.0])
    assert np.allclose(vec(O.forces.t(ball)), np.cross(arm, force), rtol=0, atol=1e-14 * size)
    assert i.phys.status == "sliding"


def test_status_gap_and_local_velocity() -> None:
    """Sticking, sliding and open contacts on one floor."""
    material(friction=0.5)
    floor()
    still, fast = grain((0, 0, 1)), grain((5, 0, 1), velocity=(2, 0, 0))
    high = grain((10, 0, 1.004), velocity=(0, 0, -5))
    free = grain((15, 0, 1.004), velocity=(0, 0, -1))
    equip(1e-3, tolerance=1e-12)
    O.step()
    assert contact(0, still).phys.status == "sticking"
    assert contact(0, fast).phys.status == "sliding"
    assert contact(0, free) is None or contact(0, free).phys.status == "none"
    # The contact with a gap g closes it within the step and no more: U_N = -g/h, equation (25).
    u = vec(contact(0, high).phys.localVelocity)
    assert contact(0, high).phys.gap == pytest.approx(4e-3, abs=1e-14)
    assert u[0] == pytest.approx(-4, rel=1e-10)
    # Sliding: the impulse takes 3.5 mu g h from the speed of the contact point, whose mass is 2/7 of the ball's.
    u = vec(contact(0, fast).phys.localVelocity)
    assert abs(u[0]) <= 1e-13
    assert np.linalg.norm(u[1:]) == pytest.approx(2 - 3.5 * 0.5 * 9.81e-3, rel=1e-12)


@pytest.mark.parametrize("ways", ["min", "matched", "number", "fallback"])
def test_friction_angle_of_a_pair(ways: str) -> None:
    """The smaller angle unless a MatchMaker says otherwise, as in YADE's own functors."""
    rough, smooth = material(friction=0.7), material(friction=0.2)
    floor(material=rough)
    ball = grain((0, 0, 1), material=smooth)
    equip(1e-3)
    functor = engine("InteractionLoop").physDispatcher.functors[0]
    expected = 0.2
    if ways == "matched":
        functor.frictAngle = MatchMaker(matches=((rough.id, smooth.id, math.atan(0.9)),))
        expected = 0.9
    elif ways == "number":
        functor.frictAngle = math.atan(0.33)
        expected = 0.33
    elif ways == "fallback":
        functor.frictAngle = MatchMaker(algo="max")
        expected = 0.7
    O.step()
    assert contact(0, ball).phys.tangensOfFrictionAngle == pytest.approx(expected, rel=1e-14)


def test_friction_acts_with_the_coefficient_of_the_pair() -> None:
    """The force follows the coefficient of the contact, also when a script changes it."""
    material(friction=0.4)
    floor()
    ball = grain((0, 0, 1), velocity=(5, 0, 0))
    state(ball).blockedDOFs = "XYZ"
    equip(1e-3, tolerance=1e-12)
    for friction in (0.4, 0.1, 0.0):
        if contact(0, ball):
            contact(0, ball).phys.tangensOfFrictionAngle = friction
        O.step()
        i = contact(0, ball)
        assert i.phys.shearForce.norm() == pytest.approx(friction * i.phys.normalForce.norm(), rel=1e-13, abs=1e-12)


def test_time_is_booked_for_each_part(capsys) -> None:
    material()
    floor()
    grain((0, 0, 1))
    equip(1e-3)
    O.timingEnabled = True
    yade.timing.reset()
    steps(20)
    booked = {label: (time, count) for label, time, count in cd().timingDeltas.data}
    assert list(booked) == ["collect", "solve", "apply", "repair"]
    assert all(count == 20 and time > 0 for time, count in booked.values())
    yade.timing.stats()
    shown = capsys.readouterr().out
    assert all(part in shown for part in ("collect", "solve", "apply"))


def test_no_time_is_booked_when_timing_is_off() -> None:
    equip(1e-3)
    steps(3)
    assert all(count == 0 for _, _, count in cd().timingDeltas.data)


def test_contacts_end_when_bodies_part() -> None:
    """The law drops contacts beyond reach; nothing accumulates."""
    material()
    floor()
    ball = grain((0, 0, 1))
    equip(1e-3)
    O.step()
    assert contact(0, ball) is not None
    state(ball).vel = state(ball).vel + type(state(ball).vel)(0, 0, 50)
    steps(100)
    assert contacts() == [] and cd().contacts == 0


def test_list_written_out_with_stock_functors() -> None:
    """The five-line change of a script with YADE's own collision functors works as well."""
    from yade import (
        Bo1_Box_Aabb,
        Bo1_Sphere_Aabb,
        ForceResetter,
        Ig2_Box_Sphere_ScGeom,
        Ig2_Sphere_Sphere_ScGeom,
        InsertionSortCollider,
        InteractionLoop,
        NewtonIntegrator,
    )

    material()
    floor()
    for k in range(4):
        grain((0, 0, 1.01 + 2.01 * k))
    O.dt = 1e-3
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb(aabbEnlargeFactor=1.05), Bo1_Box_Aabb()]),
        InteractionLoop(
            [
                Ig2_Sphere_Sphere_ScGeom(interactionDetectionFactor=1.05),
                Ig2_Box_Sphere_ScGeom(interactionDetectionFactor=1.05),
            ],
            [Ip2_FrictMat_FrictMat_ContactDynamicsPhys()],
            [Law2_ScGeom_ContactDynamicsPhys_SignoriniCoulomb()],
        ),
        ContactDynamicsEngine(tolerance=1e-10, maxIterations=10000, label="cd"),
        NewtonIntegrator(damping=0, gravity=(0, 0, -9.81)),
    ]
    steps(300)
    weight = state(1).mass * 9.81
    assert len(active()) == 4
    assert vec(O.forces.f(0))[2] == pytest.approx(-4 * weight, rel=1e-8)


def test_warm_start_saves_iterations_and_changes_nothing_else() -> None:
    """A column at rest: the impulses of the last step are the solution of this one."""
    needed, forces = {}, {}
    for warm in (True, False):
        O.reset()
        material()
        floor()
        for k in range(8):
            grain((0, 0, 1 + 2 * k))
        equip(1e-3, tolerance=1e-8, maxIterations=100000, warmStart=warm)
        steps(5)
        needed[warm], forces[warm] = cd().iterations, vec(O.forces.f(0))[2]
    assert needed[True] <= 2 < needed[False]
    assert forces[True] == pytest.approx(forces[False], rel=1e-6)
