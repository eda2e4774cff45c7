# SPDX-License-Identifier: GPL-2.0-or-later
"""contactdynamics.forcenetwork: bars where forces of closed form act, pictures in files, and what it refuses."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib import image
from yade import O, Vector3, polyhedra_utils, utils

from blocks import block
from contactdynamics import forcenetwork
from scenes import EPS, G, ball_mass, equip, floor, grain, material, steps

H = 1e-3
TIGHT = 1e-10  # tolerance of the solve
# Of a contact that is closed and sticks the residual is F = u / W_NN, so a speed of at most sqrt(W_NN) R TIGHT is left there, R^2 the sum of r W r over
# the contacts (NaturalMap.hpp): with masses and levers of these few bodies 5 G H TIGHT, of a ball on the block and of upper corners three times that. A
# force is off by m/h of such speeds, a moment by levers up to 3 m besides.
FORCE = 10 * TIGHT  # relative
PLACE = 30 * TIGHT  # of the line of action, and of the ends of a bar along it [m]
REST = 3 * H * 15 * G * H * TIGHT + 16 * 3 * EPS  # of what lies still for three steps, with the round-off of coordinates up to 3 [m]
VOLUME = 32 * EPS  # a volume is the sum of some dozen terms


def bars(network: forcenetwork.ForceNetwork) -> list:
    """Bars with their forces, the lowest first."""
    found = [(np.array(ends), force) for ends, force in zip(network.segments, network.forces)]
    return sorted(found, key=lambda bar: bar[0][:, 2].mean())


def test_column_of_spheres() -> None:
    """From centre to centre, and on the floor from the contact point; the force is the weight above."""
    material()
    floor()
    grain((0, 0, 1))
    grain((0, 0, 3))
    equip(H, tolerance=TIGHT)
    steps(3)
    network = forcenetwork.forceNetwork()
    (low, heavy), (high, light) = bars(network)
    assert np.sort(low[:, 2]) == pytest.approx([0, 1], abs=REST) and np.sort(high[:, 2]) == pytest.approx([1, 3], abs=REST)
    assert [heavy, light] == pytest.approx([2 * ball_mass(1) * G, ball_mass(1) * G], rel=FORCE)
    assert len(network.radii) == 2 and not network.blocks


def test_block_bears_a_sphere_off_its_middle() -> None:
    """The bar on the ground lies on the resultant of weight and load, though both act on four corners."""
    stone = material()
    O.bodies.append(utils.wall(0, axis=2, material=stone))
    stone_block = block((0, 0, 1), (1.5, 1.5, 1), material=stone)
    grain((1, 0.5, 3))
    equip(H, tolerance=TIGHT)
    steps(3)
    network = forcenetwork.forceNetwork()
    (low, heavy), (high, light) = bars(network)
    weight, load = O.bodies[stone_block].state.mass * G, ball_mass(1) * G
    assert [heavy, light] == pytest.approx([weight + load, load], rel=FORCE)
    assert low[:, :2] == pytest.approx(np.array([[1, 0.5], [1, 0.5]]) * load / (weight + load), abs=PLACE)
    radius = (3 * 18 / (4 * np.pi)) ** (1 / 3)
    assert np.sort(low[:, 2]) == pytest.approx([0, radius], abs=PLACE)
    # On the upper face; the sphere is above the contact point by its radius, the block reaches below by its own.
    assert np.sort(high[:, 2]) == pytest.approx([2 - radius, 3], abs=PLACE)
    (drawn,) = network.blocks
    assert drawn.radius == pytest.approx(radius, rel=VOLUME) and len(drawn.faces) == 6
    assert np.concatenate(drawn.faces).max(axis=0) == pytest.approx([1.5, 1.5, 2], abs=REST)


def test_only_a_box_that_can_move_is_a_block() -> None:
    material()
    floor()
    O.bodies.append(utils.box(Vector3(0, 0, 1), Vector3(1, 2, 1), material=O.materials[0], fixed=False))
    (drawn,) = forcenetwork.forceNetwork().blocks
    assert drawn.radius == pytest.approx((3 * 16 / (4 * np.pi)) ** (1 / 3), rel=VOLUME)
    # In sight along y: the face at low y alone, from whichever side its corners are counted.
    (face,) = forcenetwork._faces_in_sight([drawn], 1, -1)
    assert face[:, 1] == pytest.approx(np.full(4, -2.0), abs=0)


@pytest.mark.parametrize("view", ["x", "y", "z"])
@pytest.mark.parametrize("ending", ["png", "svg"])
def test_pictures(tmp_path, view: str, ending: str) -> None:
    """Spheres alone, blocks alone and both: a file with more than background in it."""
    stone = material()
    path = tmp_path / "folder" / f"network.{ending}"
    grain((0, 0, 0))
    assert len(forcenetwork.draw(str(path), view=view).radii) == 1
    O.bodies.append(polyhedra_utils.polyhedra(stone, size=(1, 1, 1), seed=2))
    forcenetwork.draw(str(path), view=view, title="both", width=2)
    O.bodies.erase(0)
    network = forcenetwork.draw(str(path), view=view, width=2, slab=(-1, 1))
    assert len(network.blocks) == 1 and len(network.radii) == 0
    if ending == "png":
        pixels = image.imread(path)
        assert len(np.unique(pixels.reshape(-1, pixels.shape[-1]), axis=0)) >= 2


def test_what_is_refused(tmp_path) -> None:
    material()
    grain((0, 0, 0))
    for more, words in (
        ({"view": "w"}, "'x', 'y' and 'z'"),
        ({"thickest": 0}, "must be positive"),
        ({"width": -1}, "must be positive"),
        ({"slab": (3, 4)}, "no sphere or block to draw in the slab"),
    ):
        with pytest.raises(ValueError, match=words):
            forcenetwork.draw(str(tmp_path / "none.png"), **more)
    assert not list(tmp_path.iterdir())
