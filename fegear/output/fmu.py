"""A loaded gear pair as a functional mock-up unit (FMI 3.0): mesh force from angles, speeds and load.

The springs are those of fegear's own motion in time, for every load of the pair, as tables in C beside `fmu_mesh.c`,
which evaluates them. The unit holds the source and a library for the machine that it is written on.

From a case to the meshes that its FMUs hold: loaded pairs, and what their train says of damping and backlash.
"""

from __future__ import annotations

import hashlib
import math
import os
import platform
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile
from dataclasses import dataclass, replace
from itertools import accumulate
from pathlib import Path
from typing import TYPE_CHECKING, cast
from xml.sax.saxutils import quoteattr

import numpy as np

from fegear import __version__
from fegear.base.errors import InputError
from fegear.case.built.train import train_inputs
from fegear.dynamics.train.gear_train import a_drives
from fegear.dynamics.train.train_spec import build_train
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.output.file_names import file_name
from fegear.results.catalogue import STAGES
from fegear.results.pair.loaded_teeth import loaded_pairs, odd_teeth_task, teeth_of

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.contact.loaded_teeth import LoadedTeeth
    from fegear.contact.plane.loaded_pair import LoadedPair
    from fegear.contact.wide.loaded_pair import LoadedWidePair
    from fegear.dynamics.train.excitation import MeshExcitation
    from fegear.dynamics.train.periodic import Periodic
    from fegear.geometry.pair import GearPair
    from fegear.output.export_formats import Request, Written


_SOURCE = Path(__file__).with_name("fmu_mesh.c")
#: A step of a stiffness or a separation by more of its largest value is a jump, which integrators are warned of.
_JUMP = 1e-6
#: Backlash of meshes whose back flanks never touch [m].
_NEVER_USED_UP = 1.0
#: Name, unit, causality and variability, description; in the order of the value references of `fmu_mesh.c`.
_VARIABLES = (
    ("time", "s", "independent", "continuous", "Time"),
    ("driver_angle", "rad", "input", "continuous", "Angle of the driver, positive in its direction of rotation"),
    ("driven_angle", "rad", "input", "continuous", "Angle of the driven gear, positive in its direction of rotation"),
    ("driver_speed", "rad/s", "input", "continuous", "Speed of the driver"),
    ("driven_speed", "rad/s", "input", "continuous", "Speed of the driven gear"),
    ("load", "N", "input", "continuous", "Mean mesh force used for linearisation (not the instantaneous force)"),
    ("backlash", "m", "parameter", "tunable", "Along the line of action"),
    ("damping", "N.s/m", "parameter", "tunable", "Along the line of action, with teeth in contact"),
    ("phase", "", "parameter", "tunable", "Base pitches from the pitch point at driver_angle = 0"),
    ("mesh_force", "N", "output", "continuous", "Along the line of action, negative for back-side contact"),
    (
        "driver_torque",
        "N.m",
        "output",
        "continuous",
        "Mesh torque on the driver, positive in its direction of rotation",
    ),
    (
        "driven_torque",
        "N.m",
        "output",
        "continuous",
        "Mesh torque on the driven gear, positive in its direction of rotation",
    ),
    ("approach", "m", "output", "continuous", "Dynamic transmission error along the line of action"),
    ("mesh_stiffness", "N/m", "output", "continuous", "Mesh stiffness of the teeth in contact"),
    ("static_transmission_error", "m", "output", "continuous", "Approach of the gears under the static load"),
)
_BASE_UNITS = {
    "s": 's="1"', "rad": 'rad="1"', "rad/s": 'rad="1" s="-1"', "N": 'kg="1" m="1" s="-2"', "m": 'm="1"',
    "N.s/m": 'kg="1" s="-1"', "N.m": 'kg="1" m="2" s="-2"', "N/m": 'kg="1" s="-2"',
}  # fmt: skip


@dataclass(frozen=True)
class MeshModel:
    """A gear pair as what an FMU of it holds.

    Parameters
    ----------
    name : str
    pair : GearPair
        As it runs: its driver drives.
    loads : tuple of float
        Mean mesh forces, ascending [N].
    nominal : float
        The one of them that it starts with [N].
    excitations : tuple of MeshExcitation
        Its springs under each load.
    backlash, damping : float
        Along the transverse line of action [m, N s/m].
    follows_stiffness : bool
        Whether the damping follows the stiffness of the teeth that touch.
    """

    name: str
    pair: GearPair
    loads: tuple[float, ...]
    nominal: float
    excitations: tuple[MeshExcitation, ...]
    backlash: float
    damping: float = 0.0
    follows_stiffness: bool = False

    @property
    def springs(self) -> list[tuple[Periodic, Periodic]]:
        """Stiffness and separation of all springs, load by load."""
        return [pair for e in self.excitations for pair in zip(e.stiffness, e.separation, strict=True)]


def write_fmu(folder: Path, model: MeshModel) -> Path:
    """Write ``mesh_<pair>.fmu``.

    Raises
    ------
    InputError
        If there is no C compiler, or it fails.
    """
    identifier = re.sub(r"\W", "_", f"mesh_{file_name(model.name)}", flags=re.ASCII)
    tables = _tables(model)
    token = hashlib.sha256((_SOURCE.read_text(encoding="utf-8") + tables).encode()).hexdigest()
    tables = f'#define TOKEN "{token}"\n{tables}'
    build = (
        '<?xml version="1.0" encoding="UTF-8"?>\n<fmiBuildDescription fmiVersion="3.0">\n'
        f'  <BuildConfiguration modelIdentifier="{identifier}">\n'
        '    <SourceFileSet language="C99"><SourceFile name="mesh.c"/></SourceFileSet>\n'
        "  </BuildConfiguration>\n</fmiBuildDescription>\n"
    )
    parts = {
        "modelDescription.xml": _description(model, identifier, token).encode(),
        "sources/buildDescription.xml": build.encode(),
        "sources/mesh.c": _SOURCE.read_bytes(),
        "sources/mesh_tables.h": tables.encode(),
    }
    machine, ending = _machine()
    parts[f"binaries/{machine}/{identifier}{ending}"] = _library(parts, ending)
    target = folder / f"{identifier}.fmu"
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in parts.items():  # dated alike, so that the same pair gives the same file
            archive.writestr(zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0)), content, zipfile.ZIP_DEFLATED)
    return target


def c_compiler() -> str:
    """The C compiler of this machine.

    Raises
    ------
    InputError
        If there is none.
    """
    for one in (os.environ.get("CC", ""), "cc", "gcc", "clang"):
        if one and (found := shutil.which(one)):
            return found
    raise InputError(
        "--format", "fmu", "requires a C compiler; cc, gcc and clang not found",
        "install one (Debian: apt-get install gcc), or set the environment variable CC",
    )  # fmt: skip


def _machine() -> tuple[str, str]:
    """Platform as FMI 3.0 names it, and the ending of its libraries."""
    word = platform.machine().lower()
    processor = {"amd64": "x86_64", "arm64": "aarch64"}.get(word, word)
    system, ending = {"win32": ("windows", ".dll"), "darwin": ("darwin", ".dylib")}.get(sys.platform, ("linux", ".so"))
    return f"{processor}-{system}", ending


def _library(parts: dict[str, bytes], ending: str) -> bytes:
    compiler = c_compiler()
    with tempfile.TemporaryDirectory() as scratch:
        for name in ("mesh.c", "mesh_tables.h"):
            (Path(scratch) / name).write_bytes(parts[f"sources/{name}"])
        words = [compiler, "-O2", "-std=c99", "-shared", "-fPIC", "-o", f"mesh{ending}", "mesh.c", "-lm"]
        made = subprocess.run(words, cwd=scratch, capture_output=True, text=True, check=False)  # noqa: S603  (the user's)
        if made.returncode:
            last = (made.stderr.strip().splitlines() or ["no message"])[-1]
            raise InputError(
                "--format", "fmu", f"could not be compiled by {compiler}: {last}", "set another compiler in CC"
            )
        return (Path(scratch) / f"mesh{ending}").read_bytes()


def _tables(model: MeshModel) -> str:
    """``mesh_tables.h``: the springs, piece by piece, with all their digits."""
    springs, pair = model.springs, model.pair
    pieces = [_on_one_grid(k, e) for k, e in springs]
    degree = max(rows.shape[2] for _, rows, _ in pieces) - 1
    jumps, over = _jumps(springs)
    defined = {
        "LOADS": len(model.loads), "SPRINGS": len(springs), "DEGREE": degree, "INDICATORS": _indicators(model),
        "JUMPS": len(jumps), "JUMP_PERIOD": repr(float(over)), "TEETH": repr(float(pair.driver.teeth)),
        "R_DRIVER": repr(float(pair.driver.base_radius)), "R_DRIVEN": repr(float(pair.driven.base_radius)),
        "NOMINAL_LOAD": repr(model.nominal), "START_BACKLASH": repr(model.backlash),
        "START_DAMPING": repr(model.damping), "START_PHASE": repr(float(model.excitations[0].phase)),
        "FOLLOWS_STIFFNESS": int(model.follows_stiffness),
    }  # fmt: skip
    width = [(0, 0), (0, 0), (0, 0)]
    rows = [np.pad(one, [*width[:2], (0, degree + 1 - one.shape[2])]) for _, one, _ in pieces]
    counts = [len(e.stiffness) for e in model.excitations]
    table = np.concatenate(rows)
    lines = [f"#define {name} {value}" for name, value in defined.items()]
    lines += [
        _array("double", "load_of", model.loads),
        _array("double", "mean_stiffness", [1.0 / e.mean_compliance() for e in model.excitations]),
        _array("int", "first_spring", [0, *accumulate(counts)]),
        _array("int", "first_piece", [0, *accumulate(len(one) for one in rows)]),
        _array("double", "period", [float(pitches) for _, _, pitches in pieces]),
        _array("double", "start_of", np.concatenate([starts for starts, _, _ in pieces]).tolist()),
        _array("double", "jump", jumps or [0.0]),
    ]
    for q, name in enumerate(("stiffness", "separation")):
        body = ",\n".join("{" + ", ".join(repr(float(c)) for c in row[q]) + "}" for row in table)
        lines.append(f"static const double {name}[][DEGREE + 1] = {{\n{body}\n}};")
    return "\n".join(lines) + "\n"


def _array(kind: str, name: str, values: Iterable[float]) -> str:
    return f"static const {kind} {name}[] = {{{', '.join(map(repr, values))}}};"


def _on_one_grid(k: Periodic, e: Periodic) -> tuple[Array, Array, int]:
    """Starts of the pieces of a spring in its period, their coefficients (pieces, 2, powers), and the period."""
    from fegear.dynamics.motion.packed_model import on_breaks

    pitches = math.lcm(k.pitches, e.pitches)
    cuts = np.unique(np.concatenate([k.breaks_over(pitches), e.breaks_over(pitches)])) / pitches
    cuts = cuts[np.append(True, np.diff(cuts) > 1e-11)]
    cuts[-1] = 1.0
    degree = max(part.coefficients.shape[1] for part in (k, e)) - 1
    return cuts[:-1], np.stack([on_breaks(part, cuts, pitches, degree) for part in (k, e)], axis=1), pitches


def _jumps(springs: list[tuple[Periodic, Periodic]]) -> tuple[list[float], int]:
    """Phases at which a stiffness or a separation jumps, over the common period [base pitches]."""
    over = math.lcm(*(part.pitches for spring in springs for part in spring))
    found: set[float] = set()
    for part in (part for spring in springs for part in spring):
        places = part.breaks_over(over)[:-1]
        ends = part.coefficients.sum(axis=1)
        starts = (part.coefficients * (-1.0) ** np.arange(part.coefficients.shape[1])).sum(axis=1)
        steps = np.tile(np.abs(starts - np.roll(ends, 1)), over // part.pitches)
        scale = float(np.abs(part.coefficients[:, 0]).max())
        found.update(np.round(places[steps > _JUMP * scale], 12).tolist())
    return sorted(found), over


def _indicators(model: MeshModel) -> int:
    """One for jumps, one for the back flanks, one for each spring."""
    return 2 + len(model.springs)


def _description(model: MeshModel, identifier: str, token: str) -> str:
    """``modelDescription.xml``."""
    starts = [0.0, 0.0, 0.0, 0.0, 0.0, model.nominal, model.backlash, model.damping, model.excitations[0].phase]
    lines = []
    for number, (name, unit, causality, variability, text) in enumerate(_VARIABLES):
        words = f'name="{name}" valueReference="{number}" causality="{causality}" variability="{variability}"'
        words += f' unit="{unit}"' if unit else ""
        words += f' start="{float(starts[number])!r}"' if causality in ("input", "parameter") else ""
        lines.append(f"    <Float64 {words} description={quoteattr(text)}/>")
    first = len(_VARIABLES)
    events = range(first, first + _indicators(model))
    lines += [
        f'    <Float64 name="event_indicator_{n - first}" valueReference="{n}" causality="local"/>' for n in events
    ]
    outputs = [n for n, one in enumerate(_VARIABLES) if one[2] == "output"]
    structure = [f'    <Output valueReference="{n}"/>' for n in outputs]
    structure += [f'    <InitialUnknown valueReference="{n}"/>' for n in outputs]
    structure += [f'    <EventIndicator valueReference="{n}"/>' for n in events]
    units = [f'    <Unit name="{name}"><BaseUnit {base}/></Unit>' for name, base in _BASE_UNITS.items()]
    pair, same = model.pair, 'canGetAndSetFMUState="true" canSerializeFMUState="true"'
    about = f"Mesh of {pair.driver.teeth} and {pair.driven.teeth} teeth, base radii "
    about += f"{pair.driver.base_radius:.9g} and {pair.driven.base_radius:.9g} m"
    return "\n".join(
        [
            '<?xml version="1.0" encoding="UTF-8"?>',
            f'<fmiModelDescription fmiVersion="3.0" modelName={quoteattr(f"mesh_{model.name}")}',
            f'  instantiationToken="{token}" description={quoteattr(about)} generationTool="fegear {__version__}">',
            f'  <ModelExchange modelIdentifier="{identifier}" {same}/>',
            f'  <CoSimulation modelIdentifier="{identifier}" {same} canHandleVariableCommunicationStepSize="true"/>',
            "  <UnitDefinitions>", *units, "  </UnitDefinitions>",
            '  <DefaultExperiment startTime="0" stopTime="1"/>',
            "  <ModelVariables>", *lines, "  </ModelVariables>",
            "  <ModelStructure>", *structure, "  </ModelStructure>",
            "</fmiModelDescription>\n",
        ]
    )  # fmt: skip


def mesh_models(scene: Scene) -> list[tuple[MeshModel, str]]:
    """Every loaded pair of a case, solved, with a remark on where its damping and backlash come from.

    Raises
    ------
    InputError
        If the case has no pair, or one cannot be loaded.
    """
    if not scene.pairs:
        raise InputError("pair", "(not given)", "is required for an FMU", "add [pair.NAME]")
    tasks = [odd_teeth_task(scene, name) for name in loaded_pairs(scene)]
    alone = replace(scene, case=scene.case.model_copy(update={"results": []}), estimates=False)
    found = run_plan(alone, make_plan(alone, STAGES, tasks)).outcomes
    return [_model(scene, task.subject, cast("LoadedTeeth", teeth_of(task, found[task].data))) for task in tasks]


def _model(scene: Scene, name: str, teeth: LoadedTeeth) -> tuple[MeshModel, str]:
    part, forward, mesh = scene.case.train, True, None
    of = [m for m, one in part.mesh.items() if one.like is None and part.pair_of(m) == name] if part else []
    if part and of:
        number = list(part.mesh).index(of[0])
        forward = a_drives(build_train(train_inputs(scene).spec))[number]
    found = tuple(_springs(teeth, load, forward=forward) for load in teeth.loads)
    about = "no damping specified; set its parameter damping"
    if part and of:
        stiffness = 1.0 / found[teeth.loads.index(teeth.nominal)].mean_compliance()
        mesh = build_train(train_inputs(scene).spec, {of[0]: stiffness}).meshes[number]
        found = tuple(replace(one, phase=part.mesh[of[0]].phase) for one in found)
        about = f"damping and phase from train.mesh.{of[0]}"
    pair = teeth.pair if forward else teeth.pair.reversed()
    backlash = min(mesh.backlash, _NEVER_USED_UP) if mesh else pair.free_backlash
    model = MeshModel(
        name, pair, teeth.loads, teeth.nominal, found, backlash, mesh.damping if mesh else 0.0,
        mesh is not None and mesh.damping_law == "momentary",
    )  # fmt: skip
    return model, (
        f"Pair {name}, FMU: {about}; tooth friction neglected; forces linearised at the {len(teeth.loads)} "
        f"load{'s' if len(teeth.loads) > 1 else ''} of the pair and interpolated between them."
    )


def _springs(teeth: LoadedTeeth, load: float, *, forward: bool) -> MeshExcitation:
    """The springs of a pair under a mean load [N], as the motion of a train takes them."""
    if hasattr(teeth, "flanks"):
        from fegear.dynamics.train.flank_excitation import flank_excitation

        wide = cast("LoadedWidePair", teeth)
        return flank_excitation(wide.flanks, wide.flanks.solve([load], wide.gaps, wide.known), forward=forward)
    from fegear.dynamics.train.mesh_excitation import mesh_excitation

    engagement = cast("LoadedPair", teeth).engagement
    return mesh_excitation(engagement if forward else engagement.reversed(), load)


def written_fmu(request: Request) -> Written:
    """Write the FMU of every loaded pair."""
    models = mesh_models(request.scene)
    return [write_fmu(request.folder, model) for model, _ in models], [said for _, said in models]
