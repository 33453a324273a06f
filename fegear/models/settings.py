"""From ``[accuracy]`` to the settings of the finite-element part."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fegear.case.accuracy import AccuracyPart
    from fegear.fem.settings import MeshSettings

#: Processor seconds of one gear with the default settings and its error estimate, and how they grow with 1 / edge
#: length and with the order: one core of a server, 20 to 200 teeth, edges of 4 to 1 times the default.
_SECONDS, _GROWTH, _ORDER_GROWTH = 0.55, 1.3, 2.2


def settings_for(tolerance: float) -> MeshSettings:
    """Return the settings with which a solution for a relative tolerance starts.

    They are the cheapest of the levels of `fegear.fem.settings_at` whose true errors (c_0, c_1 over c_0, largest root
    tension and compression, over the whole flank) usually meet the tolerance; docs/numerics.md has the measurements.

    Parameters
    ----------
    tolerance : float

    Returns
    -------
    MeshSettings
    """
    from fegear.fem import level_for, settings_at

    return settings_at(level_for(tolerance))


def given_settings(accuracy: AccuracyPart) -> dict[str, Any]:
    """Settings that the case gives itself; with any of them nothing is refined."""
    from fegear.fem.settings import MeshSettings

    found = {field.name: getattr(accuracy, field.name) for field in fields(MeshSettings)}
    return {name: value for name, value in found.items() if value is not None}


def mesh_settings(accuracy: AccuracyPart) -> MeshSettings:
    """Settings for a tolerance, with explicitly given ones taking their place."""
    given = given_settings(accuracy)
    settings = settings_for(accuracy.tolerance)
    return replace(settings, **given) if given else settings


def seconds_of_gear(settings: MeshSettings) -> float:
    """About how many seconds the influence functions of one gear take, with their error estimate, from nothing."""
    from fegear.fem.settings import MeshSettings

    usual = MeshSettings()
    finer = usual.root_edge_length / settings.root_edge_length * usual.flank_edge_length / settings.flank_edge_length
    return float(_SECONDS * finer ** (0.5 * _GROWTH) * (settings.order / usual.order) ** _ORDER_GROWTH)
