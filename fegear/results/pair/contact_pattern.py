"""Stage ``contact-pattern``: where marking compound prints under the loads of a pair with a width."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.error_over_pitch import ErrorOverPitch
from fegear.engine.citation import Citation, citing
from fegear.engine.declared import column_of
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import HeatMap, few
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Upstream, Work
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.results import forecasts
from fegear.results.pair.load_distribution import flank_stage
from fegear.results.pair.loaded_flanks import loaded_flanks

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.contact.wide.loaded_pair import LoadedWidePair
    from fegear.contact.wide.pair_history import ContactPattern

#: Loads that are drawn.
_DRAWN = 4
#: Of the nominal load: that of a pair turned by hand, beside the loads of the case.
_LIGHT = 0.01


@dataclass(frozen=True)
class ContactPatternInputs:
    """What is read of the case besides the loaded flanks: the thickness of the coat [m]."""

    coat: float = field(compare=False)
    name: str = field(compare=False)


@dataclass(frozen=True)
class ContactPatternData:
    """What the stage hands to table and picture.

    Parameters
    ----------
    loaded : LoadedWidePair
    loads : tuple of float
        A light one, and those of the case [N].
    pattern : ContactPattern
        Under each of them.
    """

    loaded: LoadedWidePair
    loads: tuple[float, ...]
    pattern: ContactPattern


def _inputs(scene: Scene, name: str) -> ContactPatternInputs:
    return ContactPatternInputs(scene.case.load_distribution.coat, name)


def _compute(inputs: ContactPatternInputs, upstream: Upstream, _work: Work) -> ContactPatternData:
    from fegear.contact.wide.pair_history import contact_pattern

    loaded = loaded_flanks(upstream, inputs.name)
    loads = (_LIGHT * loaded.nominal, *loaded.loads)
    found = loaded.flanks.solve(loads, loaded.gaps, loaded.known)
    return ContactPatternData(loaded, loads, contact_pattern(found, loaded.gaps.at(found.pair, found.lines, loads)))


def _ends(places: Array, printed: Array) -> tuple[float, float]:
    """First and last of the places at which anything is printed; NaN where nothing is."""
    on = places[printed]
    return (float(on[0]), float(on[-1])) if on.size else (np.nan, np.nan)


def _present(data: ContactPatternData, inputs: ContactPatternInputs) -> Outcome:
    name, pattern = inputs.name, data.pattern
    printed, share = pattern.printed(inputs.coat), pattern.printed_share(inputs.coat)
    z = np.array([_ends(pattern.z, one.any(axis=1)) for one in printed])
    x = np.array([_ends(pattern.x, one.any(axis=0)) for one in printed])
    columns = (
        column_of(ErrorOverPitch, "total_load", data.loads, name="load"),
        Column("printed_share", share, "", f"of the flank, by a coat of {inputs.coat * 1e6:.4g} um"),
        Column("z_first", z[:, 0], "mm", "where the pattern begins along the face"),
        Column("z_last", z[:, 1], "mm", "where it ends"),
        Column("x_first", x[:, 0], "mm", "where it begins along the line of action"),
        Column("x_last", x[:, 1], "mm", "where it ends"),
    )
    title = f"Contact pattern of pair {name} under every load"
    meaning = f"of the flank that a coat of {inputs.coat * 1e6:.4g} um prints"
    value = Value(f"{name}.printed_share", float(share[1 + data.loaded.at]), "", None, meaning)
    table = Table(f"contact_pattern_{name}", columns, title)
    return Outcome(data, (table,), (value,), {"coat": inputs.coat}, (), (_figure(inputs, data),))


def _figure(inputs: ContactPatternInputs, data: ContactPatternData) -> Figure:
    pattern, found, coat = data.pattern, data.loaded.found, inputs.coat
    radius = found.pair.radius(pattern.x, "driver")
    panels = []
    for i in few(len(data.loads), (0, 1 + data.loaded.at), _DRAWN):
        seen = np.where(pattern.separation[i] < coat, pattern.separation[i], np.nan).T * 1e6
        share = float(pattern.printed_share(coat)[i])
        heat = HeatMap(pattern.z * 1e3, radius * 1e3, seen, "separation", "um", limits=(0.0, coat * 1e6))
        title = f"{data.loads[i]:.5g} N: {share:.0%} printed"
        panels.append(Panel(Axis("face position z", "mm"), Axis("radius on the driver", "mm"), (heat,), title=title))
    return Figure(
        f"contact_pattern_{inputs.name}",
        f"Contact pattern of pair {inputs.name}",
        f"Pair {inputs.name}: the driver's flank where a coat of marking compound, {coat * 1e6:.4g} um thick, is "
        "printed as the contact lines pass over it; blank where the flanks stay further apart. "
        f"{data.loads[0]:.4g} N is about what a pair turned by hand bears.",
        tuple(panels),
        columns=2 if len(panels) > 1 else 1,
    )


CONTACT_PATTERN = flank_stage(
    inputs=_inputs,
    compute=_compute,
    present=_present,
    cites=citing(Citation("iso-21771", "contact lines in the plane of action", "5.4")),
    forecast=lambda _scene, _name: forecasts.constant(0.1),
)
