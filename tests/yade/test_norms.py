# SPDX-License-Identifier: GPL-2.0-or-later
"""What the engine says of its error, against an evaluation in Python that shares nothing with the solver but the problem itself."""

from __future__ import annotations

import numpy as np
import pytest
from yade import O, Vector3

from heap import heap
from scenes import box, cd, equip, floor, grain, state, steps


class Problem:
    """The last problem as dense arrays: W, q, r (rows of three), mu, and u = W r + q."""

    def __init__(self) -> None:
        given = cd().lastProblem()
        count = len(given["friction"])
        blocks = np.reshape(given["blocks"], (-1, 3, 3))
        self.W = np.zeros((3 * count, 3 * count))
        for row in range(count):
            for k in range(given["rowStart"][row], given["rowStart"][row + 1]):
                column = given["column"][k]
                self.W[3 * row : 3 * row + 3, 3 * column : 3 * column + 3] += blocks[k]
        self.q, self.r = np.reshape(given["q"], (-1, 3)), np.reshape(given["impulse"], (-1, 3))
        self.mu = np.array(given["friction"])
        self.u = (self.W @ self.r.ravel()).reshape(-1, 3) + self.q
        self.own = np.array([self.W[3 * i : 3 * i + 3, 3 * i : 3 * i + 3] for i in range(count)])


def projected(z: np.ndarray, mu: np.ndarray) -> np.ndarray:
    """Nearest points of the cones |t| <= mu n, by rows."""
    normal, tangential = z[:, 0], np.linalg.norm(z[:, 1:], axis=1)
    onto = np.maximum(0, (normal + mu * tangential) / (1 + mu**2))
    direction = np.divide(z[:, 1:], tangential[:, None], out=np.zeros_like(z[:, 1:]), where=tangential[:, None] > 0)
    surface = np.column_stack([onto, (mu * onto)[:, None] * direction])
    return np.where((tangential <= mu * normal)[:, None], z, surface)


def natural_map(r: np.ndarray, u: np.ndarray, mu: np.ndarray, rho: np.ndarray) -> np.ndarray:
    shifted = u + np.column_stack([mu * np.linalg.norm(u[:, 1:], axis=1), np.zeros((len(u), 2))])
    return r - projected(r - rho[:, None] * shifted, mu)


def times(W: np.ndarray, r: np.ndarray) -> np.ndarray:
    return np.einsum("cij,cj->ci", W, r)


def local_solutions(p: Problem) -> np.ndarray:
    """One more solution of each contact with all others held, by projections until nothing moves: slow, and not the solver's way."""
    free = p.u - times(p.own, p.r)
    rho = 0.5 / np.linalg.eigvalsh(p.own)[:, -1]
    r = p.r.copy()
    for _ in range(20000):
        change = natural_map(r, free + times(p.own, r), p.mu, rho)
        r -= change
        if np.abs(change).max() <= 1e-15 * np.abs(r).max():
            break
    return r


@pytest.mark.parametrize("sweeps", [2, 1000])
def test_norms_against_an_independent_evaluation(sweeps: int) -> None:
    """After few sweeps the errors are large, after many they are small. Round-off of sums and of the projections: 1e-9 of the impulses."""
    heap(tolerance=1e-3)
    cd().maxIterations = sweeps
    steps(1)
    norms, p = cd().convergenceNorms(), Problem()

    rho = 1 / p.own[:, 0, 0]
    F = natural_map(p.r, p.u, p.mu, rho)
    energy = lambda x: np.einsum("ci,cij,cj->", x, p.own, x)  # noqa: E731
    residual = np.sqrt(energy(F) / energy(p.r))
    assert residual == pytest.approx(cd().residual, rel=1e-6)
    assert norms["naturalMap"] == pytest.approx(residual, rel=1e-6)

    ones = natural_map(p.r, p.u, p.mu, np.ones(len(p.mu)))
    assert norms["siconos"] == pytest.approx(np.linalg.norm(ones) / max(np.linalg.norm(x) for x in (p.q, p.r, p.u)), rel=1e-6)

    dR = local_solutions(p) - p.r
    active = (np.abs(p.r).max(axis=1) > 0) | (np.abs(dR).max(axis=1) > 1e-14 * np.abs(p.r).max())
    R, dR, W = p.r[active], dR[active], p.own[active]
    dV, WR = times(W, dR), times(W, R)
    square = lambda x: np.sum(x**2, axis=1)  # noqa: E731
    work = np.sum(R * WR)
    expected = {
        "quadDV": np.sqrt(np.mean(square(dV)) / np.mean(square(WR))),
        "quadDVR": np.sqrt(np.mean(square(dV) * square(R))) / (work / len(R)),
        "meanDVoR": np.sum(R * dV) / work,
        "quadraticAccuracy": np.sqrt(np.sum(square(dR)) / np.sum(square(R))),
        "largestAccuracy": np.sqrt(square(dR).max() / np.mean(square(R))),
    }
    assert norms["active"] == len(R)
    for name, value in expected.items():
        assert norms[name] == pytest.approx(value, rel=1e-5, abs=1e-9), name
    assert expected["quadraticAccuracy"] > (1e-2 if sweeps == 2 else 1e-6)  # or the comparison would say little


def test_norms_vanish_at_a_solution() -> None:
    """One ball at rest on the floor is solved by its first visit: every error is round-off."""
    floor()
    grain((0, 0, 1))
    equip(1e-3)
    steps(2)
    norms = cd().convergenceNorms()
    assert norms.pop("active") == 1
    assert max(abs(value) for value in norms.values()) < 1e-14


def test_without_a_step_there_is_nothing_to_measure() -> None:
    floor()
    equip(1e-3)
    with pytest.raises(RuntimeError, match="convergenceNorms.*no step has been solved"):
        cd().convergenceNorms()


def test_largest_approach_speed_from_the_problem() -> None:
    """The speed beside the residual: what gap velocity and motion leave, by the components of u."""
    heap(tolerance=1e-3, maxIterations=2)
    assert cd().maxApproachSpeed == pytest.approx(max(0, -Problem().u[:, 0].min()), rel=1e-9)


@pytest.mark.parametrize("speeds", [(0.1, -0.1), (0, -0.1), (0.1, 0)])
def test_a_grain_squeezed_by_driven_walls_is_not_called_converged(speeds: tuple[float, float], capfd) -> None:
    """Two boxes with given velocities, or one, close on a ball: no impulse stops them. The step says so, and goes on."""
    left, right = (box((1.5 * sign, 0, 0), (0.5, 2, 2)) for sign in (-1, 1))
    grain((0, 0, 0))
    for number, speed in zip((left, right), speeds):
        state(number).vel = Vector3(speed, 0, 0)
    equip(1e-3, gravity=(0, 0, 0), maxIterations=20000)
    for _ in range(5):
        O.step()
        assert not cd().converged
        # Shared between the two contacts, or all on one of them.
        closing = speeds[0] - speeds[1]
        assert 0.4995 * closing <= cd().maxApproachSpeed <= 1.0005 * closing
    assert "no solution" in capfd.readouterr().err
    state(left).vel = state(right).vel = Vector3(0, 0, 0)
    steps(2)
    assert cd().converged


@pytest.mark.parametrize("tolerance", [1e-3, 1e-4])
def test_a_load_on_a_floor_that_rises_is_not_called_unsolvable(tolerance: float) -> None:
    """Nineteen balls under one a thousand times as heavy: the floor lifts them all, though the sweeps take long to notice."""
    lowest = box((0, 0, -0.5), (20, 20, 0.5))
    state(lowest).vel = Vector3(0, 0, 0.1)
    for height in range(20):
        grain((0, 0, 0.5 + height), radius=0.5)
    state(20).mass *= 1000
    state(20).inertia *= 1000
    equip(1e-3, tolerance=tolerance)
    for _ in range(60):
        O.step()
        assert cd().converged or cd().residual > tolerance, O.iter  # short of sweeps is not unsolvable
