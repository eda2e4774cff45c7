# SPDX-License-Identifier: GPL-2.0-or-later
"""Short words for building, running and measuring the scenes of the tests."""

from __future__ import annotations

import math
import os
import subprocess
from pathlib import Path
from typing import Callable, Iterable, Sequence

import numpy as np
from yade import FrictMat, O, Quaternion, Vector3, utils

import contactdynamics

G = 9.81
EPS = float(np.finfo(float).eps)
TESTS = Path(__file__).resolve().parent
Triple = Sequence[float]


# --- building -----------------------------------------------------------------------------------------------------


def material(friction: float = 0.5, density: float = 2600.0) -> FrictMat:
    """A new material of the scene with Coulomb coefficient `friction` and `density` in kg/m3."""
    number = O.materials.append(FrictMat(young=1e7, poisson=0.3, frictionAngle=math.atan(friction), density=density))
    return O.materials[number]


def grain(position: Triple, radius: float = 1.0, velocity: Triple = (0, 0, 0), spin: Triple = (0, 0, 0), **more) -> int:
    """Append a sphere and return its id. `more` goes to `utils.sphere` (material, fixed, mask, ...)."""
    more.setdefault("material", O.materials[0] if len(O.materials) else material())
    number = O.bodies.append(utils.sphere(Vector3(*position), radius, **more))
    O.bodies[number].state.vel = Vector3(*velocity)
    O.bodies[number].state.angVel = Vector3(*spin)
    return number


def box(center: Triple, half: Triple, orientation: Quaternion = Quaternion(1, 0, 0, 0), **more) -> int:
    """Append a fixed box with half edges `half` and return its id."""
    more.setdefault("material", O.materials[0] if len(O.materials) else material())
    return O.bodies.append(utils.box(Vector3(*center), Vector3(*half), orientation=orientation, fixed=True, **more))


def floor(size: float = 100.0, **more) -> int:
    """A fixed box with its upper face in the plane z = 0."""
    return box((0, 0, -1), (size, size, 1), **more)


def dumbbell(ends: Sequence[Triple], radius: float = 1.0, **more) -> tuple[int, list[int]]:
    """A clump of equal spheres at `ends`; returns its id and the ids of its members."""
    more.setdefault("material", O.materials[0] if len(O.materials) else material())
    return O.bodies.appendClumped([utils.sphere(Vector3(*end), radius, **more) for end in ends])


def equip(dt: float, gravity: Triple = (0, 0, -G), before: Iterable = (), **more) -> None:
    """Give the scene the engines of Contact Dynamics and a time step.

    `before` are further engines, placed right behind ForceResetter; `more` goes to `contactdynamics.engines`.
    """
    engines = contactdynamics.engines(gravity=tuple(gravity), **more)
    O.engines = engines[:1] + list(before) + engines[1:]
    O.dt = dt


def cd():
    """The ContactDynamicsEngine of the scene."""
    return engine("ContactDynamicsEngine")


def engine(class_name: str):
    """The one engine of this class in the scene."""
    found = [e for e in O.engines if type(e).__name__ == class_name]
    assert len(found) == 1, f"{len(found)} engines of class {class_name} in O.engines"
    return found[0]


# --- running ------------------------------------------------------------------------------------------------------


def steps(number: int, after_each: Callable[[], None] | None = None) -> None:
    """Make `number` steps, calling `after_each` behind every one."""
    # Not O.run(number, True): it looks every 40 ms whether the run is over, too slow for many short ones.
    for _ in range(number):
        O.step()
        if after_each is not None:
            after_each()


def until_rest(speed: float, limit: int, after_each: Callable[[], None] | None = None, every: int = 10) -> int:
    """Step until no free body is faster than `speed` (looked at every `every` steps); returns the number of steps."""
    for done in range(every, limit + 1, every):
        steps(every, after_each)
        if max(b.state.vel.norm() for b in O.bodies if b.dynamic) < speed:
            return done
    raise AssertionError(f"not at rest after {limit} steps")


def isolated(folder: str, module: str, function: str, *arguments: str, threads: int = 1, timeout: float = 240):
    """Call `module.function(*arguments)` of tests/`folder` in a new YADE process; fail with its output if it fails."""
    command = ["yade", "-n", "-x", f"-j{threads}", str(TESTS / "isolated.py"), folder, module, function]
    command += [str(a) for a in arguments]
    # The package may have come from sys.path rather than from the environment, and the child has to find the same one.
    package = str(Path(contactdynamics.__file__).resolve().parents[1])
    path = os.pathsep.join([package, os.environ.get("PYTHONPATH", "")])
    # Passive: threads that spin while they wait make small scenes many times slower on a busy machine.
    environment = dict(os.environ, PYTHONPATH=path, PYTHONDONTWRITEBYTECODE="1", OMP_WAIT_POLICY="passive")
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=timeout)
    assert done.returncode == 0, f"exit status {done.returncode} of {' '.join(command)}\n{done.stdout}\n{done.stderr}"
    return done


# --- measuring ----------------------------------------------------------------------------------------------------


def vec(v) -> np.ndarray:
    """A YADE vector as an array."""
    return np.array([v[0], v[1], v[2]], dtype=float)


def state(number: int):
    """State of body `number`."""
    return O.bodies[number].state


def rotation(number: int) -> np.ndarray:
    """Rotation matrix of body `number`, from its own axes to the global ones."""
    m = O.bodies[number].state.ori.toRotationMatrix()
    return np.array([[m[i, j] for j in range(3)] for i in range(3)])


def contacts() -> list:
    """The interactions that belong to Contact Dynamics."""
    return [i for i in O.interactions if i.isReal and isinstance(i.phys, contactdynamics.ContactDynamicsPhys)]


def active() -> list:
    """The contacts that carry an impulse."""
    return [i for i in contacts() if i.phys.impulse.norm() > 0]


def contact(one: int, other: int):
    """The contact of two bodies, or None."""
    found = [i for i in contacts() if {i.id1, i.id2} == {one, other}]
    return found[0] if found else None


def impulse_on(number: int) -> np.ndarray:
    """Sum of the contact impulses on body `number` in the last step, global axes."""
    total = np.zeros(3)
    for i in contacts():
        if number == i.id2:
            total += vec(i.phys.impulse)
        elif number == i.id1:
            total -= vec(i.phys.impulse)
    return total


def ball_mass(radius: float, density: float = 2600.0) -> float:
    """Mass of a solid ball."""
    return 4 / 3 * math.pi * radius**3 * density


def ball_inertia(radius: float, density: float = 2600.0) -> float:
    """Moment of inertia of a solid ball."""
    return 0.4 * ball_mass(radius, density) * radius**2


def momentum() -> tuple[np.ndarray, np.ndarray]:
    """Linear momentum, and angular momentum about the origin, of all free bodies (a clump counts once)."""
    linear, angular = np.zeros(3), np.zeros(3)
    for b in O.bodies:
        if b.isClumpMember or not b.dynamic:
            continue
        p = b.state.mass * vec(b.state.vel)
        spin = vec(b.state.angMom) if b.aspherical else vec(b.state.inertia) * vec(b.state.angVel)
        linear += p
        angular += np.cross(vec(b.state.pos), p) + spin
    return linear, angular


def overlaps() -> np.ndarray:
    """Overlap of every contact at the present positions, for spheres, and spheres on upright boxes.

    Evaluated from the shapes alone; what the engine measured (at the start of the step) is not used.
    """
    found = []
    for i in contacts():
        one, two = O.bodies[i.id1], O.bodies[i.id2]
        if type(one.shape).__name__ == "Sphere":
            distance = (two.state.pos - one.state.pos).norm() - one.shape.radius
        else:
            # Box: distance of the centre from the nearest point of its surface, negative inside.
            offset = np.abs(vec(two.state.pos - one.state.pos)) - vec(one.shape.extents)
            distance = np.linalg.norm(np.maximum(offset, 0)) + min(0.0, offset.max())
        found.append(max(0.0, two.shape.radius - distance))
    return np.array(found)


def law(**attributes):
    """A new ContactDynamicsMat of the scene; friction 0.5 and the density of `material` unless given."""
    attributes.setdefault("frictionAngle", math.atan(0.5))
    attributes.setdefault("density", 2600)
    number = O.materials.append(contactdynamics.ContactDynamicsMat(**attributes))
    return O.materials[number]


def kinetic_energy() -> float:
    """Of all bodies that move freely and are integrated as balls."""
    energy = 0.0
    for b in O.bodies:
        if b.dynamic and not b.isClumpMember:
            energy += 0.5 * b.state.mass * b.state.vel.squaredNorm()
            energy += 0.5 * float(vec(b.state.inertia) @ vec(b.state.angVel) ** 2)
    return energy
