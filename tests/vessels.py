# SPDX-License-Identifier: GPL-2.0-or-later
"""Vessels of facets with balls in them: a turning drum, and a hopper imported from an STL file."""

from __future__ import annotations

import math
import tempfile

import numpy as np
from yade import O, Quaternion, Vector3, geom, ymport

from scenes import equip, grain, material

SPIN = 6.0  # of the drum [rad/s]
DRUM = 1.0  # its radius [m]


def drum(balls: int, engine) -> tuple[list[int], list[int]]:
    """A closed horizontal drum about the y axis, 24 sides with flat ends, and balls in it; returns both."""
    material(friction=0.5)
    upright = Quaternion(Vector3(1, 0, 0), math.pi / 2)
    shell = O.bodies.append(geom.facetCylinder((0, 0, 0), DRUM, 1.2, orientation=upright, segmentsNumber=24, material=O.materials[0]))
    generator = np.random.default_rng(6)
    inside = []
    for k in range(balls):
        place = np.array([k % 4 - 1.5, k // 4 % 3 - 1.0, k // 12 - 2.0]) * [0.28, 0.3, 0.28]
        inside.append(grain(place + generator.uniform(-0.02, 0.02, 3), radius=generator.uniform(0.09, 0.12)))
    equip(2e-3, tolerance=1e-6, maxIterations=5000)
    O.engines = O.engines[:1] + [engine(shell)] + O.engines[1:]
    O.trackEnergy = True
    return shell, inside


# The hopper: a funnel of 45 degrees below a cylinder, in diameters D of a grain; its orifice lies in the plane z = 0.
D = 4e-3
ORIFICE, WIDE, HIGH = 3.0 * D, 6.5 * D, 20 * D  # radii of orifice and cylinder, height of the brim [m]
SIDES = 24
FUNNEL = 2 * SIDES  # its facets, the first ones of the scene; those of the cylinder follow


def _band(low: tuple[float, float], high: tuple[float, float]) -> list:
    """Triangles of a pyramid's side between two regular polygons, each given by its (radius, height)."""
    triangles = []
    for k in range(SIDES):
        a, b = (2 * math.pi * n / SIDES for n in (k, k + 1))
        corners = [(r * math.cos(t), r * math.sin(t), z) for r, z in (low, high) for t in (a, b)]
        triangles += [(corners[0], corners[1], corners[3]), (corners[0], corners[3], corners[2])]
    return triangles


def hopper(balls: int, file: str) -> list[int]:
    """Writes the mesh as STL, imports it, hangs balls above the orifice; returns their ids."""
    with open(file, "w") as stl:
        print("solid hopper", file=stl)
        for corners in _band((ORIFICE, 0), (WIDE, WIDE - ORIFICE)) + _band((WIDE, WIDE - ORIFICE), (WIDE, HIGH)):
            print("facet normal 0 0 0\nouter loop", *("vertex %.7e %.7e %.7e" % c for c in corners), "endloop\nendfacet", sep="\n", file=stl)
        print("endsolid hopper", file=stl)
    material(friction=0.4, density=2500)
    O.bodies.append(ymport.stl(file, material=O.materials[0]))
    generator = np.random.default_rng(4)
    inside, spacing, z = [], 1.15 * D, 1.2 * D
    while len(inside) < balls:
        for x in np.arange(-WIDE, WIDE, spacing):
            for y in np.arange(-WIDE, WIDE, spacing):
                wide = min(WIDE, ORIFICE + z) * math.cos(math.pi / SIDES)
                if len(inside) < balls and math.hypot(x, y) < wide - D:
                    shift = generator.uniform(-0.05, 0.05, 3) * D
                    inside.append(grain(np.array([x, y, z]) + shift, radius=0.5 * D * generator.uniform(0.9, 1)))
        z += spacing
    equip(0.05 * math.sqrt(0.5 * D / 9.81), maxIterations=2000)
    return inside


def hopper_from_anywhere(balls: int) -> list[int]:
    """The same where nobody needs the file."""
    with tempfile.TemporaryDirectory() as folder:
        return hopper(balls, folder + "/hopper.stl")
