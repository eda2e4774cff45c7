# SPDX-License-Identifier: GPL-2.0-or-later
"""What the engine says when the iterations do not suffice."""

from __future__ import annotations

import re

import pytest
from yade import O

from scenes import G, cd, contact, equip, floor, grain, material, steps


def column(**more) -> None:
    """Twenty balls, started cold: one iteration cannot carry the weight from the top to the floor."""
    material()
    floor()
    for k in range(20):
        grain((0, 0, 1 + 2 * k))
    equip(1e-3, tolerance=1e-10, maxIterations=1, warmStart=False, **more)


def complaints(capfd) -> list[str]:
    captured = capfd.readouterr()
    return re.findall(r"(?i)[^\n]*converge[^\n]*", captured.out + captured.err)


def test_warns_once_a_run(capfd) -> None:
    column()
    steps(20)
    found = complaints(capfd)
    assert len(found) == 1, found
    assert not cd().converged and cd().iterations == 1 and cd().residual > cd().tolerance
    assert re.search("maxIterations|tolerance", found[0])


def test_warns_again_in_a_new_scene(capfd) -> None:
    for _ in range(2):
        O.reset()
        column()
        steps(3)
        assert len(complaints(capfd)) == 1


def test_ignores(capfd) -> None:
    column(onNonConvergence="ignore")
    steps(5)
    assert complaints(capfd) == []
    assert not cd().converged


def test_raises_and_can_be_repaired() -> None:
    column(onNonConvergence="raise")
    with pytest.raises(RuntimeError) as caught:
        O.step()
    assert re.search("residual", str(caught.value)) and re.search("1e-10", str(caught.value))
    cd().maxIterations = 200000
    steps(3)
    assert cd().converged and cd().residual <= 1e-10


def test_silent_when_converged(capfd) -> None:
    column()
    cd().maxIterations = 200000
    steps(5)
    assert cd().converged and complaints(capfd) == []


@pytest.mark.parametrize("sweeps", [1, 2, 5, 12])
def test_plain_gauss_seidel_does_what_its_closed_form_says(sweeps: int) -> None:
    """Two equal balls of weight w on a floor, from cold, lower contact first: R1 = w + R2, then R2 = R1 / 2 in every sweep.

    So after k sweeps R1 = (2 - 2^(1-k)) w and R2 = (1 - 2^-k) w.
    """
    material()
    floor()
    for k in range(2):
        grain((0, 0, 1 + 2 * k))
    equip(1e-3, tolerance=1e-14, maxIterations=sweeps, warmStart=False, onNonConvergence="ignore", acceleration="none")
    steps(1)
    weight = O.bodies[1].state.mass * G
    assert cd().iterations == sweeps
    assert contact(0, 1).phys.normalForce.norm() / weight == pytest.approx(2 - 2.0 ** (1 - sweeps), rel=1e-9)
    assert contact(1, 2).phys.normalForce.norm() / weight == pytest.approx(1 - 2.0**-sweeps, rel=1e-9)


def test_default_needs_fewer_sweeps_than_plain_gauss_seidel() -> None:
    needed = {}
    for acceleration in ("default", "none"):
        O.reset()
        column(acceleration=acceleration)
        cd().maxIterations = 100000
        steps(1)
        assert cd().converged
        needed[acceleration] = cd().iterations
    # The column's condition number is (2 n / pi)^2 = 160 for 20 balls; momentum sees its square root.
    assert 5 * needed["default"] < needed["none"], needed
