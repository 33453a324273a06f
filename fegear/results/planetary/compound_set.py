"""Stage ``compound-set``: ratios, speeds, torques, powers and phases of a planetary set described as data."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.notes import assuming, failing
from fegear.base.printed import figures
from fegear.base.shown import shown, shows
from fegear.case.built.compound import compound_inputs
from fegear.dynamics.compound.assembly import clearances, clusters
from fegear.dynamics.compound.mesh_phases import mesh_phases, phasing
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve
from fegear.engine.figure.panel import Panel
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Rows
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Stage
from fegear.results import forecasts

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.case.built.compound import CompoundInputs
    from fegear.case.reading import Scene
    from fegear.dynamics.compound.mesh_phases import CompoundPhasing, MeshPhases
    from fegear.dynamics.compound.speeds_and_torques import Drive
    from fegear.engine.sheet.seen import Seen
    from fegear.engine.stage import Upstream, Work

#: Combinations of fixed, driving and loaded shafts that are listed.
_LISTED = 600


@dataclass(frozen=True)
class RatioRow:
    """One combination of fixed, driving and loaded shafts."""

    fixed: str = shown("", "fixed shafts")
    driving: str = shown("", "driving shaft", name="input")
    loaded: str = shown("", "loaded shaft; all others run idle", name="output")
    ratio: float = shown("", "ratio of input to output speed; blank: does not run")
    output_torque: float = shown("", "output torque on the set per input torque")
    fixed_torque: float = shown("", "torque of the fixed shaft on the set per input torque; blank: several")
    efficiency: float = shown("", "efficiency (output / input power)")
    rolling: float = shown(
        "", "largest power through the teeth of one mesh, relative to the carrier, per input power", name="mesh_power"
    )
    remark: str = shown("", "reason if it does not run")


@dataclass(frozen=True)
class ShaftRow:
    """How a shaft or planet runs."""

    member: str = shown("", "shaft or group of planets")
    speed: float = shown("rpm", "counter-clockwise")
    relative: float = shown("rpm", "relative to the carrier, of planets", name="speed_in_carrier")
    torque: float = shown("N.m", "external torque, counter-clockwise")
    power: float = shown("W", "power into the set")


@dataclass(frozen=True)
class MeshRow:
    """What a mesh carries."""

    mesh: str = shown("", "members in mesh")
    driver: str = shown("", "driving member, relative to the carrier")
    angle: float = shown("deg", "working pressure angle")
    centre_distance: float = shown("mm", "centre distance")
    force: float = shown("N", "force along the line of action in the transverse section, at one planet")
    frequency: float = shown("Hz", "mesh frequency; blank: speed not specified")
    rolling: float = shown("W", "power through the teeth of all planets, relative to the carrier", name="mesh_power")
    loss: float = shown("W", "power loss of all planets")


@dataclass(frozen=True)
class PhaseRow:
    """Phase of a mesh at one planet."""

    mesh: str = shown("", "members in mesh")
    planet: int = shown("", "number of the planet")
    angle: float = shown("deg", "angular position of the planet, counter-clockwise")
    lag: float = shown("", "phase lag relative to the first planet's mesh, in base pitches")
    behind: float = shown(
        "", "phase lag of the first planet's mesh relative to that of the reference mesh, in base pitches; blank: no "
        "load",
    )  # fmt: skip
    reference: str = shown("", "reference mesh of equal mesh frequency")


@dataclass(frozen=True)
class GapRow:
    """Room between planets."""

    first: str = shown("", "planets", name="planets")
    second: str = shown("", "adjacent planets", name="adjacent")
    gap: float = shown("mm", "minimum distance between tip circles; negative: overlap", name="clearance")


@dataclass(frozen=True)
class AssemblyRow:
    """Where planets go in."""

    planets: str = shown("", "groups of planets that mesh with each other")
    step: float = shown("deg", "assembly is possible at integer multiples of this angle; blank: at any angle")


@dataclass(frozen=True)
class CompoundData:
    """What follows from a set and its drive.

    Parameters
    ----------
    ratios : tuple of RatioRow
    listed : bool
        Whether all combinations are among them.
    phases : tuple of MeshPhases
    phasing : tuple of CompoundPhasing
    gaps : tuple of GapRow
    certain : tuple of bool
        Whether each pair of planets is in one plane in any case.
    """

    ratios: tuple[RatioRow, ...]
    listed: bool
    phases: tuple[MeshPhases, ...]
    phasing: tuple[CompoundPhasing, ...]
    gaps: tuple[GapRow, ...]
    certain: tuple[bool, ...]
    assembly: tuple[AssemblyRow, ...]


def compound_sets(scene: Scene) -> tuple[str, ...]:
    """All sets of a case that are described as data."""
    return tuple(scene.case.compound)


def _compute(inputs: CompoundInputs, _upstream: Upstream, _work: Work) -> CompoundData:
    rows = [_ratio(*one) for one in inputs.trains.every(_LISTED + 1)]
    phases = () if inputs.drive is None else mesh_phases(inputs.found, inputs.drive, inputs.direction)
    gaps = clearances(inputs.found)
    steps = [(", ".join(group.name for group in one.planets), one.step) for one in clusters(inputs.found)]
    return CompoundData(
        tuple(rows[:_LISTED]), len(rows) <= _LISTED, phases, tuple(phasing(one, inputs.harmonics) for one in phases),
        tuple(GapRow(one.first, one.second, one.gap) for one in gaps), tuple(one.certain for one in gaps),
        tuple(AssemblyRow(names, 2.0 * math.pi / step if step else math.nan) for names, step in steps),
    )  # fmt: skip


def _ratio(fixed: tuple[str, ...], driving: str, loaded: str, drive: Drive | str) -> RatioRow:
    names = ", ".join(fixed)
    if isinstance(drive, str):
        none = math.nan
        return RatioRow(names, driving, loaded, none, none, none, none, none, drive)
    held = float(drive.torque[fixed[0]]) if len(fixed) == 1 else math.nan
    most = max((abs(float(one)) for one in drive.rolling), default=0.0)
    return RatioRow(
        names, driving, loaded, float(drive.ratio), float(drive.torque[loaded]), held, float(drive.efficiency), most, ""
    )


@dataclass(frozen=True)
class ShownCompound:
    """What is shown of a set: rows of its members and meshes where the case says how it runs."""

    data: CompoundData
    asked: CompoundInputs

    @property
    def members(self) -> list[ShaftRow] | None:
        """A row each."""
        asked, drive = self.asked, self.asked.drive
        if drive is None:
            return None
        turn, push = asked.direction * asked.speed, asked.direction * asked.torque
        rows = []
        for shaft in asked.found.shaft_names:
            speed, torque = float(drive.speed[shaft]) * turn, float(drive.torque[shaft]) * push
            rows.append(ShaftRow(shaft, speed, math.nan, torque, torque * speed + 0.0))
        for group in asked.found.planets:
            relative = drive.speed[group.name] - drive.speed[group.carrier]
            rows.append(
                ShaftRow(group.name, float(drive.speed[group.name]) * turn, float(relative) * turn, math.nan, math.nan)
            )
        return rows

    @property
    def meshes(self) -> list[MeshRow] | None:
        """A row each."""
        asked, drive = self.asked, self.asked.drive
        if drive is None:
            return None
        rows = []
        power = asked.torque * asked.speed
        for one, tooth, rolling, loss in zip(asked.found.toothed, drive.tooth, drive.rolling, drive.loss, strict=True):
            turns = abs(float(drive.speed[one.planets.name] - drive.speed[one.planets.carrier])) * asked.speed
            driver = one.planets.name if rolling > 0 else one.other.name if rolling < 0 else ""
            force = abs(float(tooth)) * asked.torque * one.wheel.teeth / one.wheel.base_radius / one.planets.count
            at_speed = turns * one.wheel.teeth / (2.0 * math.pi), abs(float(rolling)) * power, float(loss) * power
            rows.append(
                MeshRow(
                    one.mesh.name, driver, asked.found.working_angle(one), asked.found.distance(one), force,
                    *(at_speed if asked.at_speed else (math.nan, math.nan, math.nan)),
                )
            )  # fmt: skip
        return rows

    @property
    def phases(self) -> list[PhaseRow]:
        """A row for each mesh at each planet."""
        return [
            PhaseRow(
                one.mesh, int(n), float(angle), float(lag), math.nan if one.behind is None else one.behind,
                one.reference,
            )
            for one in self.data.phases for n, angle, lag in zip(one.planet, one.angle, one.lag, strict=True)
        ]  # fmt: skip

    @property
    @shows("", "ratio of input to output speed")
    def ratio(self) -> float:
        """i; not a number where nothing drives."""
        return math.nan if self.asked.drive is None else float(self.asked.drive.ratio)

    @property
    @shows("", "efficiency (output / input power) with friction of all meshes")
    def efficiency(self) -> float:
        """eta."""
        return math.nan if self.asked.drive is None else float(self.asked.drive.efficiency)

    @property
    @shows("", "largest power through the teeth of one mesh, relative to the carrier, per input power")
    def mesh_power(self) -> float:
        """Above 1 where power circulates."""
        drive = self.asked.drive
        return math.nan if drive is None else max(abs(float(one)) for one in drive.rolling)

    @property
    @shows("mm", "minimum distance between tip circles of planets on one carrier")
    def clearance(self) -> float:
        """Smallest clearance between planets [m]; infinite for one planet."""
        return min((one.gap for one in self.data.gaps), default=math.inf)


def _remarks(seen: Seen) -> Iterator[str]:
    asked, data, name = seen.data.asked, seen.data.data, seen.name
    for one, certain in zip(data.gaps, data.certain, strict=True):
        if one.gap < 0.0 and not certain:
            yield failing(
                f"Set {name}: tip circles of planets {one.first} and {one.second} overlap by "
                f"{-one.gap * 1e3:.4g} mm; they must be in different planes."
            )
    if not data.listed:
        yield f"Set {name}: the first {_LISTED} combinations of fixed, driving and loaded shafts are listed."
    if asked.drive is None:
        yield f"Set {name}: speeds, torques and phases require compound.{name}.input and torque."
        return
    idle = [mesh.name for mesh, tooth in zip(asked.found.meshes, asked.drive.tooth, strict=True) if not tooth]
    if idle:
        yield f"Set {name}: no load on {', '.join(idle)}."
    if not asked.at_speed:
        yield assuming(
            f"Set {name}: speed not specified: frequencies require compound.{name}.speed; member speeds and powers are "
            "for 1 rad/s input speed."
        )


def _answer(seen: Seen) -> Iterator[str]:
    asked, shown_set = seen.data.asked, seen.data
    drive = asked.drive
    if drive is None:
        ratios = sorted({round(abs(one.ratio), 9) for one in shown_set.data.ratios if not one.remark})
        if ratios:
            yield f"Set {seen.name}: ratios from {figures(ratios[0])} to {figures(ratios[-1])} (absolute values)."
        return
    fixed = f" with {' and '.join(drive.fixed)} fixed" if drive.fixed else ""
    yield (
        f"Set {seen.name}: ratio {figures(float(drive.ratio))} from {drive.driving} to {drive.loaded}{fixed}, "
        f"efficiency {figures(100.0 * float(drive.efficiency))} %."
    )
    yield (
        "Largest power through one mesh, relative to the carrier: "
        f"{figures(100.0 * shown_set.mesh_power)} % of the input power."
    )
    if math.isfinite(shown_set.clearance):
        yield f"Minimum clearance between planets: {figures(shown_set.clearance * 1e3)} mm."


def _drawing(seen: Seen) -> tuple[Figure, ...]:
    """Working pitch circles of all gears, those of shafts about the axis, of planets at their places."""
    found = seen.data.asked.found
    round_ = np.linspace(0.0, 2.0 * math.pi, 181)
    unit = np.array([np.cos(round_), np.sin(round_)])
    circles: dict[tuple[str, float], None] = {}
    for one in found.toothed:
        cosine = math.cos(found.working_angle(one))
        circles[one.planets.name, one.wheel.base_radius / cosine] = None
        circles[one.other.name, one.other_wheel.base_radius / cosine] = None
    items = []
    for k, member in enumerate(found.names):
        centres = [(0.0, 0.0)]
        group = next((one for one in found.planets if one.name == member), None)
        if group is not None:
            centres = [(group.radius * math.cos(angle), group.radius * math.sin(angle)) for angle in group.angles]
        for radius in (own for name, own in circles if name == member):
            for centre in centres:
                x, y = (np.array(centre)[:, None] + radius * unit) * 1e3
                items.append(Curve(x, y, member, f"series:{k % 8}", markers=False))
    for carrier in found.carriers():
        for group in (one for one in found.planets if one.carrier == carrier):
            for angle in group.angles:
                spoke = np.array([0.0, group.radius * 1e3])
                items.append(Curve(spoke * math.cos(angle), spoke * math.sin(angle), carrier, "ink", markers=False))
    panel = Panel(Axis("x", "mm"), Axis("y", "mm"), tuple(items), equal=True, height=2.0)
    caption = f"Set {seen.name}: working pitch circles of all gears in mesh; lines: carriers."
    return (Figure(f"compound_set_{seen.name}", f"Planetary set {seen.name}", caption, (panel,)),)


_SHEET = Sheet(
    answer=Answer(_answer, figure=lambda seen: f"compound_set_{seen.name}"),
    of=ShownCompound,
    tables=(
        Rows(
            "compound_ratios_{name}", "Ratios of set {name} for all fixed, driving and loaded shafts",
            ("fixed", "driving", "loaded", "ratio", "output_torque", "fixed_torque", "efficiency", "rolling", "remark"),
            of="data.ratios",
        ),
        Rows(
            "compound_members_{name}", "Speeds and torques of set {name}",
            ("member", "speed", "relative", "torque", "power"), of="members", printed=True,
        ),
        Rows(
            "compound_meshes_{name}", "Meshes of set {name}",
            ("mesh", "driver", "angle", "centre_distance", "force", "frequency", "rolling", "loss"), of="meshes",
        ),
        Rows("compound_assembly_{name}", "Assembly of set {name}", ("planets", "step"), of="data.assembly"),
        Rows(
            "compound_clearances_{name}", "Clearance between planets of set {name}", ("first", "second", "gap"),
            of="data.gaps", when="data.gaps",
        ),
        Rows(
            "compound_phases_{name}", "Mesh phases of set {name}",
            ("mesh", "planet", "angle", "lag", "behind", "reference"), of="phases", when="data.phases",
        ),
        Rows(
            "compound_phasing_{name}", "Planet phasing of set {name}: resultant of each mesh harmonic",
            ("mesh", "harmonic", "torque", "force"), stacked="data.phasing", when="data.phasing",
        ),
    ),
    values=(
        "ratio", "efficiency", "mesh_power", Number("clearance", finite=True),
    ),
    figures=(_drawing,),
    remarks=(_remarks,),
)  # fmt: skip


COMPOUND_SET = Stage(
    subjects=compound_sets,
    inputs=compound_inputs,
    compute=_compute,
    present=_SHEET.present,
    cites=citing(Citation("parker", "modes excited by a harmonic with planet phasing")),
    forecast=lambda _scene, _name: forecasts.constant(0.05),
)
