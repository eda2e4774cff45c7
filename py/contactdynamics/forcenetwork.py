# SPDX-License-Identifier: GPL-2.0-or-later
"""A picture of the force network, as in Fig. 4 of Jean (1999): grains as light discs, contact forces as dark bars.

Each bar joins the centres of the two grains; its thickness is proportional to the force. Against a wall, a facet or a box the bar
ends at the contact point. Only what the scene holds is drawn, so the picture serves soft contacts as well.
"""

from __future__ import annotations

import os
from dataclasses import dataclass

import numpy as np
from yade import O, Sphere

#: Axes of the picture (horizontal, vertical) for a view along the key.
VIEWS = {"x": (1, 2), "y": (0, 2), "z": (0, 1)}


@dataclass(frozen=True)
class ForceNetwork:
    """Spheres and contact forces of one step, as arrays.

    :ivar centres: (n, 3) centres of the spheres [m]
    :ivar radii: (n,) radii [m]
    :ivar segments: (m, 2, 3) ends of the bars [m]
    :ivar forces: (m,) magnitude of the contact force, normal and tangential together [N]
    """

    centres: np.ndarray
    radii: np.ndarray
    segments: np.ndarray
    forces: np.ndarray


def forceNetwork() -> ForceNetwork:
    """Collect spheres and loaded contacts of the scene ``O``. Periodic contacts are drawn from body 1 outward."""
    spheres = [body for body in O.bodies if isinstance(body.shape, Sphere)]
    centre = {body.id: np.array(body.state.pos) for body in spheres}
    segments, forces = [], []
    for contact in O.interactions:
        if not contact.isReal:
            continue
        force = (contact.phys.normalForce + contact.phys.shearForce).norm()
        if force == 0:
            continue
        point = np.array(contact.geom.contactPoint)
        first = centre.get(contact.id1, point)
        second = centre.get(contact.id2, point)
        if O.periodic and contact.id1 in centre and contact.id2 in centre:
            second = second + np.array(O.cell.hSize) @ np.array(contact.cellDist)
        segments.append((first, second))
        forces.append(force)
    return ForceNetwork(
        centres=np.array(list(centre.values())).reshape(-1, 3),
        radii=np.array([body.shape.radius for body in spheres]),
        segments=np.array(segments).reshape(-1, 2, 3),
        forces=np.array(forces),
    )


def draw(
    path: str,
    view: str = "y",
    slab: tuple[float, float] | None = None,
    thickest: float = 0.35,
    title: str | None = None,
    width: float = 7.0,
    dpi: int = 120,
) -> ForceNetwork:
    """Write the force network of the scene to a picture file.

    :param path: file to write; the ending chooses the format (``.png``, ``.pdf``, ``.svg``). Its folder is made if needed.
    :param view: axis along which one looks, ``"x"``, ``"y"`` (default) or ``"z"``.
    :param slab: only grains whose centre lies between these two coordinates along ``view`` [m], and the forces that start or end
        in one of them; ``None`` (default) draws all. A slab of one or two diameters makes the chains of a deep packing visible.
    :param thickest: thickness of the bar of the largest force, in mean radii [-], > 0; the others in proportion. The default keeps the
        chains of a whole packing apart; for a thin slab 0.5 to 0.8 reads better.
    :param title: text above the picture; ``None`` for none.
    :param width: width of the picture [inch], > 0; the height follows from the packing.
    :param dpi: dots per inch of a pixel picture.
    :returns: what was drawn.
    :raises ValueError: unknown ``view``, no sphere to draw, or ``thickest`` or ``width`` not positive.
    """
    # Imported here, because a script that draws nothing should not wait for matplotlib.
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.collections import EllipseCollection, PolyCollection
    from matplotlib.figure import Figure
    from PIL import Image

    if view not in VIEWS:
        raise ValueError(f"view is {view!r}, allowed are 'x', 'y' and 'z'")
    if not (thickest > 0 and width > 0):
        raise ValueError(f"thickest ({thickest}) and width ({width}) must be positive")
    network = forceNetwork() if slab is None else _cut(forceNetwork(), "xyz".index(view), slab)
    if len(network.radii) == 0:
        raise ValueError("no sphere to draw" + ("" if slab is None else f" in the slab {slab} along {view}"))

    plane = list(VIEWS[view])
    centres = network.centres[:, plane]
    # Grains far from the eye first; the eye is at the low end of the y axis and at the high end of x and z.
    depth = network.centres[:, "xyz".index(view)]
    order = np.argsort(-depth if view == "y" else depth)
    low = (centres - network.radii[:, None]).min(axis=0)
    high = (centres + network.radii[:, None]).max(axis=0)
    margin = 0.5 * network.radii.mean()

    size = high - low + 2 * margin
    figure = Figure(figsize=(width, width * size[1] / size[0] + (0.4 if title else 0.0)), dpi=dpi)
    canvas = FigureCanvasAgg(figure)
    axes = figure.add_axes([0, 0, 1, width * size[1] / size[0] / figure.get_figheight()])
    axes.set_xlim(low[0] - margin, high[0] + margin)
    axes.set_ylim(low[1] - margin, high[1] + margin)
    axes.set_aspect("equal")
    axes.axis("off")
    diameters = 2 * network.radii[order]
    axes.add_collection(
        EllipseCollection(
            diameters, diameters, np.zeros(len(order)), units="xy", offsets=centres[order], transOffset=axes.transData,
            facecolors="#efe9dc", edgecolors="#b9ac8d", linewidths=0.5,
        )
    )
    if len(network.forces):
        # Weak forces first, so that the strong chains lie on top.
        ascending = np.argsort(network.forces)
        thickness = thickest * network.radii.mean() * network.forces[ascending] / network.forces.max()
        axes.add_collection(PolyCollection(_bars(network.segments[ascending][:, :, plane], thickness), facecolors="#1b2a41", linewidths=0))
    if title:
        figure.text(0.5, 1 - 0.2 / figure.get_figheight(), title, ha="center", va="center", fontsize=9)
    os.makedirs(os.path.dirname(os.path.abspath(path)), exist_ok=True)
    if path.lower().endswith(".png"):
        # Two tones and their blends: 32 colours look the same as millions and make the file four times smaller.
        canvas.draw()
        picture = Image.fromarray(np.asarray(canvas.buffer_rgba())[:, :, :3])
        picture.quantize(32, dither=Image.Dither.NONE).save(path, optimize=True, dpi=(dpi, dpi))
    else:
        figure.savefig(path)
    return network


def _cut(network: ForceNetwork, axis: int, slab: tuple[float, float]) -> ForceNetwork:
    """The part of the network whose grains lie in the slab; a bar stays when either of its ends does."""
    low, high = sorted(slab)
    grains = (network.centres[:, axis] >= low) & (network.centres[:, axis] <= high)
    ends = network.segments[:, :, axis]
    bars = ((ends >= low) & (ends <= high)).any(axis=1)
    return ForceNetwork(network.centres[grains], network.radii[grains], network.segments[bars], network.forces[bars])


def _bars(segments: np.ndarray, thickness: np.ndarray) -> np.ndarray:
    """Corners (m, 4, 2) of bars along plane segments. Drawn as areas, not lines, so that they scale with the grains."""
    along = segments[:, 1] - segments[:, 0]
    length = np.linalg.norm(along, axis=1, keepdims=True)
    # A bar seen end-on has no direction in the plane; a length of one keeps the division finite and the bar invisible.
    across = np.stack([-along[:, 1], along[:, 0]], axis=1) / np.where(length > 0, length, 1) * thickness[:, None] / 2
    return np.stack([segments[:, 0] + across, segments[:, 1] + across, segments[:, 1] - across, segments[:, 0] - across], axis=1)
