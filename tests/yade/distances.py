# SPDX-License-Identifier: GPL-2.0-or-later
"""Nearest points of a triangle, a box and a plane: an evaluation of contact geometry of our own for the tests."""

from __future__ import annotations

import numpy as np


def nearest_on_segment(p: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Nearest point of the segment from `a` to `b`."""
    t = np.clip((p - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
    return a + t * (b - a)


def nearest_on_triangle(p: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Nearest point of a triangle: its plane's foot where that lies inside, otherwise the best of three edges."""
    a, b, c = corners
    n = np.cross(b - a, c - a)
    foot = p - n * ((p - a) @ n) / (n @ n)
    inside = all(np.cross(v - u, foot - u) @ n >= 0 for u, v in ((a, b), (b, c), (c, a)))
    if inside:
        return foot
    candidates = [nearest_on_segment(p, u, v) for u, v in ((a, b), (b, c), (c, a))]
    return min(candidates, key=lambda q: np.linalg.norm(p - q))


def nearest_on_box(p: np.ndarray, center: np.ndarray, half: np.ndarray, rotation: np.ndarray) -> np.ndarray:
    """Nearest point of a turned box, for points outside of it."""
    local = rotation.T @ (p - center)
    return center + rotation @ np.clip(local, -half, half)
