"""The gears in mesh for the page: outlines and how they turn; what is shown on them follows in messages of its own."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.results.moving_pair import moving_pair

if TYPE_CHECKING:
    from fegear.case.reading import Scene


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return np.round(value, 9).tolist()  # to a nanometre
    return value


def gears_in_mesh(scene: Scene, name: str) -> dict[str, Any]:
    """Outlines of both gears and how they turn, for the page to draw.

    Parameters
    ----------
    scene : Scene
    name : str
        Of the pair.
    """
    return {key: _plain(value) for key, value in asdict(moving_pair(scene.pairs[name])).items()}
