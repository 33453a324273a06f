"""Stage ``mesh-force-spectrum``: lines of the mesh forces of the linearised train, at a speed and over speeds."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.engine.citation import Citation, citing
from fegear.engine.declared import axis_of
from fegear.engine.figure.axis import Axis
from fegear.engine.sheet.chart import ALL, Chart, Family, Line, Over
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.seen import itself
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Forecast, Stage, Upstream, Work
from fegear.results import forecasts
from fegear.results.train.gear_train import (
    gear_train,
    meshes,
    needs_one_speed,
    needs_train,
    pull_remarks,
    what_excites,
)

if TYPE_CHECKING:
    from fegear.case.dynamics import DynamicsPart
    from fegear.case.reading import Scene
    from fegear.engine.sheet.seen import Seen
    from fegear.results.train.mesh_force_lines import SpectrumData
    from fegear.results.train.ripple_spectrum import Strongest


#: Harmonics of the waterfall at most.
_WATERFALL_LINES = 64


@dataclass(frozen=True)
class SpectrumInputs:
    """How the train is run, M of Mark's series where its lines are wanted as well, and the name of the mesh."""

    part: DynamicsPart
    terms: int | None
    name: str


def _compute(asked: SpectrumInputs, upstream: Upstream, _work: Work) -> SpectrumData:
    from fegear.dynamics.train.mark_lines import has_series, series_error
    from fegear.dynamics.train.mesh_force_spectrum import mesh_force_spectrum
    from fegear.dynamics.train.tooth_force import largest_pull
    from fegear.dynamics.train.torque_response import ripple_spectrum
    from fegear.results.train.mesh_force_lines import SpectrumData

    data, part = gear_train(upstream), asked.part
    i, speed, speeds = data.train.mesh_index(asked.name), part.one_speed / data.speed_ratio, part.speed_values
    found = mesh_force_spectrum(data.train, data.errors, [speed], part.harmonics, rotational=True, phases=data.phases)
    waterfall, ripple, rippled = None, None, None
    if data.ripple:
        ripple = ripple_spectrum(data.train, data.ripple, [speed])
    if speeds.size > 1:
        harmonics = min(part.harmonics, _WATERFALL_LINES)
        waterfall = mesh_force_spectrum(data.train, data.errors, speeds / data.speed_ratio, harmonics)
        if data.ripple:
            rippled = ripple_spectrum(data.train, data.ripple, speeds / data.speed_ratio)
    pull = largest_pull(data, i, [speed], part.harmonics)
    series = None
    if asked.terms is not None and all(has_series(mesh.excitation) for mesh in data.meshes):
        errors = [series_error(mesh.excitation, mesh.force, part.harmonics, asked.terms) for mesh in data.meshes]
        series = mesh_force_spectrum(data.train, errors, [speed], part.harmonics, phases=data.phases)
    return SpectrumData(data, i, found, waterfall, pull, ripple, rippled, series)


def _caption(seen: Seen) -> str:
    from fegear.results.train.mesh_force_lines import WEAKEST

    top, left = seen.data.drawn_to
    above = f" Lines above {top * 1e-3:.4g} kHz hold {left:.2g} of the mean square; the table has them."
    return seen.said(
        "Mesh {name} at {d.speed:.6g} of {d.train.speed_of}: lines by "
        f"{what_excites(seen.data.train)}, with harmonic number; lines above {WEAKEST:g} of the maximum."
        f"{above if left > 0.0 else ''}"
    )


def _strongest_line(_seen: Seen) -> type[Strongest]:
    from fegear.results.train.ripple_spectrum import Strongest

    return Strongest


def _without_series(seen: Seen) -> bool:
    return seen.asked.terms is not None and seen.data.series is None


def _spectrum(lines: str) -> tuple[Cell, ...]:
    """Number, excitation and frequency of the lines."""
    return (
        Cell("orders", f"{lines}.n"), Cell("from_pair", of=lines), Cell("frequencies", f"{lines}.frequency"),
    )  # fmt: skip


_SPEED = "speed of {d.train.speed_of}"
_STRONGEST = (
    Number("largest", name="largest_line_from_{one.source}", meaning="amplitude, {one.where}"),
    Number("rms", name="rms_from_{one.source}"),
)
_SHEET = Sheet(
    tables=(
        Rows(
            "mesh_force_spectrum_{name}", "Spectrum of the force in mesh {name}",
            (*_spectrum("lines"), Cell("amplitudes", "lines.amplitude"), Cell("power_lines", "lines.power")),
            of="spectrum",
        ),
        Rows(
            "mesh_force_waterfall_{name}", "Spectrum of the force in mesh {name} over speed",
            (
                Cell("speed", of="lines_over_speed", meaning=_SPEED), *_spectrum("lines_over_speed"),
                Cell("amplitudes", "lines_over_speed.amplitude"),
            ),
            of="waterfall",
        ),
        Rows(
            "torque_ripple_spectrum_{name}", "Lines of torque ripple in the force in mesh {name}",
            (
                Cell("ripple", of="of_ripple"), "harmonics", Cell("frequencies", "of_ripple.frequency"),
                Cell("torque", of="of_ripple"), Cell("force", of="of_ripple"), Cell("phase", of="of_ripple"),
                Cell("power_lines", "of_ripple.power"),
            ),
            of="ripple",
        ),
        Rows(
            "torque_ripple_waterfall_{name}", "Lines of torque ripple in the force in mesh {name} over speed",
            (
                Cell("speed", of="of_ripple_over_speed", meaning=_SPEED), Cell("ripple", of="of_ripple_over_speed"),
                Cell("harmonics", "of_ripple_over_speed.n"), Cell("frequencies", "of_ripple_over_speed.frequency"),
                Cell("force", of="of_ripple_over_speed"),
            ),
            of="ripple_waterfall",
        ),
        Rows(
            "mesh_force_series_{name}", "Lines of the force in mesh {name} by Mark's series",
            (
                *_spectrum("by_series"),
                Cell("power_lines", "by_series.power", meaning="by Mark's series, M = {asked.terms}"),
                Cell("power_exact", of="by_series"),
            ),
            of="series",
        ),
    ),
    values=(
        Each("of_ripple.strongest", *_STRONGEST),
        Each("strongest", *_STRONGEST),
        Number(
            "rms", of=_strongest_line, si=itself, name="rms_by_series_from_{key}", each="by_series.rms",
            further=" by Mark's series, M = {asked.terms}",
        ),
    ),
    figures=(
        Chart(
            "mesh_force_spectrum_{name}", "Spectrum of the force in mesh {name}", _caption,
            (
                Over(
                    Axis("frequency", "kHz", zero=True),
                    (
                        Line(
                            "amplitude", "{one.name}", x="frequency", kind="stems",
                            each=Family("stems", role="{one.role}", most=ALL),
                            look=lambda seen: {"notes": seen.one.notes, "numbers": seen.one.numbers},
                        ),
                    ),
                    "spectrum.amplitudes", options={"log": True},
                ),
            ),
            under="{d.speed:.6g}",
        ),
        Chart(
            "mesh_force_power_{name}", "Power of the lines of the force in mesh {name}",
            lambda seen: f"Mesh {seen.name}: one-sided power of every mesh harmonic, by exciting mesh; cross at zero "
            "frequency: square of the mean force."
            f"{' Rotational harmonics due to pitch deviations are in the table.' if seen.data.between else ''}",
            (
                Over(
                    lambda seen: Axis("frequency", "kHz", limits=seen.one.ends),
                    (
                        Line(
                            "power", "from mesh {one.name}", "{one.role}", x="frequency", kind="stems",
                            look=lambda seen: {"notes": seen.one.notes},
                        ),
                        Line(
                            "mean", "mean force", "ink", x="zero", kind="points",
                            look={"symbol": "x", "notes": ("mean force squared",)},
                        ),
                    ),
                    lambda seen: axis_of(seen.data.spectrum, "power_lines", log=True), title="From mesh {one.name}",
                    each="power_panels",
                ),
            ),
            under="{d.speed:.6g}",
        ),
        Chart(
            "mesh_force_waterfall_{name}", "Waterfall of the force in mesh {name}",
            lambda seen: f"Mesh {seen.name}: lines of the mesh force over speed, above 1 % of the maximum."
            f"{'' if seen.data.ripple_waterfall is None else ' Crosses: lines of torque ripple.'}",
            (
                Over(
                    Axis("frequency", "kHz"),
                    (
                        Line(
                            "speed", role="series:0", x="frequency", kind="points",
                            look=lambda seen: {
                                "shade": seen.data.points.amplitude, "shade_label": "mesh force amplitude [N]",
                                "size": 4.5, "notes": seen.data.points.notes,
                            },
                        ),
                        Line(
                            "speed", "{one.name}", x="frequency", kind="points",
                            each=Family("of_ripple_over_speed.points", role="{one.role}", most=ALL),
                            look=lambda seen: {"symbol": "x", "size": 5.0, "notes": seen.one.notes},
                        ),
                    ),
                    lambda seen: Axis(f"speed of {seen.data.train.speed_of}", "rpm"),
                ),
            ),
            of="points",
        ),
    ),
    remarks=(
        Remark(
            "Mesh {name}: no lines by Mark's series, which includes neither coupled teeth nor spacing errors.",
            when=_without_series,
        ),
        lambda seen: pull_remarks(seen.data.pull),
    ),
    settings={"harmonics": lambda seen: seen.asked.part.harmonics, "speed": lambda seen: seen.asked.part.one_speed},
)  # fmt: skip


def _forecast(scene: Scene, _name: str) -> Forecast:
    """Harmonics at the one speed, and over all speeds."""
    part, (meshes, bodies) = scene.case.dynamics, forecasts.sizes(scene)
    over = part.speed_values.size * min(part.harmonics, 64)
    seconds = 0.1 + 2e-6 * (over + part.harmonics) * meshes * bodies
    return Forecast({"harmonics": part.harmonics, "speeds": int(part.speed_values.size)}, seconds)


def _inputs(scene: Scene, name: str) -> SpectrumInputs:
    asked = scene.case.transmission_error
    return SpectrumInputs(scene.case.dynamics, asked.terms if asked.method == "mark-series" else None, name)


MESH_FORCE_SPECTRUM = Stage(
    subjects=meshes,
    needs=needs_train,
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    check=needs_one_speed,
    cites=citing(Citation("mark", "spectra of the mesh force", "Eqs. 3.1 to 3.11")),
    forecast=_forecast,
)
