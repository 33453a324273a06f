"""How many functions along the face each node of the section needs: short waves die out away from the loaded flank."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.fem.solid.dissection import Unknowns, unknowns
from fegear.fem.solid.section import upward

if TYPE_CHECKING:
    from fegear.arrays import Array, Index
    from fegear.fem.solid.face import FaceFunctions
    from fegear.fem.solid.section import Section
    from fegear.fem.solid.settings import SolidSettings


def solid_unknowns(
    section: Section,
    face: FaceFunctions,
    settings: SolidSettings,
    held: tuple[float, float] | None = None,
    *,
    plane_strain: bool = False,
) -> Unknowns:
    """Unknowns of the solid sector, its bore held.

    Parameters
    ----------
    section : Section
    face : FaceFunctions
    settings : SolidSettings
    held : (float, float), optional
        Part of the width on which the bore is held [modules]; by default all of it.
    plane_strain : bool
        Nothing moves along the axis.

    Returns
    -------
    Unknowns
    """
    counts = function_counts(section, face, settings)
    has = np.arange(face.count) < np.repeat(counts, 3)[:, None]
    bore = 3 * section.nodes_of("bore")[:, None] + np.arange(3)
    free = np.zeros(face.count, dtype=bool)
    if held is not None:
        free[face.vanishing_on(*held)] = True
    has[bore.ravel()] &= free
    if plane_strain:
        has[2::3] = False
    return unknowns(has)


def function_counts(section: Section, face: FaceFunctions, settings: SolidSettings) -> Index:
    """Functions along the face of each node, shape (N,).

    What varies along the face with a wavelength l decays within about l from where it is loaded. A node at a distance
    d from the flank has all functions of degree below `wave_reach` times (width / 2 d), and a few more.
    """
    distance = np.maximum(flank_distance(section), 1e-9 * face.width)
    ends = len(face.breaks)
    wanted = settings.wave_reach * 0.5 * face.width / distance + settings.fewest_waves * (ends - 1)
    counts = np.minimum(np.ceil(np.minimum(wanted, face.count)).astype(np.int64), face.count)
    # Sides meet those of the neighbours: both have the functions of the one that is nearer to its flank.
    more = np.maximum(counts[section.side_a], counts[section.side_b])
    counts[section.side_a] = counts[section.side_b] = more
    return np.asarray(counts)


def flank_distance(section: Section) -> Array:
    """Distance of every node from the loaded flank, shape (N,) [modules]."""
    line, _ = upward(section, "flank")
    run = np.concatenate([line[:-1].T.ravel(), line[-1:, -1]])
    start, end = section.places[:, run[:-1], None], section.places[:, run[1:], None]
    chord = end - start
    way = section.places[:, None, :] - start
    share = np.clip((way * chord).sum(axis=0) / (chord * chord).sum(axis=0), 0.0, 1.0)
    return np.asarray(np.hypot(*(way - share * chord)).min(axis=0))
