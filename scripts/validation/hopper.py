# SPDX-License-Identifier: GPL-2.0-or-later
"""Discharge of 5,000 balls from a flat-bottomed hopper of STL facets through orifices of several diameters, against Beverloo's law.

    PYTHONPATH=build/python yade -n -x scripts/validation/hopper.py [grains=5000] [orifices=6,7.5,9,10.5] [until=0.4]

Beverloo, Leniger, van de Velde (1961): W = C rho_b sqrt(g) (D - k d)^2.5, with C about 0.58 and k about 1.4 for balls. W^(2/5) is
fitted as a straight line in D; the fit gives C and k. The bed is filled once; the rings of the floor inside of an orifice are then erased
in mid-run, and grains far below are, too. The flow is that between a tenth of the mass and the share `until` of it.
"""
import math
import sys
import tempfile
import time

import numpy as np
from yade import ymport
from yade.utils import *

import contactdynamics

arguments = dict(a.split("=") for a in sys.argv[1:] if "=" in a)
grains = int(arguments.get("grains", 5000))
d, g, friction = 4e-3, 9.81, 0.4
until = float(arguments.get("until", 0.4))
orifices = [float(x) for x in arguments.get("orifices", "6,7.5,9,10.5").split(",")]  # in diameters
wall = 0.5 * 20 * d * (grains / 5000) ** (1 / 3)  # radius of the hopper
top = 40 * d * (grains / 5000) ** (1 / 3)
segments = 48


def ring(inner: float, outer: float, z_inner: float, z_outer: float) -> list:
    """Triangles between two circles (each twice subdivided by its segments) about the z axis."""
    triangles = []
    for k in range(segments):
        a, b = (2 * math.pi * (k + n) / segments for n in (0, 1))
        p, q = (tuple(inner * x for x in (math.cos(t), math.sin(t))) + (z_inner,) for t in (a, b))
        s, t = (tuple(outer * x for x in (math.cos(u), math.sin(u))) + (z_outer,) for u in (a, b))
        triangles += [(p, s, t)] + ([(p, t, q)] if inner > 0 else [])
    return triangles


def stl(triangles: list) -> list:
    """The facets of a text STL file in single precision, as a user imports them."""
    lines = ["solid hopper"]
    for corners in triangles:
        lines += ["facet normal 0 0 0", "outer loop", *("vertex %.7e %.7e %.7e" % c for c in corners), "endloop", "endfacet"]
    with tempfile.NamedTemporaryFile("w", suffix=".stl") as file:
        file.write("\n".join([*lines, "endsolid hopper"]) + "\n")
        file.flush()
        return ymport.stl(file.name)


def fill() -> None:
    """The bed at rest, before any orifice is opened."""
    O.materials.append(FrictMat(density=2500, frictionAngle=math.atan(friction)))
    radii = [0.0] + [0.5 * x * d for x in sorted(orifices)] + [wall]
    for inner, outer in zip(radii, radii[1:]):
        O.bodies.append(stl(ring(inner, outer, 0, 0)))
    for low, high in ((0, 0.5 * top), (0.5 * top, top)):
        O.bodies.append(stl(ring(wall, wall, low, high)))
    generator = np.random.default_rng(1)
    spacing, placed, z = 1.12 * d, 0, 0.6 * d
    while placed < grains:
        for x in np.arange(-wall, wall, spacing):
            for y in np.arange(-wall, wall, spacing):
                shift = generator.uniform(-0.05, 0.05, 3) * d
                if placed < grains and math.hypot(x + shift[0], y + shift[1]) < wall * math.cos(math.pi / segments) - 0.51 * d:
                    O.bodies.append(sphere((x + shift[0], y + shift[1], z + shift[2]), 0.5 * d * generator.uniform(0.95, 1.0)))
                    placed += 1
        z += spacing
    O.engines = contactdynamics.engines(gravity=(0, 0, -g), tolerance=1e-3, maxIterations=300, onNonConvergence="ignore")
    O.dt = 0.05 * math.sqrt(0.5 * d / g)
    for _ in range(40):
        O.run(20, True)
        if max(b.state.vel.norm() for b in O.bodies if isinstance(b.shape, Sphere)) < 0.02 * math.sqrt(g * d):
            break


def balls() -> list:
    return [b for b in O.bodies if isinstance(b.shape, Sphere)]


def discharge(orifice: float) -> dict:
    """Open an orifice of `orifice` diameters; returns mass flow and what was watched on the way."""
    engine = next(e for e in O.engines if type(e).__name__ == "ContactDynamicsEngine")
    mass = sum(b.state.mass for b in balls())
    height = np.quantile([b.state.pos[2] for b in balls()], 0.98)
    density = sum(b.state.mass for b in balls() if b.state.pos[2] < 0.7 * height) / (math.pi * wall**2 * 0.7 * height)
    for b in [b for b in O.bodies if isinstance(b.shape, Facet)]:
        corners = [b.state.pos + b.state.ori * v for v in b.shape.vertices]
        if max(abs(c[2]) for c in corners) < 1e-9 and max(math.hypot(c[0], c[1]) for c in corners) < 0.5 * orifice * d * (1 + 1e-6):
            O.bodies.erase(b.id)
    out, sums, lost, deepest, started = 0.0, [], 0, 0.0, O.time
    passed = set()
    while out < until * mass and O.time - started < 8:
        O.run(5, True)
        deepest = max(deepest, engine.maxPenetration)
        for b in balls():
            p, r = b.state.pos, math.hypot(b.state.pos[0], b.state.pos[1])
            if p[2] > 0 and r > wall:
                lost += 1
            if p[2] < 0 and b.id not in passed:
                passed.add(b.id)
                out += b.state.mass
                if r > 0.5 * orifice * d + 5 * O.dt * b.state.vel.norm():  # where it was five steps ago, at most
                    lost += 1
            if p[2] < -8 * d:
                O.bodies.erase(b.id)
        sums.append((O.time, out))
    t, m = np.array(sums).T
    window = (m > 0.1 * mass) & (m < until * mass)
    flow = np.polyfit(t[window], m[window], 1)[0]
    return dict(D=orifice, flow=flow, density=density, lost=lost, deepest=deepest / (0.5 * d), grains=len(passed), time=O.time - started)


began = time.process_time()
fill()
O.saveTmp("bed")
print(f"{len(balls())} grains at rest after {O.iter} steps, {time.process_time() - began:.0f} s", flush=True)
results = []
for orifice in sorted(orifices):
    O.loadTmp("bed")
    began, first = time.process_time(), O.iter
    results.append(discharge(orifice))
    r = results[-1]
    print(
        f"D = {orifice:g} d: {r['flow']:.4f} kg/s, {r['grains']} grains in {r['time']:.2f} s, through a wall: {r['lost']}, "
        f"largest overlap {r['deepest']:.1e} r, {O.iter - first} steps in {time.process_time() - began:.0f} s",
        flush=True,
    )
D = np.array([r["D"] for r in results])
scaled = np.array([r["flow"] / (r["density"] * math.sqrt(g) * d**2.5) for r in results]) ** 0.4
slope, offset = np.polyfit(D, scaled, 1)
worst = np.abs((slope * D + offset) ** 2.5 / scaled**2.5 - 1).max()
print(f"bulk density {results[0]['density']:.0f} kg/m3; C = {slope**2.5:.3f}, k = {-offset / slope:.2f}, largest deviation {100 * worst:.1f} %")
assert all(r["lost"] == 0 for r in results), "grains left through a wall"
if len(results) > 2:
    assert worst < 0.05 and 0.4 < slope**2.5 < 0.8 and 0.5 < -offset / slope < 3
