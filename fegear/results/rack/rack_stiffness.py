"""Stage ``rack-stiffness``: compliance and root stress of the teeth of a rack, at its ends and in its middle."""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace
from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.base.printed import figures
from fegear.base.shown import shown
from fegear.case.built.rack import is_wide_rack, racks
from fegear.engine.citation import citing
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Chart, Family, Line, Over
from fegear.engine.sheet.rows import Rows
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Stage, Task
from fegear.results import forecasts
from fegear.results.forecasts import PATCH, RING
from fegear.results.rack.solid_rack import SOLUTION as SOLID
from fegear.results.rack.solid_rack import SolidRackToSolve, solid_rack_of
from fegear.results.rack.solved_rack import RackToSolve, needs_rack, rack_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.contact.rack.rack_teeth import RackTeeth
    from fegear.engine.sheet.seen import Seen
    from fegear.engine.stage import Upstream, Work
    from fegear.fem.solid.solution import SolidSolution
    from fegear.geometry.toothed_rack import Rack
    from fegear.results.rack.solid_rack import BothRacks

#: Heights over the flank.
_POINTS = 41
#: Of bands on a 3D tooth.
_HEIGHTS = 9


@dataclass(frozen=True)
class ToothOfRack:
    """One tooth under unit line loads over its flank, shape (P,); NaN where there is no neighbour."""

    number: int
    height: Array = shown("mm", "height of the load above the reference line")
    own: Array = shown(
        "um.mm/N", "self-compliance c_0 (contact half-width 0.02 modules)", name="c_self", label="self-compliance c_0"
    )
    before: Array = shown("um.mm/N", "coupling compliance of the tooth before; blank: none", name="c_prev")
    after: Array = shown("um.mm/N", "coupling compliance of the tooth after; blank: none", name="c_next")
    tension: Array = shown(
        "MPa.mm/N", "root stress, tension side, per line load", name="root_tension", label="root stress"
    )
    compression: Array = shown("MPa.mm/N", "root stress, compression side, per line load", name="root_compression")
    own_error: Array = shown("um.mm/N", "estimated error of c_self", name="c_self_error")
    tension_error: Array = shown("MPa.mm/N", "estimated error of root_tension", name="root_tension_error")


@dataclass(frozen=True)
class BandsOnRackTooth:
    """One tooth of a rack with its width under unit forces on bands, shape (N,); blank where there is no neighbour."""

    number: int
    height: Array = shown("mm", "height of the load above the reference line")
    position: Array = shown("mm", "face position of the band peak, from mid-face", name="face_position")
    own: Array = shown(
        "um/N", "approach of the contact per force (contact half-width 0.02 modules)", name="c_self", label="c_0"
    )
    before: Array = shown("um/N", "deflection of the same band on the tooth before; blank: none", name="c_prev")
    after: Array = shown("um/N", "deflection of the same band on the tooth after; blank: none", name="c_next")
    tension: Array = shown(
        "MPa/N", "root stress, tension side: maximum over the fillet and the face", name="root_tension",
        label="root stress",
    )  # fmt: skip
    compression: Array = shown("MPa/N", "root stress, compression side", name="root_compression")
    own_error: Array = shown("um/N", "estimated error of c_self", name="c_self_error")
    tension_error: Array = shown("MPa/N", "estimated error of root_tension", name="root_tension_error")

    @property
    def at_middle(self) -> BandsOnRackTooth:
        """The bands at mid-face."""
        on = self.position == 0.0
        return replace(self, **{f.name: getattr(self, f.name)[on] for f in fields(self) if f.name != "number"})


@dataclass(frozen=True)
class RackStiffness:
    """First, middle and last tooth: of a plane rack, or of one with its width."""

    teeth: dict[str, ToothOfRack] = field(default_factory=dict)
    bands: dict[str, BandsOnRackTooth] = field(default_factory=dict)


def _numbers(of: RackTeeth, i: int, heights: Array) -> tuple[Array, ...]:
    m, modulus = of.rack.module, of.rack.material.young_modulus
    one = of.solved.loaded(i)
    y = heights / m
    none = np.full(y.size, np.nan)
    beside = [
        np.array([float(one.neighbour(k, [at], [at], of.patch)[0, 0]) for at in y]) / modulus
        if k in one.compliance else none
        for k in (-1, 1)
    ]  # fmt: skip
    stress = [one.largest_root_stress(0, side, y)[0] / m for side in ("tension", "compression")]
    return of.self_compliance(i, heights, 0.02 * m), *beside, *stress


def _named_teeth(rack: Rack) -> list[int]:
    """The first tooth, the middle one and the last, each once."""
    return list(dict.fromkeys((0, (rack.teeth - 1) // 2, rack.teeth - 1)))


def _over_face(asked: RackToSolve | SolidRackToSolve, both: BothRacks) -> RackStiffness:
    from fegear.fem.solid.influence import SolidInfluence
    from fegear.fem.solid.table import band_numbers, bands_of_table

    rack, m, modulus = asked.rack, asked.rack.module, asked.rack.material.young_modulus
    flank, half = both.fine.flank, 0.5 * rack.face_width / m
    heights = np.linspace(flank.lowest_radius, flank.highest_radius, _HEIGHTS + 2)[1:-1]
    places = np.array([-half, -0.5 * half, 0.0, 0.5 * half, half])
    found, shape = {}, (heights.size, places.size)
    for i in _named_teeth(rack):
        fine, coarse = (cast("SolidSolution", one.loaded(i)) for one in both)
        bands = bands_of_table(fine, heights, places, 0.02)
        known = band_numbers(fine, bands, m)
        apart, shares = known.apart(band_numbers(coarse, bands, m)), SolidInfluence(fine, coarse, {}).entry_shares
        own, before, after = (known.compliance[name] / (modulus * m) for name in ("c_self", "c_prev", "c_next"))
        none = np.full(shape, np.nan)
        tension = known.root["tension"].value
        up, along = (one.ravel() for one in np.meshgrid(heights * m, places * m, indexing="ij"))
        found[str(i + 1)] = BandsOnRackTooth(
            i + 1, up, along, own.ravel(), (before if i > 0 else none).ravel(),
            (after if i < rack.teeth - 1 else none).ravel(), tension.ravel(),
            known.root["compression"].value.ravel(), (shares["contact"] * apart["c_self"] * own).ravel(),
            (shares["root_tension"] * apart["root_tension"] * np.abs(tension)).ravel(),
        )  # fmt: skip
    return RackStiffness(bands=found)


def _inputs(scene: Scene, name: str) -> RackToSolve | SolidRackToSolve:
    return (SolidRackToSolve if is_wide_rack(scene, name) else RackToSolve).of(scene, name)


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    return (Task(SOLID, name),) if is_wide_rack(scene, name) else needs_rack(scene, name)


def _compute(asked: RackToSolve | SolidRackToSolve, upstream: Upstream, _work: Work) -> RackStiffness:
    if isinstance(asked, SolidRackToSolve):
        return _over_face(asked, solid_rack_of(upstream, asked.name))
    both = rack_of(upstream, asked.name)
    rack, found = asked.rack, {}
    low, high = (one * rack.module for one in both.fine.solved.flank.heights)
    heights = np.linspace(low, high, _POINTS)
    for i in _named_teeth(rack):
        own, before, after, tension, compression = _numbers(both.fine, i, heights)
        off, torn = np.full((2, _POINTS), np.nan)
        if both.coarse is not None:
            other = _numbers(both.coarse, i, heights)
            off, torn = np.abs(own - other[0]), np.abs(tension - other[3])
        found[str(i + 1)] = ToothOfRack(i + 1, heights, own, before, after, tension, compression, off, torn)
    return RackStiffness(found)


def _answer(seen: Seen) -> Iterator[str]:
    if seen.data.bands:
        bands = list(seen.data.bands.values())
        middle = bands[len(bands) // 2]
        at = int(np.argmin(np.abs(middle.height) + np.abs(middle.position)))
        yield (
            f"Rack {seen.name}: c_0 of a band at mid-face, {figures(middle.height[at] * 1e3)} mm above the reference "
            f"line, {figures(middle.own[at] * 1e6)} µm/N in the middle of the rack."
        )
        return
    teeth = list(seen.data.teeth.values())
    middle = teeth[len(teeth) // 2]
    at = int(np.argmin(np.abs(middle.height)))
    said = f"Rack {seen.name}: c_0 on the reference line {figures(middle.own[at] * 1e9)} µm mm/N in the middle"
    if len(teeth) > 1:
        softer = 100.0 * (teeth[0].own[at] / middle.own[at] - 1.0), 100.0 * (teeth[-1].own[at] / middle.own[at] - 1.0)
        said += f", {figures(softer[0])} % and {figures(softer[1])} % more at the first and the last tooth"
    yield said + "."


_COLUMNS = (
    "height", "own", "before", "after", "tension", "compression", "own_error", "tension_error",
)  # fmt: skip
_SHEET = Sheet(
    answer=Answer(_answer, figure=lambda seen: f"rack_stiffness_{seen.name}"),
    tables=(
        Rows("rack_stiffness_{name}_{key}", "Rack {name}: compliance and root stress of tooth {key}", _COLUMNS,
             each="teeth"),
        Rows("rack_stiffness_over_face_{name}_{key}", "Rack {name}: compliance and root stress of tooth {key} (3D)",
             ("height", "position", *_COLUMNS[1:]), each="bands"),
    ),
    figures=(
        Chart(
            "rack_stiffness_over_face_{name}", "Stiffness of the teeth of rack {name} (3D)",
            "Rack {name}: self-compliance and root stress of bands at mid-face over the height of the load; half-width "
            "0.02 modules.",
            (
                Over("at_middle.height", (Line("at_middle.own", each=Family("bands", "tooth {key}")),)),
            ),
            of=lambda seen: next(iter(seen.data.bands.values()), None),
        ),
        Chart(
            "rack_stiffness_{name}", "Stiffness of the teeth of rack {name}",
            "Rack {name}: self-compliance and root stress over the height of the load; half-width 0.02 modules.",
            (
                Over("height", (Line("own", each=Family("teeth", "tooth {key}")),)),
                Over("height", (Line("tension", each=Family("teeth", "tooth {key}")),)),
            ),
            of=lambda seen: next(iter(seen.data.teeth.values()), None),
        ),
    ),
)  # fmt: skip

RACK_STIFFNESS = Stage(
    subjects=racks,
    needs=_needs,
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    cites=citing(*RING, PATCH),
    forecast=lambda _scene, _name: forecasts.constant(0.1),
)
