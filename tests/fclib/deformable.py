# SPDX-License-Identifier: GPL-2.0-or-later
"""Contact problems of elastic blocks, finite elements condensed to the contacts: W is dense where nodes share a block, and the stiffer the worse."""

from __future__ import annotations

from itertools import product

import numpy as np

from problems import Local

POISSON, DENSITY, GRAVITY = 0.3, 2000.0, 9.81
CORNERS = list(product((0, 1), repeat=3))


def element_stiffness(young: float, edge: float) -> np.ndarray:
    """Of a cube with eight nodes, three displacements each; two Gauss points a direction."""
    shear = young / (2 * (1 + POISSON))
    law = np.diag([2 * shear] * 3 + [shear] * 3)
    law[:3, :3] += young * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
    stiffness = np.zeros((24, 24))
    for point in product((0.5 - 0.5 / np.sqrt(3), 0.5 + 0.5 / np.sqrt(3)), repeat=3):
        strain = np.zeros((6, 24))
        for node, corner in enumerate(CORNERS):
            shape = [x if c else 1 - x for c, x in zip(corner, point)]
            x, y, z = ((1 if corner[k] else -1) * np.prod(np.delete(shape, k)) / edge for k in range(3))
            strain[:, 3 * node : 3 * node + 3] = [[x, 0, 0], [0, y, 0], [0, 0, z], [y, x, 0], [0, z, y], [z, 0, x]]
        stiffness += strain.T @ law @ strain * edge**3 / 8
    return stiffness


def tower(levels: int, edges: int, young: float, mu: float, step: float = 1e-2, gust: float = 0.02, seed: int = 1) -> Local:
    """Cubes of 1 m one on the other, ``edges`` elements along each edge, node on node; ``young`` in Pa, ``step`` in s.

    The nodes fall for a step, with random velocities of ``gust`` [m/s] beside; implicit Euler: W = H^T (M + step^2 K)^-1 H.
    """
    side = edges + 1
    nodes = levels * side**3
    number = np.arange(nodes).reshape(levels, side, side, side)
    element, mass = element_stiffness(young, 1 / edges), DENSITY / edges**3 / 8
    matrix = np.zeros((3 * nodes, 3 * nodes))
    masses = np.zeros(3 * nodes)
    for level, i, j, k in product(range(levels), *(range(edges),) * 3):
        of = [3 * number[level, i + a, j + b, k + c] + axis for a, b, c in CORNERS for axis in range(3)]
        matrix[np.ix_(of, of)] += step**2 * element
        masses[of] += mass
    matrix += np.diag(masses)
    contacts = [(level, i, j) for level in range(levels) for i in range(side) for j in range(side)]
    H = np.zeros((3 * nodes, 3 * len(contacts)))
    for contact, (level, i, j) in enumerate(contacts):
        for component, axis in enumerate((2, 0, 1)):
            H[3 * number[level, i, j, 0] + axis, 3 * contact + component] = 1
            if level:
                H[3 * number[level - 1, i, j, edges] + axis, 3 * contact + component] = -1
    velocities = gust * np.random.default_rng(seed).normal(size=(nodes, 3)) - [0, 0, step * GRAVITY]
    response = np.linalg.solve(matrix, np.column_stack([H, masses * velocities.ravel()]))
    W = H.T @ response[:, :-1]
    return Local(3, (W + W.T) / 2, H.T @ response[:, -1], np.full(len(contacts), mu))
