# SPDX-License-Identifier: GPL-2.0-or-later
"""A picture of the force network, as in Fig. 4 of Jean (1999): grains and blocks light, contact forces as dark bars.

Grains are spheres; blocks are polyhedra and boxes that can move. The thickness of a bar is proportional to the force. Between two grains it joins their
centres. Where a block takes part it lies on the line of action of the force and reaches from the contact point as far as each body is large; a contact
over a face has many points, and the bar goes through their mean, weighted by the normal force in each, so that the bars in a wall or an arch are tangents of its
line of thrust. Against anything else the bar ends at the contact point. Only what the scene holds is drawn, so the picture serves soft contacts as well.
"""

from __future__ import annotations

import itertools
import os
from dataclasses import dataclass
from typing import Any

import numpy as np
from yade import Box, O, Polyhedra, Sphere, Vector3

#: Axes of the picture (horizontal, vertical) for a view along the key.
VIEWS = {"x": (1, 2), "y": (0, 2), "z": (0, 1)}


#: Faces of a box, corners numbered as ``itertools.product`` makes them.
BOX_FACES = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]


@dataclass(frozen=True)
class Block:
    """A polyhedron or a box.

    :ivar centre: (3,) its mass centre [m]
    :ivar radius: that of the sphere of the same volume [m]
    :ivar faces: one (k, 3) array of corners for each face, in order around it [m]
    """

    centre: np.ndarray
    radius: float
    faces: list[np.ndarray]


@dataclass(frozen=True)
class ForceNetwork:
    """Bodies and contact forces of one step, as arrays.

    :ivar centres: (n, 3) centres of the spheres [m]
    :ivar radii: (n,) radii [m]
    :ivar blocks: polyhedra, and boxes that can move
    :ivar segments: (m, 2, 3) ends of the bars [m]
    :ivar forces: (m,) magnitude of the contact force, normal and tangential together [N]
    """

    centres: np.ndarray
    radii: np.ndarray
    blocks: list[Block]
    segments: np.ndarray
    forces: np.ndarray

    def sizes(self) -> np.ndarray:
        """Radii of all bodies, spheres first [m]."""
        return np.concatenate([self.radii, [block.radius for block in self.blocks]])


def _block(body: Any) -> Block | None:
    shape, state = body.shape, body.state
    if isinstance(shape, Polyhedra):
        corners, faces, volume = shape.v, shape.GetSurfaces(), shape.GetVolume()
    elif isinstance(shape, Box) and body.dynamic:
        corners = [Vector3(*corner) for corner in itertools.product(*((-e, e) for e in shape.extents))]
        faces, volume = BOX_FACES, 8 * float(np.prod(list(shape.extents)))
    else:
        return None
    placed = np.array([state.pos + state.ori * corner for corner in corners])
    return Block(np.array(state.pos), (3 * volume / (4 * np.pi)) ** (1 / 3), [placed[face] for face in faces])


def _contact_point(contact: Any) -> np.ndarray:
    """Where the force acts: of several points, their mean weighted by their normal forces."""
    forces = getattr(contact.phys, "pointForces", None)
    if not forces:
        return np.array(contact.geom.contactPoint)
    return np.average(np.array(contact.geom.points), axis=0, weights=[abs(force.dot(contact.geom.normal)) for force in forces])


def forceNetwork() -> ForceNetwork:
    """Collect bodies and loaded contacts of the scene ``O``. Periodic contacts are drawn from body 1 outward."""
    spheres = {body.id: body for body in O.bodies if isinstance(body.shape, Sphere)}
    blocks = {body.id: block for body in O.bodies if (block := _block(body))}
    centre = {number: np.array(body.state.pos) for number, body in spheres.items()}
    reach = {number: body.shape.radius for number, body in spheres.items()} | {number: block.radius for number, block in blocks.items()}
    segments, forces = [], []
    for contact in O.interactions:
        if not contact.isReal:
            continue
        force = np.array(contact.phys.normalForce + contact.phys.shearForce)
        magnitude = np.linalg.norm(force)
        if magnitude == 0:
            continue
        point = _contact_point(contact)
        if contact.id1 in blocks or contact.id2 in blocks:
            along = force / magnitude * (1 if contact.phys.normalForce.dot(contact.geom.normal) > 0 else -1)
            first, second = point - reach.get(contact.id1, 0.0) * along, point + reach.get(contact.id2, 0.0) * along
        else:
            first = centre.get(contact.id1, point)
            image = np.array(O.cell.hSize) @ np.array(contact.cellDist) if O.periodic else np.zeros(3)
            second = centre[contact.id2] + image if contact.id2 in centre else point
        segments.append((first, second))
        forces.append(magnitude)
    return ForceNetwork(
        centres=np.array([body.state.pos for body in spheres.values()]).reshape(-1, 3),
        radii=np.array([body.shape.radius for body in spheres.values()]),
        blocks=list(blocks.values()),
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
    :param slab: only grains and blocks whose centre lies between these two coordinates along ``view`` [m], and the forces that start or end
        in one of them; ``None`` (default) draws all. A slab of one or two diameters makes the chains of a deep packing visible.
    :param thickest: thickness of the bar of the largest force, in mean radii [-] (of a block, that of the sphere of its volume), > 0; the others in proportion. The default keeps the
        chains of a whole packing apart; for a thin slab 0.5 to 0.8 reads better.
    :param title: text above the picture; ``None`` for none.
    :param width: width of the picture [inch], > 0; the height follows from the packing.
    :param dpi: dots per inch of a pixel picture.
    :returns: what was drawn.
    :raises ValueError: unknown ``view``, no sphere or block to draw, or ``thickest`` or ``width`` not positive.
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
    if len(network.sizes()) == 0:
        raise ValueError("no sphere or block to draw" + ("" if slab is None else f" in the slab {slab} along {view}"))

    plane = list(VIEWS[view])
    axis = "xyz".index(view)
    centres = network.centres[:, plane]
    # Bodies far from the eye first; the eye is at the low end of the y axis and at the high end of x and z.
    towards = -1 if view == "y" else 1
    order = np.argsort(towards * network.centres[:, axis])
    faces = _faces_in_sight(network.blocks, axis, towards)
    ends = np.concatenate([centres - network.radii[:, None], centres + network.radii[:, None], *(face[:, plane] for face in faces)])
    low, high = ends.min(axis=0), ends.max(axis=0)
    radius = network.sizes().mean()
    margin = 0.5 * radius

    size = high - low + 2 * margin
    figure = Figure(figsize=(width, width * size[1] / size[0] + (0.4 if title else 0.0)), dpi=dpi)
    canvas = FigureCanvasAgg(figure)
    axes = figure.add_axes([0, 0, 1, width * size[1] / size[0] / figure.get_figheight()])
    axes.set_xlim(low[0] - margin, high[0] + margin)
    axes.set_ylim(low[1] - margin, high[1] + margin)
    axes.set_aspect("equal")
    axes.axis("off")
    diameters = 2 * network.radii[order]
    light = {"facecolors": "#efe9dc", "edgecolors": "#b9ac8d", "linewidths": 0.5}
    axes.add_collection(PolyCollection([face[:, plane] for face in faces], **light))
    if len(order):
        axes.add_collection(EllipseCollection(diameters, diameters, np.zeros(len(order)), units="xy", offsets=centres[order], transOffset=axes.transData, **light))
    if len(network.forces):
        # Weak forces first, so that the strong chains lie on top.
        ascending = np.argsort(network.forces)
        thickness = thickest * radius * network.forces[ascending] / network.forces.max()
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
    blocks = [block for block in network.blocks if low <= block.centre[axis] <= high]
    ends = network.segments[:, :, axis]
    bars = ((ends >= low) & (ends <= high)).any(axis=1)
    return ForceNetwork(network.centres[grains], network.radii[grains], blocks, network.segments[bars], network.forces[bars])


def _faces_in_sight(blocks: list[Block], axis: int, towards: int) -> list[np.ndarray]:
    """Faces that look at the eye, those of blocks behind others first: of a convex body they hide all that is hidden."""
    seen = []
    for block in sorted(blocks, key=lambda block: towards * block.centre[axis]):
        for face in block.faces:
            middle = face.mean(axis=0)
            normal = np.cross(face - middle, np.roll(face, -1, axis=0) - middle).sum(axis=0)
            outward = normal if normal @ (middle - block.centre) > 0 else -normal
            if towards * outward[axis] > 0:
                seen.append(face)
    return seen


def _bars(segments: np.ndarray, thickness: np.ndarray) -> np.ndarray:
    """Corners (m, 4, 2) of bars along plane segments. Drawn as areas, not lines, so that they scale with the grains."""
    along = segments[:, 1] - segments[:, 0]
    length = np.linalg.norm(along, axis=1, keepdims=True)
    # A bar seen end-on has no direction in the plane; a length of one keeps the division finite and the bar invisible.
    across = np.stack([-along[:, 1], along[:, 0]], axis=1) / np.where(length > 0, length, 1) * thickness[:, None] / 2
    return np.stack([segments[:, 0] + across, segments[:, 1] + across, segments[:, 1] - across, segments[:, 0] - across], axis=1)
