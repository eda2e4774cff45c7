# SPDX-License-Identifier: GPL-2.0-or-later
"""Mistakes in O.engines are named at the first step, and the corrected list works."""

from __future__ import annotations

import re

import pytest
from yade import (
    ForceEngine,
    GlobalStiffnessTimeStepper,
    GravityEngine,
    InsertionSortCollider,
    InteractionLoop,
    Law2_ScGeom_FrictPhys_CundallStrack,
    NewtonIntegrator,
    O,
    PyRunner,
    ServoPIDController,
    TranslationEngine,
    utils,
)

import contactdynamics
from contactdynamics import ContactDynamicsEngine
from refusal import refused
from scenes import contact, engine, equip, floor, grain, material, state, steps, vec

H = 1e-3


def scene() -> list:
    """Ball on a floor; returns the correct list of engines."""
    material()
    floor()
    grain((0, 0, 1))
    equip(H)
    return list(O.engines)


def without(engines: list, class_name: str) -> list:
    return [e for e in engines if type(e).__name__ != class_name]


def works() -> None:
    """The ball lies still, at most one step of free fall below the start: an integrator may stand before the error."""
    steps(20)
    assert abs(state(1).pos[2] - 1) < 1.01 * 9.81 * H**2
    assert state(1).vel.norm() < 1e-10
    assert vec(O.forces.f(1))[2] == pytest.approx(state(1).mass * 9.81, rel=1e-9)


@pytest.mark.parametrize("damping", [0.2, -0.1, float("nan")])
def test_damping(damping: float) -> None:
    scene()
    engine("NewtonIntegrator").damping = damping
    refused("damping", "NewtonIntegrator", "nan" if damping != damping else re.escape(f"{damping:g}"))
    engine("NewtonIntegrator").damping = 0
    works()


NEEDED = [("NewtonIntegrator", "live|dead"), ("InsertionSortCollider", "collider"), ("ForceResetter", "ForceResetter")]


@pytest.mark.parametrize("class_name, word", NEEDED)
def test_missing(class_name: str, word: str) -> None:
    right = scene()
    O.engines = without(right, class_name)
    refused(class_name, word)
    O.engines = right
    works()


@pytest.mark.parametrize("class_name, word", NEEDED)
def test_dead(class_name: str, word: str) -> None:
    scene()
    engine(class_name).dead = True
    refused(class_name, word)
    engine(class_name).dead = False
    works()


def test_integrator_before_the_engine() -> None:
    right = scene()
    O.engines = without(right, "NewtonIntegrator")[:-1] + [engine("NewtonIntegrator"), engine("ContactDynamicsEngine")]
    refused("NewtonIntegrator", "behind|after", before_motion=False)
    O.engines = right
    works()


def test_two_integrators() -> None:
    right = scene()
    O.engines = right + [NewtonIntegrator(damping=0)]
    refused("NewtonIntegrator", "two|2|one")
    O.engines = right
    works()


def test_one_integrator_before_and_one_after() -> None:
    right = scene()
    O.engines = [right[0], NewtonIntegrator(damping=0)] + right[1:]
    refused("NewtonIntegrator")
    O.engines = right
    works()


def test_dead_integrator_beside_a_living_one() -> None:
    """A dead engine does nothing, so it is no second integrator."""
    right = scene()
    O.engines = right + [NewtonIntegrator(damping=0, dead=True)]
    works()


def test_interactions_made_by_hand_need_no_collider() -> None:
    right = scene()
    O.engines = without(right, "InsertionSortCollider")
    utils.createInteraction(0, 1)
    works()


def test_force_resetter_after_the_engine() -> None:
    """Contact forces would be wiped before the integrator sees them."""
    right = scene()
    resetter = engine("ForceResetter")
    O.engines = right[1:-1] + [resetter, right[-1]]
    refused("ForceResetter")
    O.engines = right
    works()


def test_engine_before_the_interaction_loop() -> None:
    """Contacts of the last step would be solved: the order is refused."""
    right = scene()
    loop, solver = engine("InteractionLoop"), engine("ContactDynamicsEngine")
    rest = [e for e in right if type(e).__name__ not in ("InteractionLoop", "ContactDynamicsEngine")]
    O.engines = rest[:-1] + [solver, loop, rest[-1]]
    refused("InteractionLoop")
    O.engines = right
    works()


@pytest.mark.parametrize("before", ["ContactDynamicsEngine", "NewtonIntegrator"])
def test_collider_behind_the_loop(before: str) -> None:
    """The pairs it finds would be solved a step late: at 20 m/s a ball went through the floor. Behind the integrator it is in time for the next step."""
    right = scene()
    collider = engine("InsertionSortCollider")
    rest = [e for e in right if e is not collider]
    place = rest.index(engine(before))
    O.engines = rest[:place] + [collider] + rest[place:]
    refused("InsertionSortCollider", "before InteractionLoop")
    O.engines = [*rest, collider]
    works()
    loop = InteractionLoop([], [], [])  # another one, in front
    O.engines = [right[0], loop, *right[1:]]
    works()


def test_two_contact_dynamics_engines() -> None:
    """Each would add the whole reaction."""
    right = scene()
    O.engines = right[:-1] + [ContactDynamicsEngine(), right[-1]]
    refused("ContactDynamicsEngine")
    O.engines = right
    works()


def test_the_same_engine_twice() -> None:
    """The second solve would find nothing left to do and overwrite the impulses with zero."""
    right = scene()
    O.engines = right[:-1] + [engine("ContactDynamicsEngine"), right[-1]]
    refused("twice")
    O.engines = right
    works()


def test_loop_with_soft_laws_only() -> None:
    """The line of the soft law was not changed: contacts would be dropped before they close."""
    scene()
    laws = engine("InteractionLoop").lawDispatcher
    right = laws.functors
    laws.functors = [Law2_ScGeom_FrictPhys_CundallStrack()]
    refused("Law2_ScGeom_ContactDynamicsPhys_SignoriniCoulomb")
    laws.functors = right
    works()


@pytest.mark.parametrize("number", [float("nan"), float("inf")])
def test_gravity_that_is_not_finite(number: float) -> None:
    scene()
    engine("NewtonIntegrator").gravity = (0, 0, number)
    refused("NewtonIntegrator.gravity", str(number))
    engine("NewtonIntegrator").gravity = (0, 0, -9.81)
    works()


def test_global_stiffness_time_stepper() -> None:
    """YADE's default engine list has one; without stiffness it would set the step to nonsense."""
    right = scene()
    O.engines = right[:-1] + [GlobalStiffnessTimeStepper(), right[-1]]
    refused("GlobalStiffnessTimeStepper")
    O.dt = H
    O.engines = right
    works()


def test_other_engines_are_welcome() -> None:
    """In front of the engine and behind the integrator, as scripts have them."""
    right = scene()
    nothing = [PyRunner(command="pass", iterPeriod=1) for _ in range(2)]
    O.engines = right[:1] + nothing[:1] + right[1:] + nothing[1:]
    works()


def test_dead_engine_applies_nothing() -> None:
    """With the engine dead the ball falls through the floor, as any YADE engine that is switched off."""
    scene()
    engine("ContactDynamicsEngine").dead = True
    steps(5)
    assert state(1).vel[2] == pytest.approx(-5 * 9.81 * H, rel=1e-12)


def told(capfd) -> int:
    return capfd.readouterr().err.count("no ContactDynamicsEngine in O.engines")


def test_missing_engine_is_told_once(capfd) -> None:
    """A functor must not throw, so what nobody solves is said on standard error; a dead engine is the user's will."""
    right = scene()
    engine("ContactDynamicsEngine").dead = True
    steps(3)
    assert told(capfd) == 0
    engine("ContactDynamicsEngine").dead = False
    for _ in range(2):
        O.engines = without(right, "ContactDynamicsEngine")
        steps(3)
        assert told(capfd) == 1
        O.engines = right
        steps(1)
        assert told(capfd) == 0


def test_missing_engine_is_told_in_every_scene(capfd) -> None:
    """After O.reset() again, and of two scenes that step in turn by the one that lacks the engine, and once."""
    for _ in range(2):
        O.reset()
        O.engines = without(scene(), "ContactDynamicsEngine")
        steps(2)
        assert told(capfd) == 1
    O.reset()
    scene()
    wrong = O.addScene()
    O.switchToScene(wrong)
    O.engines = without(scene(), "ContactDynamicsEngine")
    for _ in range(3):
        O.switchToScene(0)
        steps(1)
        O.switchToScene(wrong)
        steps(1)
    O.switchToScene(0)
    assert told(capfd) == 1


def test_mistake_made_in_mid_run_is_found() -> None:
    scene()
    steps(10)
    engine("NewtonIntegrator").damping = 0.3
    refused("damping")
    engine("NewtonIntegrator").damping = 0
    works()
    assert contact(0, 1) is not None


@pytest.mark.parametrize("make", [TranslationEngine, ForceEngine, GravityEngine, ServoPIDController])
def test_forces_and_velocities_after_the_solve(make) -> None:
    """What is added between the engine and the integrator would not be in the contact problem: the order is refused."""
    right = scene()
    late = make() if make is GravityEngine else make(ids=[0])
    O.engines = right[:-1] + [late, right[-1]]
    refused(make.__name__, "NewtonIntegrator", "before|behind")
    late.dead = True
    works()
    O.engines = right
    works()


def test_servo_without_forces() -> None:
    """Between ForceResetter and the engine a controller would see no contact forces and run at full speed for ever."""
    right = scene()
    servo = ServoPIDController(ids=[0], axis=(0, 0, 1), target=1)
    O.engines = right[:3] + [servo] + right[3:]
    # Where another engine has not done so already, YADE finds the forces not synchronised and says that instead.
    with pytest.raises(RuntimeError, match="ServoPIDController|sync"):
        O.step()
    O.engines = right
    works()


def test_law_behind_the_engine_only() -> None:
    """An InteractionLoop stands before it, but the one that knows our contacts comes too late."""
    right = scene()
    O.engines = right[:2] + [InteractionLoop([], [], [])] + right[3:] + [right[2]]
    refused("no InteractionLoop before this engine", "Law2_ScGeom_ContactDynamicsPhys_SignoriniCoulomb")
    O.engines = right
    O.interactions.clear()  # YADE remembers for each pair that the empty loop had no functor for it
    works()


def test_servo_without_forces_in_a_combined_motion() -> None:
    right = scene()
    servo = TranslationEngine(ids=[0], translationAxis=(1, 0, 0), velocity=0) + ServoPIDController(axis=(0, 0, 1), target=1)
    O.engines = right[:1] + [servo] + right[1:]  # further behind YADE finds the forces not synchronised and says that instead
    refused("ServoPIDController", "CombinedKinematicEngine", "behind NewtonIntegrator")
    O.engines = right[:3] + [TranslationEngine(ids=[0], translationAxis=(1, 0, 0), velocity=0) + TranslationEngine(translationAxis=(0, 1, 0), velocity=0)] + right[3:]
    works()


def test_global_stiffness_time_stepper_that_is_switched_off() -> None:
    right = scene()
    O.engines = right[:-1] + [GlobalStiffnessTimeStepper(active=False), right[-1]]
    works()
    assert O.dt == H


def test_engines_refuses_what_no_engine_has() -> None:
    with pytest.raises(ValueError, match="gravity = -9.81: .*three"):
        contactdynamics.engines(gravity=-9.81)
    with pytest.raises(AttributeError, match="ContactDynamicsEngine has no attribute 'damping'"):
        contactdynamics.engines(damping=0.2)


def test_collider_of_ones_own() -> None:
    right = scene()
    collider = InsertionSortCollider([], allowBiggerThanPeriod=True, avoidSelfInteractionMask=8)
    O.engines = contactdynamics.engines(collider=collider)
    assert O.engines[1].allowBiggerThanPeriod and O.engines[1].avoidSelfInteractionMask == 8 and O.engines[1].verletDist == 0
    assert [type(f) for f in O.engines[1].boundDispatcher.functors] == [type(f) for f in right[1].boundDispatcher.functors]
    works()
