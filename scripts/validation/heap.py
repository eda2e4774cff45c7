# SPDX-License-Identifier: GPL-2.0-or-later
"""Heaps of balls that roll with friction, by Contact Dynamics and by YADE's Hertz-Mindlin law, from a cylinder that is lifted off a rough floor.

    PYTHONPATH=build/python yade -n -x scripts/validation/heap.py [grains=250] [rolling=0,0.1,0.3] [laws=cd,mindlin] [seeds=1,2]

Told of each heap: the slope of the cone with the same mean height and mean square radius (a cone of height H and radius A has H/4 and 3 A^2 / 10),
mean height of the centres above those of the floor's balls, processor time. `rolling` is ContactDynamicsMat.rollingFriction; `eta` of the soft law
is half of it, which is the same torque between equal balls.
"""
import math
import sys
import time

import numpy as np
from yade import geom
from yade.utils import *

import contactdynamics
from contactdynamics import ContactDynamicsMat

arguments = dict(a.split("=") for a in sys.argv[1:] if "=" in a)
grains = int(arguments.get("grains", 250))
r, g, friction, restitution = 5e-3, 9.81, 0.5, 0.3
wide = 1.4 * r * grains ** (1 / 3)  # radius of the cylinder


def scene(law: str, rolling: float, seed: int) -> tuple[list[int], list[int]]:
    """Balls above a floor of fixed balls, in a cylinder; ids of the balls and of the facets of the cylinder."""
    O.reset()
    if law == "cd":
        made = ContactDynamicsMat(density=2500, frictionAngle=math.atan(friction), rollingFriction=rolling, normalRestitution=restitution)
    else:
        made = FrictMat(density=2500, frictionAngle=math.atan(friction), young=2e6, poisson=0.3)
    O.materials.append(made)
    generator = np.random.default_rng(seed)
    count = math.ceil(4 * wide / (1.9 * r))
    for i, j in np.ndindex(2 * count + 1, 2 * count + 1):
        place = 1.9 * r * np.array([i - count, j - count, 0]) + (0, 0, -0.5 * r * generator.uniform())
        if math.hypot(*place[:2]) < 4 * wide:
            O.bodies.append(sphere(place, r, fixed=True))
    cylinder = O.bodies.append(geom.facetCylinder((0, 0, 20 * wide), wide, 40 * wide - 2 * r, segmentsNumber=24, wallMask=4))
    balls, height = [], 2.2 * r
    while len(balls) < grains:
        for x, y in np.stack(np.meshgrid(*2 * [np.arange(-wide, wide, 2.3 * r)]), -1).reshape(-1, 2):
            place = np.array([x, y, height]) + generator.uniform(-0.1, 0.1, 3) * r
            if len(balls) < grains and math.hypot(*place[:2]) < wide * math.cos(math.pi / 24) - 1.1 * r:
                balls.append(O.bodies.append(sphere(place, r * generator.uniform(0.85, 1.0))))
        height += 2.3 * r
    return balls, cylinder


def equip(law: str, rolling: float, cylinder: list[int]) -> TranslationEngine:
    lift = TranslationEngine(ids=cylinder, translationAxis=(0, 0, 1), velocity=0.1, dead=True)
    if law == "cd":
        engines = contactdynamics.engines(gravity=(0, 0, -g), onNonConvergence="ignore")
        O.dt = 0.05 * math.sqrt(r / g)
    else:
        physics = Ip2_FrictMat_FrictMat_MindlinPhys(en=restitution, es=restitution, eta=0.5 * rolling, krot=2)
        loop = InteractionLoop(
            [Ig2_Sphere_Sphere_ScGeom(), Ig2_Facet_Sphere_ScGeom()],
            [physics],
            [Law2_ScGeom_MindlinPhys_Mindlin(includeMoment=rolling > 0)],
        )
        collider = InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Facet_Aabb()])
        engines = [ForceResetter(), collider, loop, NewtonIntegrator(damping=0, gravity=(0, 0, -g))]
        O.dt = 0.2 * PWaveTimeStep()
    O.engines = engines[:1] + [lift] + engines[1:]
    return lift


def heap(law: str, rolling: float, seed: int) -> str:
    balls, cylinder = scene(law, rolling, seed)
    lift = equip(law, rolling, cylinder)
    start, unit = time.process_time(), math.sqrt(r / g)
    for dead, units in ((True, 40), (False, 120), (True, 20)):  # fill, lift, rest
        lift.dead = dead
        O.run(int(units * unit / O.dt), True)
    places = np.array([O.bodies[n].state.pos for n in balls])
    places = places[places[:, 2] > -2 * r]  # others have rolled off the floor
    mean, radius2 = places[:, 2].mean(), (places[:, :2] ** 2).sum(1).mean()
    slope = math.degrees(math.atan(4 * mean / math.sqrt(radius2 / 0.3)))
    return (
        f"{law:8}{rolling:7g}{seed:6}{slope:8.1f}{mean / r:8.2f}{math.sqrt(radius2) / r:9.2f}"
        f"{grains - len(places):6}{time.process_time() - start:9.1f}"
    )


print("law     rolling  seed   slope  height   radius  gone  seconds   (degrees; mean height and root mean square radius over r)")
for law in arguments.get("laws", "cd,mindlin").split(","):
    for rolling in arguments.get("rolling", "0,0.1,0.3").split(","):
        for seed in arguments.get("seeds", "1,2").split(","):
            print(heap(law, float(rolling), int(seed)), flush=True)
