"""From ``[accuracy]`` to the settings of the finite-element part."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fegear.fem.settings import MeshSettings
    from fegear.scene.case.accuracy import AccuracyPart

#: Tolerance that the default settings are made for.
DEFAULT_TOLERANCE = 1e-3
#: Seconds of one gear with the default settings and its error estimate, on one core of a server, and how they grow with
#: 1 / edge length: 0.22, 0.7, 6.3 and 30 s were measured for edges of 1.6, 1, 0.5 and 0.3 times the default, much the
#: same from 12 to 100 teeth.
_SECONDS, _GROWTH = 0.7, 3.15
#: Root stress, the slowest of the results, converges with about the square of the edge length.
_ORDER = 2.0
_COARSEST, _FINEST = 1.6, 0.3


def mesh_settings(accuracy: AccuracyPart) -> MeshSettings:
    """Settings for a tolerance, with explicitly given ones taking their place.

    Parameters
    ----------
    accuracy : AccuracyPart

    Returns
    -------
    MeshSettings
        The default ones scaled by (tolerance / 1e-3)^(1/2), within the range in which the scaling has been tried.
    """
    from fegear.fem.settings import MeshSettings

    factor = (accuracy.tolerance / DEFAULT_TOLERANCE) ** (1.0 / _ORDER)
    factor = min(max(factor, _FINEST), _COARSEST)
    settings = MeshSettings().scaled(factor)
    # The pressure that loads the mesh leaves an error of its own, about in proportion to its width.
    settings = replace(settings, patch_half_width=settings.patch_half_width * min(factor, 1.0))
    given = {
        field.name: getattr(accuracy, field.name)
        for field in fields(MeshSettings)
        if getattr(accuracy, field.name) is not None
    }
    return replace(settings, **given)


def seconds_of_gear(settings: MeshSettings) -> float:
    """About how long the influence functions of one gear take, with their error estimate, from nothing [s]."""
    from fegear.fem.settings import MeshSettings

    usual = MeshSettings()
    finer = usual.root_edge_length / settings.root_edge_length * usual.flank_edge_length / settings.flank_edge_length
    return float(_SECONDS * (finer**0.5 * settings.order / usual.order) ** _GROWTH)
