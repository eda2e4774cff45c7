# SPDX-License-Identifier: GPL-2.0-or-later
"""ContactDynamicsMat in YADE: bad values, rules of pairs, saving, threads, and soft laws beside."""

from __future__ import annotations

import math

import pytest
from yade import MatchMaker, O, Vector3

import laws_cases
from blocks import block
from contactdynamics import ContactDynamicsMat
from refusal import refused
from scenes import G, cd, contact, engine, equip, floor, grain, isolated, law, state, steps, vec

COEFFICIENTS = ["normalRestitution", "tangentialRestitution"]
OTHERS = ["restitutionVelocity", "cohesionForce", "cohesionStress", "kn", "ks", "normalDamping", "rollingFriction"]
OTHERS += ["twistingFriction", "staticFrictionAngle"]


@pytest.mark.parametrize("name", COEFFICIENTS + OTHERS)
def test_bad_values_of_the_material(name: str) -> None:
    """Refused at once, and the last good value stays."""
    made = ContactDynamicsMat()
    assert getattr(made, name) == 0
    setattr(made, name, 0.25)
    bad = [-0.1, float("nan"), float("inf")] + ([1.01] if name in COEFFICIENTS else [])
    for value in bad + ([math.pi / 2] if name == "staticFrictionAngle" else []):
        with pytest.raises(ValueError, match=f"ContactDynamicsMat.{name} = .*must"):
            setattr(made, name, value)
        assert getattr(made, name) == 0.25
        with pytest.raises(ValueError, match=name):
            ContactDynamicsMat(**{name: value})


@pytest.mark.parametrize(
    "attributes, words",
    [
        (dict(cohesionStress=10, frictionAngle=0), "cohesionStress.*frictionAngle"),
        (dict(kn=1e6, normalRestitution=0.5), "normalRestitution.*kn"),
        (dict(ks=1e6, tangentialRestitution=0.5), "tangentialRestitution.*ks"),
    ],
)
def test_contradictions_of_a_pair_name_the_contact(attributes: dict, words: str) -> None:
    law(**attributes)
    floor()
    grain((0, 0, 1))
    equip(1e-3)
    with pytest.raises(RuntimeError, match=f"#0\\+#1.*{words}"):
        O.step()


OF_A_CONTACT = ["normalRestitution", "tangentialRestitution", "restitutionVelocity", "staticFriction", "cohesionForce", "cohesionShear", "kn"]
OF_A_CONTACT += ["ks", "normalDamping", "rollingArm", "twistingArm", "tangensOfFrictionAngle"]


@pytest.mark.parametrize("name, value", [(name, value) for name in OF_A_CONTACT for value in (-1.0, math.nan, math.inf)] + [("bond", "glued")])
def test_bad_values_of_a_contact(name: str, value: object) -> None:
    law(normalRestitution=0.5)
    floor()
    grain((0, 0, 1))
    equip(1e-3)
    O.step()
    setattr(contact(0, 1).phys, name, value)
    with pytest.raises(RuntimeError, match=f"#0\\+#1.*{name}"):
        O.step()


PAIR_RULES = COEFFICIENTS + OTHERS + ["frictionAngle"]
# What an attribute of the materials is called in the rules of pairs and in the contact, and what the contact makes of it (unit ball on a box).
RULE = {"frictionAngle": "frictAngle", "staticFrictionAngle": "staticFrictAngle"}
IN_CONTACT = {
    "frictionAngle": ("tangensOfFrictionAngle", math.tan),
    "staticFrictionAngle": ("staticFriction", math.tan),
    "cohesionStress": ("cohesionShear", lambda c: c * math.pi),
    "rollingFriction": ("rollingArm", lambda mu: mu),
    "twistingFriction": ("twistingArm", lambda mu: mu),
}


@pytest.mark.parametrize("name", PAIR_RULES)
def test_rules_of_pairs(name: str) -> None:
    """Default rule, and a MatchMaker of one's own."""
    mortar = {"kn": 1e6} if name == "normalDamping" else {}
    more = {**mortar, **({"frictionAngle": 0.1} if name == "staticFrictionAngle" else {})}
    one, two = law(**{name: 0.2, **more}), law(**{name: 0.6, **more})
    rule = {"restitutionVelocity": 0.6, "kn": 0.15, "ks": 0.15, "normalDamping": 0.15}.get(name, 0.2)
    for matched in (False, True):
        O.interactions.clear()
        O.bodies.clear()
        floor(material=one)
        grain((0, 0, 1), material=two)
        equip(1e-3)
        if matched:
            functor = engine("InteractionLoop").physDispatcher.functors[1]
            setattr(functor, RULE.get(name, name), MatchMaker(matches=((one.id, two.id, 0.77),)))
        O.step()
        attribute, made = IN_CONTACT.get(name, (name, lambda value: value))
        assert getattr(contact(0, 1).phys, attribute) == pytest.approx(made(0.77 if matched else rule))


@pytest.mark.parametrize("name", PAIR_RULES)
def test_bad_values_of_a_rule_name_the_contact(name: str) -> None:
    """Good materials, but a MatchMaker that gives the pair what none of them may have; a good one mends it."""
    mortar = {"kn": 1e6} if name == "normalDamping" else {}
    made = law(**{name: 0.2, **mortar})
    floor(material=made)
    grain((0, 0, 1), material=made)
    equip(1e-3)
    functor = engine("InteractionLoop").physDispatcher.functors[1]
    setattr(functor, RULE.get(name, name), MatchMaker(matches=((made.id, made.id, -0.5),)))
    with pytest.raises(RuntimeError, match="#0\\+#1"):
        O.step()
    setattr(functor, RULE.get(name, name), MatchMaker(matches=((made.id, made.id, 0.3),)))
    steps(2)
    assert contact(0, 1) is not None


@pytest.mark.parametrize("kind", sorted(laws_cases.LAWS))
def test_same_bits_with_two_threads_and_across_a_file(kind: str, tmp_path) -> None:
    isolated("yade", "laws_cases", "straight", kind, tmp_path / "one")
    expected = (tmp_path / "one").read_text()
    isolated("yade", "laws_cases", "straight", kind, tmp_path / "two", threads=2)
    assert (tmp_path / "two").read_text() == expected
    isolated("yade", "laws_cases", "halves", kind, tmp_path / "half.yade.gz", tmp_path / "three")
    assert (tmp_path / "three").read_text() == expected


def test_warm_start_and_bond_survive_a_change_of_the_step() -> None:
    law(cohesionForce=1000)
    one, two = grain((0, 0, 0), fixed=True), grain((0, 0, 2))
    equip(1e-3, gravity=(0, 0, 0), tolerance=1e-12)
    O.forces.setPermF(two, Vector3(0, 0, 900))
    steps(3)
    O.dt = 3e-4
    steps(3)
    assert contact(one, two).phys.bond == "intact"
    assert vec(contact(one, two).phys.normalForce)[2] == pytest.approx(-900, rel=1e-9)


def test_capillary_law_beside() -> None:
    """YADE's own capillary bridge between two soft grains; a rigid grain rests beside them, and bits agree without it."""
    from yade import Ip2_ViscElCapMat_ViscElCapMat_ViscElCapPhys, Law2_ScGeom_ViscElCapPhys_Basic, ViscElCapMat

    tracks = []
    for rigid in (True, False):
        O.reset()
        wet = ViscElCapMat(kn=1e6, ks=1e6, cn=1e3, cs=1e3, frictionAngle=0.3, density=2600, Capillar=True)
        wet.Vb, wet.gamma, wet.theta, wet.CapillarType = 1e-3, 50.0, 0.0, "Willett_numeric"
        number = O.materials.append(wet)
        grain((0, 0, 10), fixed=True, material=O.materials[number])
        hung = grain((0, 0, 8.001), material=O.materials[number])
        if rigid:
            plate = floor(material=law(normalRestitution=0.5))
            ball = grain((5, 0, 1))
            ball_material = O.bodies[plate].material
            O.bodies[ball].material = ball_material
        equip(1e-4, gravity=(0, 0, 0))
        loop = engine("InteractionLoop")
        loop.physDispatcher.functors = loop.physDispatcher.functors + [Ip2_ViscElCapMat_ViscElCapMat_ViscElCapPhys()]
        loop.lawDispatcher.functors = loop.lawDispatcher.functors + [Law2_ScGeom_ViscElCapPhys_Basic()]
        steps(100)
        kinds = {type(i.phys).__name__ for i in O.interactions if i.isReal}
        assert "ViscElCapPhys" in kinds and ("ContactDynamicsPhys" in kinds) == rigid
        tracks.append(tuple(state(hung).vel) + tuple(state(hung).pos))
    assert tracks[0] == tracks[1]


def test_shear_strength_needs_friction_while_sliding() -> None:
    """Static friction alone is not enough: a contact that slides has none, and the strength c A would be divided by it."""
    law(cohesionForce=1, frictionAngle=0.5)
    plate = floor()
    ball = grain((0, 0, 1))
    equip(1e-3)
    O.step()
    phys = contact(plate, ball).phys
    phys.tangensOfFrictionAngle, phys.staticFriction, phys.cohesionShear = 0, 0.5, 10
    refused("tangensOfFrictionAngle is 0", "cohesionShear")
    phys.tangensOfFrictionAngle = 0.5
    O.step()


def test_arms_set_to_zero_take_the_torque_along() -> None:
    law(rollingFriction=0.1)
    floor()
    ball = grain((0, 0, 1), velocity=(1, 0, 0), spin=(0, 1, 0))
    equip(1e-3)
    steps(3)
    assert contact(0, ball).phys.torqueImpulse.norm() > 0
    contact(0, ball).phys.rollingArm = 0
    steps(1)
    assert contact(0, ball).phys.torqueImpulse == Vector3(0, 0, 0)


def test_laws_that_refer_to_a_radius_and_pairs_without() -> None:
    """Blocks do not roll, so rolling friction of their material has no effect; a cohesion that cannot act is told, with what to do."""
    law(rollingFriction=0.1, twistingFriction=0.1)
    ground = floor()
    cube = block((0, 0, 0.5))
    ball = grain((3, 0, 1))
    equip(1e-3)
    steps(3)
    assert contact(ground, ball).phys.rollingArm == 0.1 and contact(ground, cube).phys.rollingArm == 0
    assert cd().activeContacts == 5
    O.materials[0].cohesionStress = 10
    O.bodies.erase(cube)
    other = block((0, 0, 0.5))
    refused(rf"#{ground}\+#{other}", "cohesionStress of the pair is 10", "cohesionForce")
