"""The outline of a rack as points, to a chord tolerance, from the exact curves."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.geometry.outline import along

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.base.arrays import Array
    from fegear.geometry.curves import Drawn
    from fegear.geometry.toothed_rack import Rack


def rack_outline(
    rack: Rack, tolerance: float = 1e-4, *, first: int = 0, count: int | None = None,
    pieces: Sequence[Drawn] | None = None,
) -> Array:  # fmt: skip
    """The closed outline of a rack, or of some of its teeth, with the body down to its back [m], shape (2, N).

    Tooth `first` of those that are drawn stands at x = 0, the reference line at y = 0; counter-clockwise from the left
    end of the back, the first point repeated.

    Parameters
    ----------
    rack : Rack
    tolerance : float
        How far chords may lie off the curves [modules].
    first, count : int
        Which of the drawn teeth is at x = 0, and how many are drawn; by default all.
    pieces : sequence of Drawn, optional
        Half of a tooth, relieved; by default as generated.
    """
    count = rack.teeth if count is None else count
    lines = [along(curve, tolerance) for curve in pieces or rack.tooth.outline.values()]
    right = np.hstack([lines[0], *[line[:, 1:] for line in lines[1:]]])
    left = (right * np.array([[-1.0], [1.0]]))[:, ::-1]
    tooth = np.hstack([right, left[:, 1:]]) * rack.module  # from the right space over the tip to the left one
    teeth = [tooth + np.array([[(k - first) * rack.pitch], [0.0]]) for k in range(count)[::-1]]
    ends = (count - 1 - first + 0.5) * rack.pitch, -(first + 0.5) * rack.pitch
    back = -rack.reference_height
    above = np.hstack([teeth[0], *[one[:, 1:] for one in teeth[1:]]])
    corner = np.array([[ends[1]], [back]])
    return np.hstack([corner, np.array([[ends[0]], [back]]), above, corner])
