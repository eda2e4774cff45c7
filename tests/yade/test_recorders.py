# SPDX-License-Identifier: GPL-2.0-or-later
"""YADE's recorders and averages read the contact forces: each against sums over the contacts that are made here."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest
from yade import ForceRecorder, O, PyRunner, TorqueRecorder, Vector3, VTKRecorder, utils

import cell_cases as cases
from blocks import block
from contactdynamics import report, stress
from scenes import G, ball_mass, box, cd, dumbbell, equip, floor, grain, material, state, steps, vec
from test_detection import facet

H = 1e-3


def heap() -> None:
    """Balls, a clump, a box, facets and a wall, pressed together and sliding: forces in all directions."""
    material(friction=0.4)
    box((0, 0, -1), (6, 6, 1))
    facet(((-6, -6, 6), (-6, 6, 6), (-2.9, 0, -0.5)))
    facet(((-6, -6, 6), (-2.9, 0, -0.5), (-2.8, -6, -0.5)))
    for place, axis in ((2.6, 0), (-4.5, 0), (-2.6, 1), (2.6, 1)):
        O.bodies.append(utils.wall(place, axis, material=O.materials[0]))
    generator = np.random.default_rng(2)
    for k in range(12):
        place = 1.9 * np.array([k % 2 - 0.7, k // 2 % 2 - 0.5, 0.7 + k // 4])
        grain(place + generator.uniform(-0.1, 0.1, 3), radius=generator.uniform(0.7, 0.9), velocity=generator.uniform(-1, 1, 3))
    dumbbell([(0, 0, 6.4), (1.3, 0.2, 6.9)], radius=0.8)
    equip(5e-3, tolerance=1e-10, maxIterations=20000)
    steps(300)
    assert len([i for i in O.interactions if i.phys.normalForce.norm() > 0]) > 15


def pushes():
    """(id1, id2, contact point, force on body 2) of each real interaction, from the attributes of YADE."""
    return [(i.id1, i.id2, vec(i.geom.contactPoint), vec(i.phys.normalForce) + vec(i.phys.shearForce)) for i in O.interactions if i.isReal]


def total(ids) -> np.ndarray:
    return sum((f * ((two in ids) - (one in ids)) for one, two, _, f in pushes()), np.zeros(3))


def close(one, other, scale: float) -> bool:
    """Sums of some dozens of terms, read through text at most."""
    return np.abs(np.array(one, dtype=float) - np.array(other, dtype=float)).max() <= 1e-11 * scale


def moment(ids, point) -> np.ndarray:
    """Moment of all contact forces on bodies about a point."""
    return sum((np.cross(p - point, f * ((two in ids) - (one in ids))) for one, two, p, f in pushes()), np.zeros(3))


def matrix(m) -> np.ndarray:
    return np.array([[m[i, j] for j in range(3)] for i in range(3)])


WEIGHT = 12 * ball_mass(0.8) * G


def test_forces_of_the_scene() -> None:
    """O.forces, sumForces, sumTorques, sumFacetNormalForces and forcesOnPlane."""
    heap()
    for b in O.bodies:
        if b.isClump:
            expected = total(b.shape.members)
        else:
            expected = total([b.id])
        assert close(vec(O.forces.f(b.id)), expected, WEIGHT), b.id
    ids = [1, 2]
    assert close(utils.sumForces(ids, Vector3(1, 2, 3)), total(ids) @ [1, 2, 3], 4 * WEIGHT)
    assert close(utils.sumTorques(ids, Vector3(0, 1, 0), Vector3(1, 2, 3)), moment(ids, [1, 2, 3])[1], 20 * WEIGHT)
    normal_force = sum(total([k]) @ vec(O.bodies[k].state.ori * O.bodies[k].shape.normal) for k in ids)
    assert close(utils.sumFacetNormalForces(ids), normal_force, WEIGHT)
    # A horizontal plane at 1: contacts whose bodies have their positions on both sides of it.
    crossing = np.zeros(3)
    for one, two, _, f in pushes():
        above = [O.bodies[k].state.pos[2] > 1 for k in (one, two)]
        if above[0] != above[1]:
            crossing += f if above[1] else -f
    assert crossing[2] > 0.1 * WEIGHT
    # What the bodies on the side of the normal get from the others.
    assert close(utils.forcesOnPlane(Vector3(0, 0, 1), Vector3(0, 0, 1)), crossing, WEIGHT)
    assert close(utils.forcesOnPlane(Vector3(0, 0, 1), Vector3(0, 0, -1)), -crossing, WEIGHT)


def test_recorded_force_and_torque(tmp_path: Path) -> None:
    """ForceRecorder and TorqueRecorder behind the integrator write the sums of the step, to the digits of the file."""
    heap()
    file, other, ids, on_axis = tmp_path / "force", tmp_path / "torque", [0, 3], 2
    O.engines = O.engines + [
        ForceRecorder(ids=ids, file=str(file), iterPeriod=1),
        TorqueRecorder(ids=[on_axis], rotationAxis=(0, 0, 1), zeroPoint=state(on_axis).pos, file=str(other), iterPeriod=1),
    ]
    O.step()
    line = [float(x) for x in file.read_text().splitlines()[-1].split()]
    # Text with six digits.
    assert np.abs(np.array(line[1:4]) - total(ids)).max() <= 1e-5 * WEIGHT
    line = [float(x) for x in other.read_text().splitlines()[-1].split()]
    assert abs(line[1] - moment([on_axis], vec(state(on_axis).pos))[2]) <= 2e-5 * WEIGHT
    # YADE's recorder reverses the arms of bodies that are not on its axis; ours does not.
    point = np.array([1.0, 1.0, 0.0])
    assert close(report.supportTorque([0, 1, 2], point), moment([0, 1, 2], point), 20 * WEIGHT)


def test_stress_of_the_packing_and_of_each_body() -> None:
    """getStress, bodyStressTensors (Love-Weber), fabricTensor and our moment tensor."""
    heap()
    centre = {b.id: vec(O.bodies[b.clumpId if b.isClumpMember else b.id].state.pos) for b in O.bodies}
    expected = sum(np.outer(f, centre[one] - centre[two]) for one, two, _, f in pushes()) / 7.0
    assert close(matrix(utils.getStress(7.0)), expected, 10 * WEIGHT)

    moments = stress.momentTensors()
    each = utils.bodyStressTensors()
    for b in O.bodies:
        own = sum(np.outer(p - vec(b.state.pos), f * ((two == b.id) - (one == b.id))) for one, two, p, f in pushes())
        if type(b.shape).__name__ == "Sphere":
            volume = 4 / 3 * math.pi * b.shape.radius**3
            assert close(matrix(each[b.id]) * volume, own.T, 10 * WEIGHT), b.id
        if not b.isClumpMember and not b.isClump:
            assert close(moments.get(b.id, np.zeros((3, 3))), own, 10 * WEIGHT), b.id
        if b.isClump:
            members = b.shape.members
            own = sum(np.outer(p - vec(b.state.pos), f * ((two in members) - (one in members))) for one, two, p, f in pushes())
            assert np.abs(own).max() > 0.1 * ball_mass(0.8) * G
            assert close(moments[b.id], own, 10 * WEIGHT)
            assert close(stress.ofBody(b.id, 2.0), (own + own.T) / 4, 10 * WEIGHT)

    normals = np.array([vec(i.geom.normal) for i in O.interactions if i.isReal])
    assert close(matrix(utils.fabricTensor()[0]), normals.T @ normals / len(normals), 1)
    loaded = np.array([vec(i.geom.normal) for i in O.interactions if i.isReal and i.phys.normalForce.norm() > 0])
    assert 0 < len(loaded) < len(normals)
    assert close(report.fabric(), loaded.T @ loaded / len(loaded), 1)


def test_unbalanced_force_of_loaded_contacts() -> None:
    """Mean of |f + m g| over the free bodies, clumps as one, over the mean force of the contacts that carry one."""
    heap()
    on = {b.id: np.zeros(3) for b in O.bodies if b.dynamic and not b.isClumpMember}
    sizes = []
    for one, two, _, f in pushes():
        for number, sign in ((one, -1), (two, 1)):
            b = O.bodies[number]
            number = b.clumpId if b.isClumpMember else number
            if number in on:
                on[number] += sign * f
        if np.linalg.norm(f) > 0:
            sizes.append(np.linalg.norm(f))
    resultants = [np.linalg.norm(f + state(n).mass * np.array([0, 0, -G])) for n, f in on.items()]
    assert report.unbalancedForce() == pytest.approx(np.mean(resultants) / np.mean(sizes), rel=1e-9)
    assert report.unbalancedForce() < 0.99 * utils.unbalancedForce()


def test_nothing_is_balanced_without_a_contact() -> None:
    material()
    grain((0, 0, 5))
    equip(H)
    steps(1)
    assert report.unbalancedForce() == math.inf


def test_no_fabric_without_a_contact() -> None:
    material(friction=0)
    floor()
    grain((0, 0, 5))
    equip(H)
    steps(1)
    with pytest.raises(ValueError, match="no contact"):
        report.fabric()


def test_moment_tensor_of_a_loaded_ball() -> None:
    """A ball of weight w under a load q between floor and lid: M = -(q + (q + w)) r on the axis, nothing else; stress is that over V."""
    material(friction=0)
    floor()
    ball = grain((0, 0, 1))
    lid = grain((0, 0, 3))
    state(lid).blockedDOFs = "xyXYZ"
    equip(H, tolerance=1e-12, maxIterations=10000)
    steps(3)
    w = state(ball).mass * G
    tensor = stress.momentTensors()[ball]
    assert tensor == pytest.approx(np.diag([0, 0, -3 * w]), rel=1e-9, abs=1e-9 * w)
    assert stress.ofBody(ball, 4 / 3 * math.pi)[2, 2] == pytest.approx(-3 * w / (4 / 3 * math.pi), rel=1e-9)
    with pytest.raises(ValueError, match="volume"):
        stress.ofBody(ball, 0)
    with pytest.raises(ValueError, match="17"):
        stress.ofBody(17, 1)


def test_moment_tensor_is_symmetric_in_equilibrium() -> None:
    """Balance of moments: a ball at rest on three that touch each other on a floor, held by friction."""
    material(friction=0.6)
    floor()
    side = 2 / math.sqrt(3)
    base = [grain((side * math.cos(t), side * math.sin(t), 1)) for t in (0.1, 0.1 + 2 * math.pi / 3, 0.1 + 4 * math.pi / 3)]
    top = grain((0, 0, 1 + 2 * math.sqrt(2 / 3)))
    equip(H, tolerance=1e-12, maxIterations=100000)
    steps(20)
    moments = stress.momentTensors()
    for b in [*base, top]:
        assert np.abs(moments[b] - moments[b].T).max() <= 1e-8 * np.abs(moments[b]).max()
    # The three forces on the top ball have w / 3 each along the vertical, at a depth of sqrt(2/3) below its centre.
    w = state(top).mass * G
    assert moments[top][2, 2] == pytest.approx(-w * math.sqrt(2 / 3), rel=1e-8)


def test_blocks_that_touch_at_many_points(tmp_path: Path) -> None:
    """Two cubes on a floor, the upper one shifted and pulled: forces and places of the resultants from equilibrium by hand."""
    material(friction=0.6)
    floor(10)
    lower, upper = (block((x, 0.1, z)) for x, z in ((0, 0.5), (0.2, 1.5)))
    w = state(lower).mass * G
    pull = 0.3 * w
    O.forces.setPermF(upper, Vector3(pull, 0, 0))
    equip(H, tolerance=1e-12, maxIterations=20000)
    file = tmp_path / "force"
    O.engines = O.engines + [ForceRecorder(ids=[0], file=str(file), iterPeriod=1)]
    steps(40)
    line = [float(x) for x in file.read_text().splitlines()[-1].split()]
    assert line[1:4] == pytest.approx([pull, 0, -2 * w], rel=1e-5, abs=1e-5 * w)
    # On the upper cube, from its centre: weight and pull act there, so the resultant below points to it. On the lower one likewise with the moment.
    arm_upper, on_upper = np.array([0.5 * pull / w, 0, -0.5]), np.array([-pull, 0, w])
    arm_above, arm_below = arm_upper + [0.2, 0, 1], np.array([(0.2 * w + 1.5 * pull) / (2 * w), 0, -0.5])
    moment_above = np.cross(arm_above, -on_upper)
    assert np.cross(arm_below, [-pull, 0, 2 * w]) + moment_above == pytest.approx(np.zeros(3), abs=1e-12 * w)
    moments = stress.momentTensors()
    expected = {upper: np.outer(arm_upper, on_upper), lower: np.outer(arm_above, -on_upper) + np.outer(arm_below, [-pull, 0, 2 * w])}
    for number, tensor in expected.items():
        # How friction is shared out among the points of a face is not determined, and with it the components within the face.
        assert moments[number][2] == pytest.approx(tensor[2], abs=1e-8 * w), number
        assert moments[number][:, 2] == pytest.approx(tensor[:, 2], abs=1e-8 * w), number
    for i in O.interactions:
        if i.isReal and lower in (i.id1, i.id2) and upper in (i.id1, i.id2):
            assert vec(i.geom.contactPoint) - vec(state(upper).pos) == pytest.approx(arm_upper, abs=1e-8)
    # Love and Weber over the packing: force on one body times the vector to it from the other.
    total_moment = np.outer(on_upper, [-0.2, 0, -1]) + np.outer([-pull, 0, 2 * w], vec(state(0).pos - state(lower).pos))
    assert matrix(utils.getStress(3.0)) == pytest.approx(total_moment / 3, abs=1e-8 * w)
    assert matrix(utils.fabricTensor(extrema=[Vector3(-9, -9, -9), Vector3(9, 9, 9)])[0]) == pytest.approx(np.diag([0, 0, 1]), abs=1e-12)
    assert vec(utils.forcesOnPlane(Vector3(0, 0, 1), Vector3(0, 0, 1))) == pytest.approx(on_upper, abs=1e-8 * w)
    assert np.sort(vtk_arrays(record(tmp_path, "intr")["intr"])["forceN"].ravel()) == pytest.approx([w, 2 * w], rel=1e-6)


def test_averages_of_a_periodic_cell() -> None:
    """Stress and fabric of a sheared cell with clumps, summed over contacts with the vectors across periods."""
    cases.dense(tolerance=1e-8)
    cd().repairRate = 0  # it moves bodies and strains the cell behind the solve
    engines = list(O.engines)
    engines[-1:-1] = [PyRunner(command="import test_recorders as t; t.look_at_cell()", iterPeriod=1, initRun=True)]
    O.engines = engines
    steps(60)
    found, by_hand, across = seen_in_cell[-1]
    assert across > 10
    scale = np.abs(by_hand["stress"]).max()
    for name, value in by_hand.items():
        assert np.abs(found[name] - value).max() <= 1e-11 * (scale if "stress" in name else 1), name


seen_in_cell: list = []


def look_at_cell() -> None:
    """YADE's averages and ours, at the positions that the contact forces belong to."""
    centre = {b.id: vec(O.bodies[b.clumpId if b.isClumpMember else b.id].state.pos) for b in O.bodies}
    total, fabric, number, across = np.zeros((3, 3)), np.zeros((3, 3)), 0, 0
    for i in O.interactions:
        if not i.isReal:
            continue
        f, n, shift = vec(i.phys.normalForce) + vec(i.phys.shearForce), vec(i.geom.normal), vec(O.cell.hSize * Vector3(*i.cellDist))
        total += np.outer(f, centre[i.id1] - centre[i.id2] - shift) / O.cell.volume
        fabric += np.outer(n, n)
        number += 1
        across += bool(shift.any() and f.any())
    found = {"stress": matrix(utils.getStress()), "fabric": matrix(utils.fabricTensor()[0])}
    seen_in_cell.append((found, {"stress": total, "fabric": fabric / number}, across))


def record(folder: Path, *recorders: str) -> dict[str, Path]:
    """Files in text form by what they hold, of spheres, facets and interactions as far as asked for.

    As blocks of one set, because YADE 2023.02a crashes at random when it writes interactions to single files outside an MPI run.
    """
    VTKRecorder(fileName=str(folder / "x-"), recorders=list(recorders), ascii=True, compress=False, skipFacetIntr=False, multiblock=True)()
    blocks = [name for name in ("spheres", "facets", "intr") if name in recorders]
    return {name: next(folder.glob(f"x-*/x-*_{k}.vt?")) for k, name in enumerate(blocks)}


def vtk_arrays(path: Path) -> dict[str, np.ndarray]:
    """Data arrays of a VTK XML file in text form, by name."""
    found = {}
    for attributes, body in re.findall(r"<DataArray([^>]*)>([^<]*)", path.read_text()):
        name = re.search(r'Name="([^"]*)"', attributes)[1]
        width = re.search(r'NumberOfComponents="(\d+)"', attributes)
        found[name] = np.array(body.split(), dtype=float).reshape(-1, int(width[1]) if width else 1)
    return found


def test_files_for_paraview(tmp_path: Path) -> None:
    """VTKRecorder: forces of contacts, forces on bodies, stresses; single precision."""
    heap()
    files = record(tmp_path, "spheres", "facets", "boxes", "intr", "force", "stress", "bstresses", "id")
    real = [i for i in O.interactions if i.isReal and type(O.bodies[i.id1].shape).__name__ == "Sphere"]
    arrays = vtk_arrays(files["intr"])
    every = [i for i in O.interactions if i.isReal]
    largest = max(i.phys.normalForce.norm() for i in every)
    normal = sorted(i.phys.normalForce.dot(i.geom.normal) for i in every)
    assert len(arrays["forceN"]) == len(every) and len(real) > 3
    assert np.abs(np.sort(arrays["forceN"].ravel()) - normal).max() <= 1e-6 * largest
    shear = np.array(sorted(i.phys.shearForce.norm() for i in every))
    assert np.abs(np.sort(np.linalg.norm(arrays["absForceT"], axis=1)) - shear).max() <= 1e-6 * largest

    arrays = vtk_arrays(files["spheres"])
    each = utils.bodyStressTensors()
    for row, number in enumerate(arrays["id"].ravel().astype(int)):
        assert np.abs(arrays["forceVec"][row] - total([number])).max() <= 1e-6 * WEIGHT
        tensor = matrix(each[number])
        # The tensor of a ball that is not in equilibrium is not symmetric; YADE's decomposition reads its lower triangle.
        eigenvalues = np.linalg.eigvalsh(tensor, "L")
        recorded = sorted(float(arrays[name][row, 0]) for name in ("sigI", "sigII", "sigIII"))
        assert np.abs(np.array(recorded) - eigenvalues).max() <= 1e-5 * np.abs(eigenvalues).max() + 1e-6
    arrays = vtk_arrays(files["facets"])
    recorded = sorted(map(tuple, arrays["forceVec"]))
    assert np.abs(np.array(recorded) - np.array(sorted(map(tuple, (total([1]), total([2])))))).max() <= 1e-6 * WEIGHT
