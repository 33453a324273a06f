"""The gears in mesh for the page: outlines and how they turn, once; what is shown on them follows in its own messages."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.results.moving_pair import moving_pair

if TYPE_CHECKING:
    from fegear.geometry import GearPair


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return np.round(value, 9).tolist()  # to a nanometre
    return value


def gears_in_mesh(pair: GearPair) -> dict[str, Any]:
    """Outlines of both gears and how they turn, for the page to draw.

    Parameters
    ----------
    pair : GearPair
    """
    return {key: _plain(value) for key, value in asdict(moving_pair(pair)).items()}
