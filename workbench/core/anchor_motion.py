"""Where anchors go next: groups move along the screw motion of their best rigid fit, the rest straight."""

from __future__ import annotations

import numpy as np
import scipy

from workbench.core.arrays import Floats, Integers

LARGEST_TURN = 0.3
"""Radians that a group turns in one step: straight paths of a larger turn would shrink the group visibly."""
HALF_TURN = 1e-6
"""Radians from half a turn within which both ways round count as equally long."""


def anchor_groups(simplices: Integers, anchored: Integers, numbers: Integers | None = None) -> list[Integers]:
    """Rows of `anchored` (k,) by group: anchors joined by edges of the mesh move together.

    `numbers` : (k,) int64     those of one number move together, whatever the mesh says; -1 leaves it to the mesh
    """
    if not len(anchored):
        return []
    if numbers is None:
        numbers = np.full(len(anchored), -1, dtype=np.int64)
    row = np.full(int(simplices.max()) + 1, -1, dtype=np.int64)
    row[anchored] = np.arange(len(anchored))
    corners = row[simplices]
    width = simplices.shape[1]
    heads, tails = [], []
    for a in range(width):
        for b in range(a + 1, width):
            both = (corners[:, a] >= 0) & (corners[:, b] >= 0)
            heads.append(corners[both, a])
            tails.append(corners[both, b])
    numbered = np.argsort(numbers, kind="stable")[np.count_nonzero(numbers < 0) :]
    heads.append(numbered[:-1])
    tails.append(numbered[1:])
    i, j = np.concatenate(heads), np.concatenate(tails)
    together = numbers[i] == numbers[j]
    i, j = i[together], j[together]
    graph = scipy.sparse.coo_matrix((np.ones(len(i)), (i, j)), shape=(len(anchored), len(anchored)))
    count, labels = scipy.sparse.csgraph.connected_components(graph, directed=False)
    order = np.argsort(labels, kind="stable")
    return np.split(order, np.searchsorted(labels[order], np.arange(1, count)))


def next_displacement(current: Floats, targets: Floats, groups: list[Integers]) -> Floats:
    """Displacement of the anchors to their next way point.

    Parameters
    ----------
    current, targets : (k, d) float64
    groups : list of (j,) int64      rows that move together

    Returns
    -------
    (k, d) float64      targets - current, but for groups that turn by more than `LARGEST_TURN`
    """
    displacement = targets - current
    for rows in groups:
        if len(rows) > current.shape[1] - 1 and len(rows) > 1:
            displacement[rows] = _turned(current[rows], targets[rows]) - current[rows]
    return displacement


def _turned(current: Floats, targets: Floats) -> Floats:
    rotation = _best_rotation(current, targets)
    vector = rotation.as_rotvec()
    angle = float(np.linalg.norm(vector))
    if angle <= LARGEST_TURN:
        return targets
    if angle > np.pi - HALF_TURN and vector[np.abs(vector) > HALF_TURN][0] < 0.0:
        vector = -vector  # rounding would choose the way round: always the axis whose first coordinate is positive
    part = LARGEST_TURN / angle
    d = current.shape[1]
    p, q = _in_space(current), _in_space(targets)
    translation = q.mean(axis=0) - rotation.apply(p.mean(axis=0))
    # What the rigid fit leaves over (a stretch, say) is walked in the body's own frame.
    body = p + part * (rotation.inv().apply(q - translation) - p)
    turn = scipy.spatial.transform.Rotation.from_rotvec(part * vector)
    slide = _screw_matrix(part * vector) @ np.linalg.solve(_screw_matrix(vector), translation) * part
    result: Floats = (turn.apply(body) + slide)[:, :d]
    return result


def twist_between(current: Floats, targets: Floats) -> Floats:
    """(6,) rotation vector and velocity whose exponential is the best rigid fit from `current` (j, d) to `targets` (j, d).

    Too few points to tell a rotation have none.
    """
    shift = _in_space(targets - current).mean(axis=0)
    if len(current) <= max(1, current.shape[1] - 1):
        return np.concatenate([np.zeros(3), shift])
    vector = _best_rotation(current, targets).as_rotvec()
    centre = _in_space(current).mean(axis=0)
    translation = centre + shift - scipy.spatial.transform.Rotation.from_rotvec(vector).apply(centre)
    return np.concatenate([vector, np.linalg.solve(_screw_matrix(vector), translation)])


def _best_rotation(current: Floats, targets: Floats) -> scipy.spatial.transform.Rotation:
    """Rotation of the least-squares rigid fit (Kabsch)."""
    p, q = _in_space(current - current.mean(axis=0)), _in_space(targets - targets.mean(axis=0))
    if current.shape[1] == 2:
        covariance = p.T @ q
        angle = np.arctan2(covariance[0, 1] - covariance[1, 0], covariance[0, 0] + covariance[1, 1])
        return scipy.spatial.transform.Rotation.from_rotvec([0.0, 0.0, float(angle)])
    u, _, vt = np.linalg.svd(p.T @ q)
    sign = np.sign(np.linalg.det(u @ vt)) or 1.0
    return scipy.spatial.transform.Rotation.from_matrix((u @ np.diag([1.0, 1.0, sign]) @ vt).T)


def _screw_matrix(vector: Floats) -> Floats:
    """V with exp of the twist (vector, v) translating by V v (Murray, Li, Sastry 1994, section 2.3)."""
    angle = float(np.linalg.norm(vector))
    k = np.array([[0, -vector[2], vector[1]], [vector[2], 0, -vector[0]], [-vector[1], vector[0], 0]])
    if angle < 1e-9:
        return np.eye(3) + 0.5 * k
    return np.eye(3) + (1 - np.cos(angle)) / angle**2 * k + (angle - np.sin(angle)) / angle**3 * (k @ k)


def _in_space(points: Floats) -> Floats:
    return points if points.shape[1] == 3 else np.pad(points, ((0, 0), (0, 1)))
