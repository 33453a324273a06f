"""Result ``misalignment``: how far shafts, bearings and housing misalign each mesh, and what opens over its face."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from fegear.base.errors import InputError
from fegear.base.printed import figures
from fegear.base.shown import shown, shows
from fegear.case.built.shafts import mesh_places
from fegear.case.reading import Scene
from fegear.contact.wide.on_shafts import LoadedShafts
from fegear.engine.citation import Citation, citing
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.seen import Seen
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Stage, Upstream, Work
from fegear.results import forecasts
from fegear.results.shafts.gearbox_changes import CAUSE_WORDS
from fegear.results.shafts.loaded_shafts import LOADED_SHAFTS_TASK, loaded_shafts, shafts_of
from fegear.shafts.gearbox import CAUSES, MeshGap, MeshMisalignment, MeshState


@dataclass(frozen=True)
class MisalignmentData:
    """Misalignment of every mesh, under every load.

    Parameters
    ----------
    shafts : LoadedShafts
    states : tuple of tuple of MeshState
        One row for each of its states.
    """

    shafts: LoadedShafts
    states: tuple[tuple[MeshState, ...], ...]


def _compute(_inputs: None, upstream: Upstream, _work: Work) -> MisalignmentData:
    shafts = loaded_shafts(upstream)
    rows = tuple(shafts.gearbox.misalignment(one.bent, one.forces) for one in shafts.states)
    return MisalignmentData(shafts, rows)


@dataclass(frozen=True)
class MisalignedMesh:
    """A mesh under one load, by cause.

    Parameters
    ----------
    shares : MeshMisalignment
    gap : MeshGap
    """

    shares: MeshMisalignment
    gap: MeshGap
    pair: str = shown("", "gear pair")
    load: float = shown("N", "along the transverse line of action")
    end: str = shown("", "end of the shafts to which it refers", name="end_II")

    @property
    @shows("", "cause of misalignment")
    def cause(self) -> tuple[str, ...]:
        """Names of the rows."""
        return ("all", *CAUSES)


@dataclass(frozen=True)
class MisalignedMeshes:
    """Every mesh of a gearbox."""

    found: MisalignmentData

    def _under(self, n: int, k: int) -> MisalignedMesh:
        """Mesh number n under load number k."""
        mesh = self.found.shafts.gearbox.meshes[n]
        load, end = self.found.shafts.states[k].scale * mesh.load, "left" if mesh.sense > 0 else "right"
        return MisalignedMesh(*self.found.states[k][n], mesh.pair, load, end)

    @property
    def under_all(self) -> list[MisalignedMesh]:
        """Under every load, mesh by mesh."""
        shafts = self.found.shafts
        return [self._under(n, k) for n in range(len(shafts.gearbox.meshes)) for k in range(len(shafts.states))]

    @property
    def nominal(self) -> list[MisalignedMesh]:
        """Under the nominal loads."""
        shafts = self.found.shafts
        return [self._under(n, shafts.states.index(shafts.nominal)) for n in range(len(shafts.gearbox.meshes))]


def _gap_by(n: int, cause: str) -> Cell:
    """Share of a cause in a gap."""
    return Cell("gap.by_cause", lambda seen: seen.one.gap.by_cause[n], name=f"gap_{cause}", meaning=CAUSE_WORDS[cause])


def _line_by(n: int, cause: str) -> Line:
    """The same as a curve."""
    return Line(
        "gap.by_cause", cause, f"series:{n + 1}", look={"markers": False}, si=lambda seen: seen.one.gap.by_cause[n]
    )


def _worst_first(seen: Seen) -> list[MisalignedMesh]:
    return sorted(seen.data.nominal, key=lambda one: -abs(one.shares.over_face[0]))


def _sentences(seen: Seen) -> Iterator[str]:
    """Every mesh, the most misaligned first, with its main cause."""
    for k, one in enumerate(_worst_first(seen)):
        every, by = one.shares.over_face[0] * 1e6, one.shares.over_face[1:] * 1e6
        main = int(np.argmax(np.abs(by)))
        most = f", the maximum of {len(seen.data.nominal)} meshes" if k == 0 and len(seen.data.nominal) > 1 else ""
        yield (
            f"Pair {one.pair}: misaligned by {figures(every)} µm over the face width{most}; main cause "
            f"{CAUSE_WORDS[CAUSES[main]]} ({figures(by[main])} µm)."
        )


_SHEET = Sheet(
    answer=Answer(_sentences, figure=lambda seen: f"shaft_gap_{_worst_first(seen)[0].pair}"),
    of=lambda data, _asked: MisalignedMeshes(data),
    name=lambda _asked: "",
    tables=(
        Rows(
            "misalignment", "Mesh misalignment by cause",
            ("pair", "load", "cause", *(f"shares.{key}" for key in MeshMisalignment.__dataclass_fields__), "end"),
            stacked="under_all",
        ),
        Rows(
            "shaft_gap_{one.pair}", "Gap due to shafts over the face of pair {one.pair}",
            (
                "gap.z", "gap.gap", *(_gap_by(n, cause) for n, cause in enumerate(CAUSES)), "gap.line_load",
            ),
            each="nominal",
        ),
    ),
    values=(
        Number(
            "shares.over_face", si=lambda seen: seen.one.shares.over_face[0], owner="{one.pair}",
            name="shaft_misalignment", each="nominal",
            meaning="misalignment over the face width in the plane of action, towards end II, from shafts, bearings "
                    "and housing",
        ),
    ),
    figures=(
        Chart(
            "shaft_gap_{one.pair}", "Gap due to shafts over the face of pair {one.pair}",
            "Pair {one.pair}: gap of the flanks in the plane of action due to shafts, bearings and housing: total, "
            "and by cause.",
            (
                Over(
                    "gap.z",
                    (
                        Line("gap.gap", "total", "series:0", look={"markers": False}),
                        *(_line_by(n, cause) for n, cause in enumerate(CAUSES)),
                    ),
                ),
            ),
            each="nominal",
        ),
    ),
)  # fmt: skip


def _check(scene: Scene, _name: str) -> None:
    if not mesh_places(scene):
        raise InputError("shaft", "(no pair)", "has no mesh to evaluate", "mount both gears of a pair on shafts")


MISALIGNMENT = Stage(
    subjects=shafts_of,
    inputs=lambda _scene, _name: None,
    compute=_compute,
    present=_SHEET.present,
    needs=lambda _scene, _name: (LOADED_SHAFTS_TASK,),
    cites=citing(Citation("cowper", "shear coefficient of hollow circles")),
    check=_check,
    forecast=lambda _scene, _name: forecasts.constant(0.01),
)
