"""Coordinates in which long trains stay sparse: turns of one part of the train against the next, from halves to pairs.

Natural modes reach over the whole train, so that every shaft's damper couples all of them: the work of a time step
grows with the square of the number of bodies, with tangents with its cube. Here the train is cut in two at a link in
its middle, each half again, down to single bodies, and each cut gives one coordinate: the halves turning against each
other, each as a rigid body, their momenta in balance. These shapes are orthogonal by mass to each other and to the
rigid-body motion, and a link strains only those whose parts it lies in: log n of them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.dynamics.matrices import elements

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.dynamics.train import Train


def segment_shapes(train: Train) -> Array:
    """Rigid-body motion, then one shape for each cut, as columns in rotation angles with unit modal mass.

    Parameters
    ----------
    train : Train

    Returns
    -------
    ndarray, shape (size, size)
    """
    mass = train.inertia * train.ratios**2
    shapes = np.zeros((train.size, train.size))
    shapes[:, 0] = train.ratios / np.sqrt(mass.sum())
    waiting = [_spanning_tree(train)]
    column = 1
    while waiting:
        near = waiting.pop()
        if len(near) < 2:
            continue
        one, other = _halves(near)
        heavy, light = float(mass[one].sum()), float(mass[other].sum())
        # momenta balance: heavy a + light b = 0; unit modal mass: heavy a^2 + light b^2 = 1
        shapes[one, column] = train.ratios[one] * np.sqrt(light / (heavy * (heavy + light)))
        shapes[other, column] = -train.ratios[other] * np.sqrt(heavy / (light * (heavy + light)))
        column += 1
        waiting.extend({node: near[node] & part for node in part} for part in (set(one), set(other)))
    return shapes


def _spanning_tree(train: Train) -> dict[int, set[int]]:
    """Neighbours of each node in a tree of springs over the whole train."""
    all_near: list[list[int]] = [[] for _ in range(train.size)]
    for part in elements(train):
        if part.b >= 0 and part.stiffness > 0.0 and part.a != part.b:
            all_near[part.a].append(part.b)
            all_near[part.b].append(part.a)
    near: dict[int, set[int]] = {0: set()}
    reached = [0]
    for node in reached:
        for other in all_near[node]:
            if other not in near:
                near[other] = {node}
                near[node].add(other)
                reached.append(other)
    return near


def _halves(near: dict[int, set[int]]) -> tuple[list[int], list[int]]:
    """Two connected parts of a tree, as equal as one cut makes them."""
    root = next(iter(near))
    order, parent = [root], {root: root}
    for node in order:
        for other in near[node]:
            if other != parent[node]:
                parent[other] = node
                order.append(other)
    below = dict.fromkeys(order, 1)
    for node in reversed(order[1:]):
        below[parent[node]] += below[node]
    cut = min(order[1:], key=lambda node: abs(2 * below[node] - len(order)))
    inside = {cut}
    for node in order:
        if parent[node] in inside and node != root:
            inside.add(node)
    return sorted(inside), sorted(set(order) - inside)
