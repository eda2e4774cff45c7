# SPDX-License-Identifier: GPL-2.0-or-later
"""A scene for each contact law and the exact numbers it leads to; run in processes of their own."""

from __future__ import annotations

import numpy as np
from yade import O

from scenes import box, contacts, equip, grain, law, state, steps

LAWS = {
    "restitution": dict(normalRestitution=0.7, tangentialRestitution=0.3),
    "friction": dict(frictionAngle=0.3, staticFrictionAngle=0.6),
    "cohesion": dict(cohesionForce=3e4, cohesionStress=1e4),
    "compliance": dict(kn=3e8, ks=2e8, normalDamping=1e5),
    "rolling": dict(rollingFriction=0.1, twistingFriction=0.1),
    "repair": dict(),
    "signorini": dict(normalRestitution=0.5),
    "velocitySignorini": dict(cohesionForce=1e4),
}


def build(kind: str) -> None:
    generator = np.random.default_rng(11)
    law(**LAWS[kind])
    box((0, 0, -1), (20, 20, 1))
    spacing = 1.85 if kind == "repair" else 2.1  # grains of radius 0.8 to 1
    for k in range(60):
        place = spacing * np.array([k % 4, k // 4 % 4, k // 16]) + [0, 0, 1.0]
        grain(place, radius=generator.uniform(0.8, 1), velocity=generator.uniform(-2, 2, 3), spin=generator.uniform(-2, 2, 3))
    contact_law = kind if "ignorini" in kind else "quasiInelasticShock"
    equip(5e-3, tolerance=1e-4, maxIterations=3000, onNonConvergence="ignore", contactLaw=contact_law)
    O.trackEnergy = True


def numbers() -> str:
    lines = []
    for b in O.bodies:
        s = b.state
        lines.append(" ".join(float(x).hex() for v in (s.pos, s.vel, s.angVel) for x in v))
    for i in sorted(contacts(), key=lambda i: (min(i.id1, i.id2), max(i.id1, i.id2))):
        p = i.phys
        sign = 1 if i.id1 < i.id2 else -1  # YADE may load a pair the other way round
        lines.append(" ".join([p.bond, p.status] + [float(sign * x).hex() for v in (p.impulse, p.torqueImpulse) for x in v]))
    names = sorted(n for n in O.energy.keys() if n.startswith("contact"))
    return "\n".join(lines + [f"{n} {float(O.energy[n]).hex()}" for n in names])


def straight(kind: str, result: str) -> None:
    build(kind)
    steps(120)
    with open(result, "w") as file:
        file.write(numbers())


def halves(kind: str, scene: str, result: str) -> None:
    build(kind)
    steps(70)
    O.save(scene)
    O.reset()
    O.load(scene)
    steps(50)
    with open(result, "w") as file:
        file.write(numbers())
