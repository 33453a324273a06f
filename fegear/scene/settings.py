"""From ``[accuracy]`` to the settings of the finite-element part."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fegear.fem.settings import MeshSettings
    from fegear.scene.case.accuracy import AccuracyPart

#: Tolerance that the default settings are made for.
DEFAULT_TOLERANCE = 1e-3
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
