"""Result ``mesh-stiffness-revolution``: a pair over all base pitches until the same teeth mesh again.

Without teeth that differ it is a revolution of the driver. Mesh stiffness, transmission error, load sharing and root
stress of every tooth; orders and condition indicators.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.base.arrays import Array, Index
from fegear.base.effects import ODD_TEETH, PLANE_EFFECTS, WIDE_EFFECTS
from fegear.base.notes import neglecting
from fegear.base.printed import percent, percents
from fegear.base.shown import shown, shows
from fegear.case.built.odd_gears import odd_gears_in
from fegear.case.built.odd_solid_teeth import check_odd_wide_pair
from fegear.case.built.odd_teeth import odd_teeth_in
from fegear.case.built.pair_checks import check_odd_teeth
from fegear.case.built.pair_spec import pair_spec
from fegear.contact.plane.faces_in_mesh import FacesInMesh, faces_in_mesh
from fegear.contact.plane.odd_compliance import OddCompliance
from fegear.contact.plane.over_revolution import OverRevolution, over_revolution
from fegear.contact.plane.sidebands import (
    AlongRevolution,
    ConditionIndicators,
    RevolutionOrders,
    along_revolution,
    condition_indicators,
    indicator_errors,
    revolution_orders,
)
from fegear.contact.plane.stress_over_revolution import stress_over_revolution
from fegear.engine.citation import Citation
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.engine.sheet.load_words import load_words
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Every, Off, Rows
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Forecast, Stage, Upstream, Work
from fegear.fem.alike_teeth import meshing_order
from fegear.geometry.pair import MEMBERS, GearPair, Member
from fegear.results.forecasts import HERTZ
from fegear.results.gear.odd_gear import CRACKS
from fegear.results.pair.loaded_teeth import ODD_WIDE, check_teeth, over_revolution_task, plane_pairs, solid_pairs
from fegear.results.pair.root_stress_of_teeth import (
    CHART_OF_TEETH,
    TABLE_OF_TEETH,
    StressByTooth,
    beside_cracks,
    by_tooth,
    not_listed,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.case.reading import Scene
    from fegear.contact.plane.loaded_pair import LoadedPair
    from fegear.contact.wide.over_revolution import RevolvingFlanks
    from fegear.engine.sheet.seen import Seen

#: Even steps over a base pitch.
POSITIONS = 100
#: Condition indicators, as values.
INDICATORS = ("residual_rms", "residual_kurtosis", "fm0", "fm4", "m6a", "energy_ratio", "sideband_level_factor")
#: Roll positions that are added to a 3D pair's where extremes may stand between them, on average (random pairs).
_ADDED = 12
#: Seconds of a base pitch of plane teeth; of a station of 3D pairs at a roll position, and again in each base pitch.
_PITCH, _STATION, _AGAIN = 0.04, 2.5e-3, 3e-4


@dataclass(frozen=True)
class RevolutionInputs:
    """What this stage reads of the case.

    Parameters
    ----------
    odd, cracked : tuple of (member, tuple of int)
        Odd teeth of driver and driven gear, and those with a crack, in meshing order.
    described : tuple of (member, str)
        Which of them are what, in words.
    gears : tuple of str
        Names of driver and driven gear.
    others : int
        Loads of the case besides the nominal one.
    corners : bool
        Whether contact outside the path of contact is included.
    """

    odd: tuple[tuple[Member, tuple[int, ...]], ...]
    cracked: tuple[tuple[Member, tuple[int, ...]], ...]
    described: tuple[tuple[Member, str], ...]
    gears: tuple[str, str] = field(compare=False)
    others: int = field(compare=False)
    corners: bool = field(compare=False)
    name: str = field(compare=False)


@dataclass(frozen=True)
class LoadsOnTeeth:
    """Loaded tooth pairs, position after position."""

    base_pitch: Index = shown("", "number of the base pitch", table="loads")
    driver_angle: Array = shown("deg", "rotation of the driver", table="loads")
    driver_tooth: Index = shown("", "number of the driver tooth in meshing order", table="loads")
    driven_tooth: Index = shown("", "number of the driven tooth in meshing order", table="loads")
    load: Array = shown("N", "load on the tooth pair", table="loads")
    share: Array = shown("", "share of the total load", table="loads")


@dataclass(frozen=True)
class RevolutionData:
    """A loaded pair over all base pitches."""

    pair: GearPair
    found: OverRevolution
    orders: RevolutionOrders
    indicators: ConditionIndicators
    indicator_errors: ConditionIndicators
    stress: tuple[StressByTooth, ...]
    faces: tuple[FacesInMesh, ...] = ()
    positions: int = POSITIONS

    @cached_property
    def along(self) -> AlongRevolution:
        """Row by row."""
        return along_revolution(self.found)

    @cached_property
    def loads(self) -> LoadsOnTeeth:
        """Every loaded pair of teeth at every position."""
        of = self.found
        cycle, position, row = np.nonzero(of.loads.transpose(0, 2, 1) > 0.0)
        load = of.loads[cycle, row, position]
        first, second = (np.mod(cycle - of.number[row], z) for z in (self.pair.driver.teeth, self.pair.driven.teeth))
        angle = of.along[cycle, position] / self.pair.driver.base_radius
        return LoadsOnTeeth(cycle, angle, first, second, load, load / of.load)

    @property
    def base_pitches(self) -> int:
        """Until the same teeth mesh again."""
        return int(self.found.transmission_error.shape[0])

    @property
    @shows("N/um", "minimum mesh stiffness (secant)")
    def mesh_stiffness_min(self) -> float:
        """[N/m]."""
        return self.found.lowest_stiffness

    @property
    def mesh_stiffness_min_error(self) -> float:
        """[N/m]."""
        return self.found.lowest_stiffness_error

    @property
    @shows("N/um", "minimum mesh stiffness of an ordinary base pitch")
    def mesh_stiffness_min_ordinary(self) -> float:
        """[N/m]."""
        return self.found.ordinary_lowest_stiffness

    @property
    def mesh_stiffness_min_ordinary_error(self) -> float:
        """[N/m]."""
        return self.found.ordinary_lowest_stiffness_error

    @property
    @shows("%", "reduction of the minimum mesh stiffness compared with an ordinary base pitch")
    def mesh_stiffness_loss(self) -> float:
        """Of one."""
        return self.found.stiffness_loss

    @property
    def mesh_stiffness_loss_error(self) -> float:
        """Of one."""
        return self.found.stiffness_loss_error

    @property
    @shows("um", "maximum transmission error")
    def te_max(self) -> float:
        """[m]."""
        return self.found.largest_error

    @property
    def te_max_error(self) -> float:
        """[m]."""
        return self.found.largest_error_error

    @property
    @shows("um", "maximum residual: transmission error minus that of an ordinary base pitch")
    def te_residual_max(self) -> float:
        """[m]."""
        return self.found.largest_residual

    @property
    def te_residual_max_error(self) -> float:
        """[m]."""
        return self.found.largest_residual_error


def inputs_of(scene: Scene, name: str) -> RevolutionInputs:
    """Odd teeth and names of a pair's gears."""
    part, odd = scene.case.pair[name], odd_gears_in(scene, name)
    gears = part.driver, part.driven
    known = [(m, odd_teeth_in(scene, name, gear)) for m, gear in zip(MEMBERS, gears, strict=True) if gear in odd]
    cracked = tuple((member, tuple(sorted(tooth for tooth, _ in one.cracks))) for member, one in known)
    teeth = tuple((member, one.numbers) for member, one in known)
    described = tuple((member, one.described) for member, one in known)
    others = len(part.all_loads(scene.pairs[name])) - 1
    corners = bool(scene.case.effects.corner_contact)
    return RevolutionInputs(teeth, cracked, described, gears, others, corners, name)


def _compute(asked: RevolutionInputs, upstream: Upstream, work: Work) -> RevolutionData:
    ((task, found),) = upstream.items()
    if task.stage == ODD_WIDE:
        return _of_wide(asked, cast("RevolvingFlanks", found), work)
    loaded = cast("LoadedPair", found)
    pair = loaded.pair
    over = over_revolution(loaded.engagement, loaded.nominal, POSITIONS, loaded.shifted, pair.driver.teeth)
    work.progress(0.6)
    engagement, load, shifted = loaded.engagement, loaded.nominal, loaded.shifted
    cracked = dict(asked.cracked)
    stress = tuple(
        by_tooth(
            stress_over_revolution(engagement, load, member, positions=POSITIONS, shifted=shifted),
            gear,
            cracked.get(member, ()),
        )
        for member, gear in zip(MEMBERS, asked.gears, strict=True)
        if loaded.spec.compliance == "fe" and loaded.spec.table is None
    )
    return _data(asked, pair, over, stress, tuple(_faces(asked, loaded, over)))


def _of_wide(asked: RevolutionInputs, revolving: RevolvingFlanks, work: Work) -> RevolutionData:
    from fegear.contact.wide.over_revolution import follow_flanks
    from fegear.contact.wide.stress_over_revolution import usual_errors, wide_stress_over_revolution

    followed = follow_flanks(revolving, revolving.pair.driver.teeth, lambda part: work.progress(0.8 * part))
    stresses = usual_errors(*(wide_stress_over_revolution(followed, member) for member in MEMBERS))
    cracked = dict(asked.cracked)
    stress = tuple(
        by_tooth(one, gear, cracked.get(member, ()))
        for member, one, gear in zip(MEMBERS, stresses, asked.gears, strict=True)
    )
    return replace(_data(asked, revolving.pair, followed.over, stress), positions=followed.over.x.size)


def _data(
    asked: RevolutionInputs,
    pair: GearPair,
    over: OverRevolution,
    stress: tuple[StressByTooth, ...] = (),
    faces: tuple[FacesInMesh, ...] = (),
) -> RevolutionData:
    odd = [pair.gear(member).teeth for member, _ in asked.odd] or [pair.driver.teeth]
    orders, indicators = revolution_orders(over), condition_indicators(over, odd)
    return RevolutionData(pair, over, orders, indicators, indicator_errors(over, odd), stress, faces)


def _faces(asked: RevolutionInputs, loaded: LoadedPair, over: OverRevolution) -> Iterator[FacesInMesh]:
    """Of each crack that may close."""
    for member, teeth in asked.cracked:
        source = loaded.engagement.compliance.source(member)
        if not isinstance(source, OddCompliance):
            continue
        known = source.influence
        for order in teeth:
            number = meshing_order(order, known.gear.teeth, member)
            if known.from_middle(number) in known.fine.closing:
                yield faces_in_mesh(loaded.engagement, over, member, known, number)


def _closing(seen: Seen) -> Iterator[str]:
    """How far the faces of cracks are closed."""
    data: RevolutionData = seen.data
    for one in data.faces:
        if one.closed.any():
            gear = seen.asked.gears[MEMBERS.index(one.member)]
            yield (
                f"Pair {seen.name}: while tooth {one.tooth} of gear {gear} carries load, "
                f"{percents(float(one.closed.min()), float(one.closed.max()))} of its crack faces are closed."
            )


def _answer(seen: Seen) -> Iterator[str]:
    data: RevolutionData = seen.data
    if not seen.asked.odd:
        return
    start = f"Pair {seen.name} at {load_words(data.found.load)}"
    which = " and ".join(f"{said} ({member})" for member, said in seen.asked.described)
    over = ", contact outside the path of contact included" if seen.asked.corners else ""
    yield (
        f"{start}, {which}: minimum mesh stiffness {data.mesh_stiffness_min * 1e-6:.4g} N/µm, "
        f"{percent(data.mesh_stiffness_loss)} below that of ordinary teeth "
        f"({data.mesh_stiffness_min_ordinary * 1e-6:.4g} N/µm){over}."
    )
    residual = data.found.residual
    how = "rises" if residual.max() >= -residual.min() else "falls"
    yield f"{start}: the transmission error {how} by up to {data.te_residual_max * 1e6:.3g} µm."


def _ordinary(seen: Seen) -> Array:
    """Mesh stiffness of an ordinary base pitch at every position [N/m]."""
    stiffness = seen.data.found.stiffness
    return np.tile(np.median(stiffness, axis=0), len(stiffness))


def _one_load(seen: Seen) -> Iterator[str]:
    """Of several loads only the nominal one is followed."""
    if (others := seen.asked.others) > 0:
        yield neglecting(
            f"Pair {seen.name}: mesh-stiffness-revolution is for {load_words(seen.data.found.load)} only, the nominal "
            f"of {others + 1} loads; run the case for each of the others with torque or load alone."
        )


_ANGLE = "Numbers of teeth in meshing order, tooth 0 on pair 0 of base pitch 0."
_SHEET = Sheet(
    tables=(
        Rows(
            "mesh_stiffness_revolution_{name}",
            "Mesh stiffness and transmission error of {name} over {d.base_pitches} base pitches",
            (
                Every("revolution"), Off("te", "along.te_error", of="along"),
                Off("mesh_stiffness", "along.mesh_stiffness_error", of="along"), "te_0",
            ),
            of="along", matlab=True,
        ),
        Rows(
            "tooth_loads_revolution_{name}", "Load sharing of {name} over {d.base_pitches} base pitches",
            (Every("loads"),), of="loads",
        ),
        TABLE_OF_TEETH,
        Rows(
            "mesh_stiffness_orders_{name}", "Orders of transmission error and mesh stiffness of {name}",
            (Every("orders"),), of="orders", matlab=True,
        ),
    ),
    values=(
        Number("mesh_stiffness_min", "mesh_stiffness_min_error"),
        Number("mesh_stiffness_min_ordinary", "mesh_stiffness_min_ordinary_error"),
        Number("mesh_stiffness_loss", "mesh_stiffness_loss_error"),
        Number("te_max", "te_max_error"),
        Number("te_residual_max", "te_residual_max_error"),
        *(Number(key, f"indicator_errors.{key}", of="indicators") for key in INDICATORS),
    ),
    figures=(
        Chart(
            "mesh_stiffness_revolution_{name}", "Mesh stiffness of pair {name} over the rotation",
            "Pair {name}: mesh stiffness, transmission error and its residual (minus an ordinary base pitch) over "
            "{d.base_pitches} base pitches. " + _ANGLE,
            (
                Over(
                    "driver_angle",
                    (
                        Line(
                            "mesh_stiffness", "mesh stiffness of ordinary teeth", "static", si=_ordinary,
                            when=lambda seen: seen.data.found.solved > 1,
                        ),
                        Line("mesh_stiffness", "mesh stiffness"),
                    ),
                    "mesh_stiffness",
                ),
                Over(
                    "driver_angle",
                    (Line("te", "transmission error", "green"), Line("te_residual", "residual", "red")),
                ),
            ),
            of="along",
        ),
        Chart(
            "mesh_stiffness_orders_{name}", "Orders of the transmission error of pair {name}",
            "Pair {name}: amplitudes over the order of the tooth-mesh frequency; integers are mesh harmonics, the "
            "others are due to teeth that differ.",
            tuple(Over("mesh_order", (Line(key, kind="stems"),)) for key in ("te", "mesh_stiffness")),
            of="orders",
        ),
        CHART_OF_TEETH,
    ),
    answer=Answer(
        _answer, figure="mesh_stiffness_revolution_{name}", rank="mesh_stiffness_min",
        among="lowest stiffness of {count} pairs", leads=lambda seen: bool(seen.asked.odd),
    ),
    remarks=(
        Remark(
            "Pair {name}: all teeth are identical and all base pitches equal; describe [[gear.NAME.odd_tooth]] and set "
            "odd_teeth = true under [effects] for teeth that differ.",
            when=lambda seen: seen.data.found.solved == 1,
        ),
        _one_load,
        _closing,
        beside_cracks,
        not_listed,
    ),
    settings={"positions": "positions", "base_pitches_solved": "found.solved"},
)  # fmt: skip


def _forecast(scene: Scene, name: str) -> Forecast:
    pair = scene.pairs[name]
    odd = len(odd_gears_in(scene, name))
    if name in scene.wide_pairs:
        from fegear.contact.wide.over_revolution import POSITIONS as PLACES

        pitches = int(np.ceil(pair.total_contact_ratio)) + 6 if odd else 1
        stations = pair_spec(scene, name).panel_count * pair.total_contact_ratio
        places = PLACES + _ADDED
        return Forecast({"positions": places}, places * stations * (_STATION + _AGAIN * pitches ** max(odd, 1)))
    pitches = int(np.ceil(pair.contact_ratio)) + 5 if odd else 1
    return Forecast({"positions": POSITIONS}, _PITCH * pitches ** max(odd, 1))


def _check(scene: Scene, name: str) -> None:
    check_teeth(scene, name)
    check_odd_teeth(scene, name)
    if name in scene.wide_pairs:
        check_odd_wide_pair(scene, name)


def _cites(scene: Scene, name: str) -> Iterator[Citation]:
    if odd_gears_in(scene, name):
        yield from CRACKS
    yield HERTZ
    yield Citation("zakrajsek-townsend-decker", "condition indicators FM0, FM4, energy ratio")


MESH_STIFFNESS_REVOLUTION = Stage(
    subjects=lambda scene: (*plane_pairs(scene), *solid_pairs(scene)),
    needs=lambda scene, name: (over_revolution_task(scene, name),),
    inputs=inputs_of,
    compute=_compute,
    present=_SHEET.present,
    check=_check,
    effects_of=lambda scene, name: (*(WIDE_EFFECTS if name in scene.wide_pairs else PLANE_EFFECTS), ODD_TEETH.name),
    cites=_cites,
    forecast=_forecast,
)
