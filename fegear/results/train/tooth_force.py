"""Stage ``tooth-force``: force on one tooth pair of the linearised train through its engagement."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array
from fegear.base.shown import shown, shows
from fegear.engine.citation import Citation, citing
from fegear.engine.declared import drawn
from fegear.engine.figure.axis import Axis, Scale
from fegear.engine.sheet.chart import ALL, Chart, Family, Line, Over
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Forecast, Reads, Stage, Upstream, Work
from fegear.results.gear.path_marks import LINE_OF_ACTION, path_marks
from fegear.results.train.gear_train import (
    RPM,
    from_exciter,
    gear_train,
    needs_one_speed,
    needs_train,
    own_meshes,
    pull_remarks,
    what_excites,
)

if TYPE_CHECKING:
    from fegear.case.dynamics import DynamicsPart
    from fegear.case.reading import Scene
    from fegear.dynamics.train.gear_train import GearTrain
    from fegear.dynamics.train.single_tooth import MeshForce
    from fegear.dynamics.train.tooth_force import Pull, ToothForce
    from fegear.engine.figure.items import Mark, Zone
    from fegear.engine.sheet.seen import Seen


@dataclass(frozen=True)
class LargestForce:
    """Largest force on a tooth pair, and where."""

    end: str
    about: str
    force: float = shown("N", "maximum force", name="largest_tooth_force")
    x: float = shown("mm", "position of the tooth pair on the line of action")


@dataclass(frozen=True)
class Part:
    """What one exciter of the train adds to the force on a tooth pair."""

    name: str
    label: str
    role: str
    increment: Array
    peak: float | None = shown("N", "over the engagement and all relative phases", name="largest_increment")


@dataclass(frozen=True)
class ToothForceData:
    """Force on one tooth pair through its engagement.

    Parameters
    ----------
    train : GearTrain
    mesh : int
        Its number.
    force : ToothForce
    number : int
        Of the tooth pair; 0 is at the pitch point at phase zero.
    harmonics : int
        That it is summed from.
    pull : Pull or None
        How far the mesh force falls below zero.
    together : MeshForce
        What all tooth pairs in contact carry together.
    """

    train: GearTrain
    mesh: int
    force: ToothForce
    number: int
    harmonics: int
    pull: Pull | None
    together: MeshForce

    @property
    def alone(self) -> bool:
        """Whether nothing but this mesh excites the train."""
        return len(self.train.exciters) == 1

    @property
    @shows("N", "quasi-static", name="largest_static_tooth_force")
    def static(self) -> float:
        """[N]."""
        return float(self.force.static.max())

    @property
    def largest(self) -> list[LargestForce]:
        """With, at any phase of, and without what else excites the train."""
        force, others = self.force, others_of(self.train)
        together = "" if self.alone else f"all meshes{rippled(self.train)}, at the phases of the case, "
        parts = [("", force.with_others, together)]
        if not self.alone:
            parts += [
                ("_any_phase", force.at_worst_phases, f"upper bound over all phases of {others}, "),
                ("_own_mesh", force.total, f"without {others}, "),
            ]
        return [
            LargestForce(end, about, float(of.max()), float(force.x[int(np.argmax(of))])) for end, of, about in parts
        ]

    @property
    def parts(self) -> list[Part]:
        """Increments by everything that excites the train."""
        return [
            Part(
                name, from_exciter(self.train, j), f"series:{j}",
                self.force.own if j == self.mesh else self.force.cross[j],
                None if j == self.mesh else float(self.force.cross_peak[j]),
            )
            for j, name in enumerate(self.train.exciters)
        ]  # fmt: skip

    @property
    def cross(self) -> list[Part]:
        """Increments by everything but this mesh."""
        return [one for one in self.parts if one.peak is not None]

    @property
    def uneven(self) -> int:
        """How many tooth pairs differ; 1 if none does."""
        return self.train.meshes[self.mesh].error.pitches

    @property
    def letters(self) -> list[Mark | Zone]:
        """Points of the path of contact."""
        return list(path_marks(self.train.meshes[self.mesh].pair))

    @property
    def mean(self) -> Mark:
        """Mean mesh force."""
        from fegear.engine.figure.items import Mark

        return Mark("y", float(self.train.forces[self.mesh]))


def _compute(asked: Reads[DynamicsPart], upstream: Upstream, _work: Work) -> ToothForceData:
    from fegear.dynamics.train.single_tooth import force_history, heaviest_pair, mesh_force, summed_harmonics
    from fegear.dynamics.train.tooth_force import largest_pull

    data = gear_train(upstream)
    i, part = data.train.mesh_index(asked.name), asked.part
    number, harmonics, speed = heaviest_pair(data, i), summed_harmonics(data, part.harmonics), part.one_speed
    force = force_history(data, i, speed, part.positions, harmonics, number)
    pull = largest_pull(data, i, [speed / data.speed_ratio], part.harmonics)
    together = mesh_force(data, i, speed, part.positions, harmonics, number)
    return ToothForceData(data, i, force, number, harmonics, pull, together)


def others_of(data: GearTrain) -> str:
    """What excites a mesh besides itself, in words."""
    ripple = "torque ripple" if data.ripple else ""
    return " and ".join(filter(None, ("the other meshes" if len(data.names) > 1 else "", ripple)))


def rippled(data: GearTrain) -> str:
    """What follows "all meshes" where torques fluctuate, too."""
    return " and torque ripple" if data.ripple else ""


def over_time(force: ToothForce) -> Axis:
    """The line of action as abscissa, with the time on the far side."""
    return replace(
        LINE_OF_ACTION, second=Scale("time from phase zero of the mesh", "ms", drawn(force, "x"), force.time * 1e3)
    )


def _while(data: ToothForceData) -> str:
    """From when to when a tooth pair is followed."""
    if data.train.meshes[data.mesh].pair.driver.helix_angle == 0.0:
        return "from first contact at A to last contact at E"
    return "while its contact line crosses the plane of action (position of the middle of the line)"


def _whole_mesh(seen: Seen) -> str:
    return (
        f"sum of the forces on the tooth pairs in contact, all meshes{rippled(seen.data.train)}, at the phases of the "
        "case"
    )


def _under(seen: Seen) -> str:
    return f"{seen.asked.part.one_speed * RPM:.6g} rpm"


_SHEET = Sheet(
    tables=(
        Rows(
            "tooth_force_{name}", "Force on one tooth pair of mesh {name}",
            (
                "time", "x", "total", "with_others", "static", "own",
                Cell(
                    "cross", "increment", lambda seen: seen.data.force, "increment_from_{one.name}",
                    each=lambda seen: seen.data.cross,
                ),
            ),
            of="force",
        ),
        Rows(
            "mesh_force_of_teeth_{name}",
            "Force in mesh {name} over one base pitch, by its teeth and by its mean stiffness",
            ("time", "phase", "of_teeth", "by_mean_stiffness", "pairs"), of="together",
        ),
    ),
    values=(
        Number(
            "force", name="largest_tooth_force{one.end}", meaning="{one.about}at x = {one.x:.5g}", each="largest"
        ),
        "static",
        Number("peak", name="largest_increment_from_{one.name}", each="cross"),
        Number(
            "of_teeth", of="together", si=lambda seen: seen.data.together.of_teeth.max(),
            name="largest_mesh_force_of_teeth", meaning=_whole_mesh,
        ),
        Number(
            "of_teeth", of="together", si=lambda seen: seen.data.together.of_teeth.min(),
            name="least_mesh_force_of_teeth", meaning=_whole_mesh,
        ),
        Number(
            "by_mean_stiffness", of="together", si=lambda seen: seen.data.together.by_mean_stiffness.max(),
            name="largest_mesh_force_by_mean_stiffness",
            meaning="of the linearised train (spectral lines of the mesh force)",
        ),
    ),
    figures=(
        Chart(
            "tooth_force_{name}", "Force on one tooth pair of mesh {name}",
            lambda seen: f"Mesh {seen.name}: force on one tooth pair {_while(seen.data)}; horizontal line: mean mesh "
            f"force. Below: dynamic increment by {what_excites(seen.data.train)}.",
            (
                Over(
                    lambda seen: over_time(seen.data.force),
                    (
                        Line("static", "static", "static"), Line("total", "static and own increment", "own force"),
                        Line(
                            "with_others", lambda seen: f"with {others_of(seen.data.train)}", "with other meshes",
                            when=lambda seen: not seen.data.alone,
                        ),
                    ),
                    "total", lambda seen: (*seen.data.letters, seen.data.mean), {"zero": True}, panel={"height": 1.2},
                ),
                Over(
                    LINE_OF_ACTION,
                    (
                        Line(
                            "own", si="increment", of=lambda seen: seen.data.force,
                            each=Family("parts", "{one.label}", "{one.role}", most=ALL),
                        ),
                    ),
                    "own", "letters", panel={"height": 0.8},
                ),
            ),
            of="force", under=_under,
        ),
        Chart(
            "mesh_force_of_teeth_{name}", "Force in mesh {name} over one base pitch",
            "Mesh {name}: total force of the tooth pairs in contact, and force by the mean stiffness. "
            "Both use the same dynamic transmission error; the tooth forces use the instantaneous stiffness, the mesh "
            "force the mean stiffness. Horizontal line: mean force.",
            (
                Over(
                    Axis("phase", "base pitches"),
                    (
                        Line(
                            "by_mean_stiffness", "by the mean stiffness", "static", x="phase",
                            look={"dash": "dash", "markers": False},
                        ),
                        Line("of_teeth", "sum of the teeth", "own force", x="phase", look={"markers": False}),
                    ),
                    "of_teeth", lambda seen: [seen.data.mean], {"zero": True},
                ),
            ),
            of="together", under=_under,
        ),
    ),
    remarks=(
        lambda seen: pull_remarks(seen.data.pull),
        Remark(
            "Mesh {name}: with pitch deviations; of {d.uneven} tooth pairs, number {d.number} with the largest static "
            "load is shown (number 0 is at the pitch point at phase zero).",
            when=lambda seen: seen.data.uneven > 1,
        ),
    ),
    settings={"harmonics": "harmonics", "speed": lambda seen: seen.asked.part.one_speed},
)  # fmt: skip


def _forecast(scene: Scene, _name: str) -> Forecast:
    """At least 256 harmonics at one speed."""
    part = scene.case.dynamics
    harmonics = max(part.harmonics, 256)
    return Forecast({"harmonics": harmonics, "positions": part.positions}, 0.06 * harmonics / 256)


TOOTH_FORCE = Stage(
    subjects=own_meshes,
    needs=needs_train,
    inputs=Reads.of(lambda scene: scene.case.dynamics),
    compute=_compute,
    present=_SHEET.present,
    check=needs_one_speed,
    cites=citing(Citation("mark", "force on a single tooth pair", "Eqs. 3.23 to 3.36")),
    forecast=_forecast,
)
