# SPDX-License-Identifier: GPL-2.0-or-later
"""Contact problems that are hard on purpose, as FCLIB files: ``python3 tests/fclib/scenes.py FOLDER``, then ``scripts/bench fclib FOLDER``.

All but the tangles are W = H^T M^-1 H, q = H^T v of rigid bodies or deformable ones, so a solution exists unless the name says otherwise.
"""

from __future__ import annotations

import sys
from functools import lru_cache
from pathlib import Path

import numpy as np

import deformable
from problems import Local, write

FALL = 9.81e-2  # m/s, gravity over a step of 10 ms


class Bodies:
    """Rigid bodies and their contacts, three-dimensional; contacts of plane problems keep N and T1."""

    def __init__(self, dimension: int = 3) -> None:
        self.dimension = dimension
        self.inverse_mass: list[np.ndarray] = []
        self.centres: list[np.ndarray] = []
        self.velocities: list[np.ndarray] = []
        self.contacts: list[tuple[int, int, np.ndarray, np.ndarray]] = []
        self.drives: list[float] = []

    def body(self, centre: tuple[float, float, float], mass: float, inertia: tuple[float, float, float], velocity: np.ndarray | None = None) -> int:
        self.centres.append(np.array(centre, float))
        self.inverse_mass.append(1 / np.array([mass] * 3 + list(inertia)))
        self.velocities.append(np.array([0, 0, -FALL, 0, 0, 0]) if velocity is None else velocity)
        return len(self.centres) - 1

    def brick(self, centre: tuple[float, float, float], mass: float = 1, velocity: np.ndarray | None = None) -> int:
        """2 x 1 x 1 m."""
        return self.body(centre, mass, (mass / 6, 5 * mass / 12, 5 * mass / 12), velocity)

    def touch(self, below: int, above: int, point: tuple[float, float, float], normal: tuple[float, float, float] = (0, 0, 1), drive: float = 0) -> None:
        """A contact; -1 is the ground; ``drive`` [m/s] is added to the normal velocity."""
        self.contacts.append((below, above, np.array(point, float), np.array(normal, float)))
        self.drives.append(drive)

    def problem(self, mu: float) -> Local:
        d = self.dimension
        H = np.zeros((6 * len(self.centres), d * len(self.contacts)))
        q = np.zeros(H.shape[1])
        for c, (below, above, point, n) in enumerate(self.contacts):
            first = np.array([1.0, 0, 0]) if abs(n[0]) < 0.6 else np.array([0, 0, 1.0]) if d == 2 else np.array([0, 1.0, 0])
            first -= n * (n @ first)
            first /= np.linalg.norm(first)
            for k, axis in enumerate((n, first, np.cross(n, first))[:d]):
                for body, side in ((above, 1), (below, -1)):
                    if body >= 0:
                        H[6 * body : 6 * body + 6, d * c + k] += side * np.concatenate([axis, np.cross(point - self.centres[body], axis)])
            q[d * c] += self.drives[c]
        W = (H.T * np.concatenate(self.inverse_mass)) @ H
        return Local(d, W, H.T @ np.concatenate(self.velocities) + q, np.full(len(self.contacts), mu))


def wall(rows: int, bricks: int, mu: float, dimension: int = 3, decades: float = 0, seed: int = 1) -> Local:
    """Bricks in running bond, four contacts (two in the plane) wherever two faces meet."""
    random = np.random.default_rng(seed)
    bodies, below = Bodies(dimension), [(-1, -1e9, 1e9)]
    for row in range(rows):
        here = []
        for i in range(bricks - row % 2):
            x = 2 * i + row % 2
            push = 0.03 * random.normal(size=6)
            push[2] -= FALL
            if dimension == 2:
                push[[1, 3, 5]] = 0
            brick = bodies.brick((x, 0, row + 0.5), 10 ** (decades * (random.random() - 0.5)), push)
            for other, left, right in below:
                start, end = max(x - 1, left), min(x + 1, right)
                if end - start > 1e-9:
                    for along in (start, end):
                        for y in (-0.5, 0.5) if dimension == 3 else (0.0,):
                            bodies.touch(other, brick, (along, y, row))
            here.append((brick, x - 1, x + 1))
        below = here
    return bodies.problem(mu)


def tower(levels: int, mu: float, ratio: float = 1) -> Local:
    """Bricks one on the other, eight contacts a face (hyperstatic); the mass grows by ``ratio`` from level to level."""
    bodies = Bodies()
    for level in range(levels):
        brick = bodies.brick((0, 0, level + 0.5), ratio**level)
        for x in (-1, -0.3, 0.3, 1):
            for y in (-0.5, 0.5):
                bodies.touch(level - 1, brick, (x, y, level))
    return bodies.problem(mu)


def chain(length: int, ratio: float = 1, dimension: int = 3) -> Local:
    """A column of balls, one contact each; the topmost is ``ratio`` times as heavy."""
    bodies = Bodies(dimension)
    for i in range(length):
        mass = ratio if i == length - 1 else 1
        bodies.body((0, 0, i + 0.5), mass, (0.1 * mass,) * 3)
        bodies.touch(i - 1, i, (0, 0, i))
    return bodies.problem(0.3)


def packing(count: int, mu: float, seed: int, heavy: float = 1) -> Local:
    """Balls in a box, rather too close: some six contacts each; every tenth is ``heavy`` times as heavy."""
    random = np.random.default_rng(seed)
    side = (count / 1.1) ** (1 / 3)
    centres = random.uniform(0.4, side - 0.4, (count, 3))
    for _ in range(300):  # push apart what overlaps
        difference = centres[:, None] - centres[None]
        distance = np.linalg.norm(difference, axis=2) + np.eye(count)
        push = np.where(distance < 1, (1 - distance) / distance, 0)[:, :, None] * difference
        centres = np.clip(centres + 0.3 * push.sum(axis=1), 0.45, side - 0.45)
    bodies = Bodies()
    for i, centre in enumerate(centres):
        mass = heavy if i % 10 == 0 else 1
        velocity = np.concatenate([0.02 * random.normal(size=3) + [0, 0, -FALL], [0, 0, 0]])
        bodies.body(tuple(centre), mass, (0.1 * mass,) * 3, velocity)
    for i in range(count):
        for j in range(i):
            offset = centres[i] - centres[j]
            if np.linalg.norm(offset) < 1.02:
                normal = offset / np.linalg.norm(offset)
                bodies.touch(j, i, tuple(centres[j] + offset / 2), tuple(normal))
        for axis in range(3):
            for wall, direction in ((0.0, 1), (side, -1)):
                if abs(centres[i][axis] - wall) < 0.5:
                    normal, point = np.zeros(3), centres[i].copy()
                    normal[axis], point[axis] = direction, wall
                    if axis < 2 or direction > 0:
                        bodies.touch(-1, i, tuple(point), tuple(normal))
    return bodies.problem(mu)


def arch(stones: int, mu: float) -> Local:
    """Half a ring of bricks between two abutments, with friction on slanted faces; four contacts a joint."""
    bodies = Bodies()
    step = np.pi / stones
    for i in range(stones + 1):
        if i < stones:
            middle = (i + 0.5) * step
            bodies.brick((5 * np.cos(middle), 0, 5 * np.sin(middle)))
        angle = i * step
        normal = (-np.sin(angle), 0, np.cos(angle))
        below, above = (i - 1 if i else -1), (i if i < stones else -1)
        for radius in (4.5, 5.5):
            for y in (-0.5, 0.5):
                point = (radius * np.cos(angle), y, radius * np.sin(angle))
                if above < 0:
                    bodies.touch(-1, below, point, tuple(-np.array(normal)))
                else:
                    bodies.touch(below, above, point, normal)
    return bodies.problem(mu)


def vice(bricks: int, speed: float) -> Local:
    """A row of bricks that the ground presses from both ends, ``speed`` [m/s] each: no solution when it is positive."""
    bodies = Bodies()
    for i in range(bricks):
        bodies.brick((2 * i, 0, 0.5), velocity=np.zeros(6))
        for y in (-0.5, 0.5):
            for z in (0, 1):
                bodies.touch(i - 1, i, (2 * i - 1, y, z), (1, 0, 0), -speed if i == 0 else 0)
    for y in (-0.5, 0.5):
        for z in (0, 1):
            bodies.touch(-1, bricks - 1, (2 * bricks - 1, y, z), (-1, 0, 0), -speed)
    return bodies.problem(0.4)


def tangle(contacts: int, mu: float, seed: int) -> Local:
    """Half as many degrees of freedom as contact components, coupled at random. With this friction and seed sweeps and Newton steps stay at 1e-3."""
    random = np.random.default_rng(seed)
    H = random.standard_normal((3 * contacts // 2, 3 * contacts))
    return Local(3, H.T @ H, H.T @ random.standard_normal(len(H)), np.full(contacts, mu))


def unsymmetric(problem: Local, relative: float) -> Local:
    noise = np.random.default_rng(3).normal(size=problem.W.shape)
    return Local(problem.dimension, problem.W * (1 + relative * noise), problem.q, problem.mu)


def in_unit(problem: Local, kilogram: float) -> Local:
    return Local(problem.dimension, problem.W / kilogram, problem.q, problem.mu)


@lru_cache
def scenes(small: bool = False) -> dict[str, Local]:
    """All of them by name; small ones take a second in all. Names that begin with "unsolvable" have no solution."""
    size = 1 if small else 2
    return {
        "wall3d_mu03": wall(3 * size, 3 * size, 0.3),
        "wall3d_mu1": wall(3 * size, 3 * size, 1.0),
        "wall3d_decades3": wall(3 * size, 3 * size, 0.6, decades=3),
        "wall2d_mu05": wall(4 * size, 4 * size, 0.5, dimension=2),
        "wall2d_decades4": wall(4 * size, 4 * size, 0.5, dimension=2, decades=4),
        "wall3d_unsymmetric": unsymmetric(wall(3 * size, 3 * size, 0.5, seed=4), 1e-10),
        "wall3d_gram": in_unit(wall(3 * size, 3 * size, 0.5, seed=5), 1e-3),
        "wall3d_ton": in_unit(wall(3 * size, 3 * size, 0.5, seed=6), 1e3),
        "tower": tower(5 * size, 0.5),
        "tower_top_heavy": tower(5 * size, 0.5, 2),
        "chain": chain(15 * size),
        "chain_top_heavy": chain(15 * size, 1000),
        "chain2d": chain(15 * size, dimension=2),
        "packing_mu03": packing(30 * size**3, 0.3, 1),
        "packing_mu1": packing(30 * size**3, 1.0, 2),
        "packing_ratio100": packing(30 * size**3, 0.5, 3, heavy=100),
        "arch_mu06": arch(9 * size, 0.6),
        "arch_mu03": arch(9 * size, 0.3),
        "elastic_tower": deformable.tower(2 * size, 1 + size, 1e7, 0.5),
        "elastic_tower_steel": deformable.tower(2 * size, 1 + size, 2e11, 0.5),
        "elastic_tower_smooth": deformable.tower(2 * size, 1 + size, 1e9, 0),
        "tangle_mu3": tangle(30, 3.0, 14),
        "vice_open": vice(2 * size, -0.1),
        "unsolvable_vice": vice(2 * size, 0.1),
    }


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name, problem in scenes().items():
        write(folder / f"{name}.hdf5", problem)
