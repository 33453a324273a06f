"""Stage ``pair-forced-response``: mesh and bearing forces of a helical pair by errors and external forces."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass, field, replace

import numpy as np

from fegear.base.arrays import Array, Complex
from fegear.base.errors import InputError
from fegear.case.built.helical_pair import HelicalPairInputs, helical_pair_inputs
from fegear.case.csv_file import read_columns
from fegear.case.pair_excitation import ExcitationPart, MeshErrorPart
from fegear.case.part import at
from fegear.case.reading import Scene
from fegear.contact.error_over_pitch import ErrorOverPitch
from fegear.dynamics.helical_pair.transmissibility import Line, PairForces, rms
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.axis import Axis
from fegear.engine.sheet import chart
from fegear.engine.sheet.chart import Chart, Family, Over
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.results.helical.drawn_curves import drawn_panels
from fegear.results.helical.forced_response_shown import PairForcesData, ShownForces
from fegear.results.helical.transmissibility import mesh_needs, own_mesh
from fegear.results.pair.mesh_stiffness_data import loaded_harmonics
from fegear.results.pair.mesh_stiffness_matrix import mesh_stiffness_of

#: Harmonics of a pair or a table that are taken by default.
_HARMONICS = 8
#: Positions over the cycle for each harmonic of a helical pair at least: half of them still tell it from the others.
_EACH = 4
#: Base helix angles of case and pair may differ by this [rad].
_SAME_ANGLE = 1e-3
#: Even speeds from which a drawn curve starts at least.
_DRAWN = 121


@dataclass(frozen=True, slots=True)
class PairForcesInputs:
    """What the forces depend on.

    Parameters
    ----------
    pair : HelicalPairInputs
    excitation : ExcitationPart
    harmonics : ndarray of complex, shape (N,)
        Of the transmission error, 1 to N, where the case or a table gives them [m]; empty where a pair does.
    teeth : int
        Of the driver; zero without transmission error.
    arm : float
        Base radius of a rigid helical pair's gear, which turns its transmission error into a length; zero for others.
    flanks : str
        Name of the pair whose loaded flanks over the face excite; empty for others.
    name : str
        Of the pair.
    """

    pair: HelicalPairInputs
    excitation: ExcitationPart
    harmonics: Complex
    teeth: int
    arm: float
    flanks: str
    name: str = field(compare=False)


def _inputs(scene: Scene, name: str) -> PairForcesInputs:
    part, prefix = scene.case.transmissibility[name], f"transmissibility.{name}"
    excitation = _excitation(scene, name)
    asked = helical_pair_inputs(scene, name)
    if asked.mesh is not None:
        part.build_both(asked.mesh, prefix)  # refuses what cannot be built before anything runs
    error, teeth, arm, flanks = excitation.transmission_error, excitation.teeth or 0, 0.0, ""
    harmonics = np.zeros(0, dtype=complex)
    if error is not None and error.pair is not None:
        pair = scene.case.pair[error.pair]
        teeth = scene.case.gear[pair.driver].teeth
        source = _source(scene, name, error)
        arm = scene.helical_pairs[error.pair].gear.base_radius if source == "tooth-contact" else 0.0
        flanks = error.pair if source == "loaded-flanks" else ""
    elif error is not None and error.amplitude is not None:
        harmonics = np.zeros(error.harmonic or 1, dtype=complex)
        harmonics[-1] = error.amplitude
    elif error is not None and error.file is not None:
        harmonics = _read_harmonics(scene, error.file, f"{prefix}.excitation.transmission_error.file")
        harmonics = harmonics[: error.harmonics or _HARMONICS]
    return PairForcesInputs(asked, excitation, harmonics, teeth if error else 0, arm, flanks, name)


def _source(scene: Scene, name: str, error: MeshErrorPart) -> str:
    """Stage whose transmission error excites: of plane teeth, of rigid flanks, or of flanks loaded over the face."""
    pair = error.pair or ""
    if pair not in scene.wide_pairs:
        if error.flanks == "rigid":
            raise InputError(
                f"transmissibility.{name}.excitation.transmission_error.flanks", '"rigid"',
                f"is valid for helical gears only; those of pair {pair} are spur gears", "remove it",
            )  # fmt: skip
        return "transmission-error"
    its_own = scene.case.transmissibility[name].mesh.pair == pair or pair not in scene.helical_pairs
    return "tooth-contact" if (error.flanks or ("loaded" if its_own else "rigid")) == "rigid" else "loaded-flanks"


def _read_harmonics(scene: Scene, file: str, key: str) -> Complex:
    """Complex amplitudes from columns n with cosine and sine, as ``transmission_error_harmonics`` has them."""
    path = scene.file(file, key)
    columns = read_columns(path, key, {"n": "", "cosine": "length", "sine": "length", "amplitude": "length"})
    if "n" not in columns or not ({"cosine", "amplitude"} & columns.keys()):
        raise InputError(
            key, f'"{path.name}"', "has no columns n and cosine (with sine), or n and amplitude",
            "heads are n, cosine [um], sine [um]",
        )  # fmt: skip
    n = columns["n"]
    if np.any(n % 1.0 != 0.0) or n.min() < 1.0 or n.max() > 20_000.0 or np.unique(n).size != n.size:
        raise InputError(key, f'"{path.name}"', "contains invalid harmonic numbers n", "use 1, 2, 3, ..., each once")
    cosine = columns["cosine"] if "cosine" in columns else columns["amplitude"]
    sine = columns["sine"] if "cosine" in columns and "sine" in columns else np.zeros(n.size)
    found = np.zeros(int(n.max()), dtype=complex)
    found[n.astype(int) - 1] = cosine - 1j * sine
    return found


def _excitation(scene: Scene, name: str) -> ExcitationPart:
    found = scene.case.transmissibility[name].excitation
    if found is None:
        raise InputError(
            f"transmissibility.{name}.excitation", "(not given)", "is required for pair-forced-response",
            'set excitation = { teeth = 50, speeds = ["1000 rpm"], transmission_error = { amplitude = "1 um" } }',
        )  # fmt: skip
    return found


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    error, mesh = _excitation(scene, name).transmission_error, mesh_needs(scene, name)
    if error is None or error.pair is None:
        return mesh
    source = _source(scene, name, error)
    return (*mesh, Task("mesh-stiffness-matrix" if source == "loaded-flanks" else source, error.pair))


def _check(scene: Scene, name: str) -> None:
    """Refuse a pair whose helix is not that of the mesh that it shakes, and more harmonics than its positions tell."""
    error, prefix = _excitation(scene, name).transmission_error, f"transmissibility.{name}"
    if error is None or error.pair is None:
        return
    mesh = scene.case.transmissibility[name].mesh
    own = mesh.base_helix_angle if mesh.pair is None else scene.pairs[mesh.pair].driver.base_helix_angle
    angle = scene.pairs[error.pair].driver.base_helix_angle
    if abs(abs(own) - abs(angle)) > _SAME_ANGLE:
        raise InputError(
            f"{prefix}.mesh.base_helix_angle", f"{math.degrees(own):.6g} deg",
            f"contradicts pair {error.pair}, {math.degrees(abs(angle)):.6g} deg",
            "use that of the pair, or specify the harmonics of the transmission error as a file",
        )  # fmt: skip
    source = _source(scene, name, error)
    if error.shuttling and (source != "loaded-flanks" or mesh.pair != error.pair):
        raise InputError(
            f"{prefix}.excitation.transmission_error.shuttling", "true",
            "requires the mesh of the loaded flanks of the pair", f'set mesh = {{ pair = "{error.pair}" }}',
        )  # fmt: skip
    tables = {"tooth-contact": "tooth_contact", "loaded-flanks": "load_distribution"}
    if source not in tables:
        return
    positions = getattr(scene.case, tables[source]).positions
    count = error.harmonics or (_HARMONICS if source == "tooth-contact" else 0)
    if positions < _EACH * count:
        raise InputError(
            f"{tables[source]}.positions", positions, f"is too low for {count} harmonics",
            f"set at least {_EACH * count} positions",
        )  # fmt: skip


def _pair_harmonics(asked: PairForcesInputs, upstream: Upstream) -> tuple[Complex, Array | None]:
    """Harmonics of the transmission error of the case's own pair [m], positive for removed material; their errors.

    Those of loaded flanks over the face are `loaded_harmonics`.

    Those of a spur pair are estimated with its compliances. Of a helical pair the harmonics come from positions over
    the cycle: the error is what every second one alone would change, aliasing at the kinks of rigid flanks.
    """
    error = asked.excitation.transmission_error
    count = (error.harmonics if error else None) or _HARMONICS
    if asked.flanks:
        return loaded_harmonics(mesh_stiffness_of(upstream, asked.flanks), count, error is not None and error.shuttling)
    (found,) = (one for task, one in upstream.items() if task.stage in ("transmission-error", "tooth-contact"))
    if asked.arm == 0.0:
        error_of: ErrorOverPitch = found.found
        errors = None if error_of.shift is None else np.asarray(error_of.shift.amplitude[:count])
        return np.asarray(2.0 * error_of.series[error_of.at].coefficients[1 : count + 1]), errors
    # Where the gear runs ahead of its mate, the flanks have too much: the sign of removal is the other one.
    ahead = -asked.arm * found.contact.error
    all_of_them, half = (_harmonics(ahead, step, count) for step in (1, 2))
    return all_of_them, np.abs(all_of_them - half)


def _harmonics(values: Array, step: int, count: int) -> Complex:
    """Complex amplitudes of harmonics 1 to `count` of even values over a cycle, from every `step`-th of them."""
    at = np.arange(0, values.size, step)
    gaps = np.diff(at, append=values.size)
    weights = 0.5 * (gaps + np.roll(gaps, 1))
    turns = np.outer(np.arange(1, count + 1), at) / values.size
    return np.asarray(2.0 / values.size * np.exp(-2j * np.pi * turns) @ (weights * values[at]))


def _lines(asked: PairForcesInputs, harmonics: Complex, ratio: float) -> list[Line]:
    """Lines of harmonics (N,) along the case's coordinate, or (N, 5) over q; `ratio` driven speed over driver's."""
    from fegear.dynamics.helical_pair.model import COORDINATES
    from fegear.dynamics.helical_pair.transmissibility import Line

    part, lines = asked.excitation, []
    if part.transmission_error is not None:
        along = np.eye(5)[COORDINATES.index(part.transmission_error.along)]
        each = harmonics if harmonics.ndim == 2 else harmonics[:, None] * along
        lines += [
            Line((n + 1) * asked.teeth, error=tuple(size), source="transmission error")
            for n, size in enumerate(each)
            if np.any(size != 0.0)
        ]
    for number, force in enumerate(part.external, start=1):
        sizes = tuple(size * cmath.exp(1j * force.phase) for size in force.components)
        turns = 1.0 if force.on == "driver" else ratio
        order, frequency = (force.order or 0.0) * turns, 2.0 * math.pi * (force.frequency or 0.0)
        source = f"external {number}"
        if force.on == "driver":
            lines.append(Line(order, frequency, on_driver=sizes, source=source))
        else:
            lines.append(Line(order, frequency, on_driven=sizes, source=source))
    return lines


def _compute(asked: PairForcesInputs, upstream: Upstream, _work: Work) -> PairForcesData:
    from fegear.dynamics.helical_pair.transmissibility import pair_forces, resonant_speeds
    from fegear.dynamics.train.resolved_response import resolved_grid

    part, error = asked.excitation, asked.excitation.transmission_error
    model = asked.pair.part.build_both(own_mesh(asked.pair, upstream)[0], asked.pair.prefix)
    ratio = model.driver.base_radius / model.driven.base_radius
    of_pair = error is not None and error.pair is not None
    harmonics, doubts = _pair_harmonics(asked, upstream) if of_pair else (asked.harmonics, np.zeros(0))
    lines = _lines(asked, harmonics, ratio)
    if not lines:
        raise InputError(
            f"transmissibility.{asked.name}.excitation.transmission_error", "without harmonics", "gives no excitation",
            "specify a non-zero amplitude",
        )  # fmt: skip
    speeds, (resonant, undamped) = part.speeds.array, resonant_speeds(model, lines)
    try:
        found = pair_forces(model, lines, speeds)
        grid = speeds
        if speeds.size > 1:
            start = np.linspace(speeds[0], speeds[-1], _DRAWN)
            grid = resolved_grid(
                lambda omega: _drawn_sizes(pair_forces(model, lines, omega)), start,
                np.setdiff1d(resonant, undamped), undamped,
            )  # fmt: skip
        off = [] if doubts is None else _lines(replace(asked, excitation=_alone(part)), doubts.astype(complex), ratio)
        each = [[replace(x, error=tuple(np.eye(5)[k] * x.error)) for x in off if x.error[k]] for k in range(5)]
        spectrum = part.speed or float(speeds[np.argmax(rms(found.normal))])
        return PairForcesData(
            found, pair_forces(model, lines, grid), pair_forces(model, lines, [spectrum]),
            undamped[(undamped > speeds[0]) & (undamped < speeds[-1])],
            tuple(pair_forces(model, own, speeds) for own in each if own), doubts is not None,
        )  # fmt: skip
    except InputError as error:
        raise at(f"transmissibility.{asked.name}", error) from None


def _alone(part: ExcitationPart) -> ExcitationPart:
    """The excitation without its external forces."""
    return part.model_copy(update={"external": []})


def _drawn_sizes(forces: PairForces) -> Array:
    """Sizes of all that is drawn over speed, shape (S, k): the normal force of each line, the sums over lines."""
    bearings = (rms(forces.bearing_driver), rms(forces.bearing_driven))
    return np.column_stack([*np.abs(forces.normal), rms(forces.normal), *bearings])


def _components(where: str, meaning: str) -> Each:
    """Forces and moments of mesh and bearings."""
    cells = (Cell(quantity, name="{one.name}", meaning=meaning) for quantity in ("force", "moment"))
    return Each(where, *cells)


_SHEET = Sheet(
    of=lambda data, asked: ShownForces(data, asked.teeth),
    tables=(
        Rows(
            "pair_forces_{name}", "Mesh and bearing forces of pair {name} over speed",
            (
                "speed", "mesh_frequency", "mesh_normal",
                _components("over_speed.components", "root mean square over time"), "mesh_normal_error",
            ),
            of="over_speed",
        ),
        Rows(
            "pair_force_spectrum_{name}", "Lines of the mesh and bearing forces of pair {name}",
            ("speed", "order", "source", "frequency", "mesh_normal", _components("lines.components", "0-peak")),
            of="lines",
        ),
    ),
    values=(
        Number("largest.normal", "largest.error"),
        Number("largest.speed"),
        Number("radial", "error", name="largest_bearing_force_{key}", each="bearings"),
    ),
    figures=(
        Chart(
            "pair_forces_{name}", "Mesh and bearing forces of pair {name}",
            "Pair {name}: root mean square of the force along the tooth normal, by spectral lines, and of the "
            "bearing forces on both gears.",
            (drawn_panels("force_panels"),), when="several",
        ),
        Chart(
            "pair_force_spectrum_{name}", "Spectrum of the forces in pair {name}",
            "Pair {name} at {d.spectrum_speed:.6g} of the driver: lines of the force along the tooth normal and of the "
            "bearing forces along the line of action and the axis.",
            (
                Over(
                    Axis("frequency", "kHz", zero=True),
                    (
                        chart.Line(
                            "size", x="frequency", kind="stems", look=lambda seen: {"notes": seen.one.notes},
                            each=Family("rows", "{one.label}", "{one.role}"),
                        ),
                    ),
                    Axis("force amplitude", "N", log=True), title="{one.title}", each="spectrum_panels",
                ),
            ),
            under="{d.spectrum_speed:.6g}",
        ),
    ),
    settings={
        "lines": lambda seen: len(seen.data.data.asked.lines),
        "speeds": lambda seen: int(seen.data.data.asked.speed.size),
    },
)  # fmt: skip


def _pairs(scene: Scene) -> tuple[str, ...]:
    names = tuple(scene.case.transmissibility)
    found = tuple(name for name in names if scene.case.transmissibility[name].excitation is not None)
    return found or names[:1]  # which is refused with the remedy


def _forecast(scene: Scene, name: str) -> Forecast:
    """One response for each line and speed, and those that are drawn, which grow with the lines."""
    excitation = scene.case.transmissibility[name].excitation
    if excitation is None:
        return Forecast()
    error, count = excitation.transmission_error, int(excitation.speeds.array.size)
    harmonics = 0 if error is None else 1 if error.amplitude is not None else error.harmonics or _HARMONICS
    lines = harmonics + len(excitation.external)
    return Forecast({"speeds": count, "lines": lines}, 0.1 + 0.02 * lines + 2e-5 * count * lines)


PAIR_FORCED_RESPONSE = Stage(
    subjects=_pairs,
    needs=_needs,
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    check=_check,
    cites=citing(
        Citation("blankenship-singh", "forces of transmission error and external forces", "Eqs. 9 to 11, 17, 18 and 22")
    ),
    forecast=_forecast,
)
