"""Result ``planet-revolution``: a planetary set of which a tooth differs, until the same teeth mesh again.

Quasi-static loads of the planets and transmission error of the set, their orders and condition indicators, and the
sidebands that a pick-up on the ring sees as planets pass it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeVar

from fegear.base.effects import ODD_TEETH
from fegear.base.errors import InputError
from fegear.base.notes import assuming
from fegear.base.shown import declared, shown, shown_as
from fegear.case.built.odd_gears import odd_gears_of
from fegear.case.built.planetary import pin_errors, planetary_part, set_inputs
from fegear.case.planetary import set_pair
from fegear.dynamics.planetary.phases import whole_delays
from fegear.dynamics.planetary.planet_loads import PlanetLoads, planet_loads
from fegear.dynamics.planetary.set_cycle import mean_force, set_cycle
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.axis import Axis
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Chart, Family, Line, Over
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Forecast, Stage, Task
from fegear.results.pair.loaded_teeth import over_revolution_task, pair_over_revolution
from fegear.results.pair.mesh_stiffness_revolution import INDICATORS
from fegear.results.planetary.planet_load_sharing import (
    check_set,
    effects_of_set,
    given_or_wide_teeth,
    solved_meshes,
)
from fegear.results.planetary.planet_set import planetary_sets

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from fegear.base.arrays import Array
    from fegear.case.built.planetary import SetInputs
    from fegear.case.planetary import Mesh
    from fegear.case.reading import Scene
    from fegear.contact.plane.engagement import Engagement
    from fegear.dynamics.planetary.mesh_law import MeshTeeth
    from fegear.dynamics.planetary.set_revolution import SetRevolution
    from fegear.dynamics.planetary.set_signals import RingLines
    from fegear.engine.sheet.seen import Seen
    from fegear.engine.stage import Upstream, Work
    from fegear.geometry.pair import Member

#: Seconds of the laws of a set with odd teeth, and of the equilibrium over a base pitch.
_LAWS, _PITCH = 3.0, 0.02
#: What a mesh makes of its engagements.
Teeth = TypeVar("Teeth")


@dataclass(frozen=True)
class SetRevolutionInputs:
    """What a set with odd teeth depends on besides its pairs.

    Parameters
    ----------
    asked : SetInputs
    errors : ndarray, shape (2, planets)
        Of the pins, radial and counter-clockwise [m].
    odd_planet : int
        From 0.
    planet : mapping of mesh to {"driver", "driven"}
        What the planet is in its pairs.
    teeth : tuple of int
        Numbers of teeth of the gears with odd teeth.
    of_planet : bool
        Whether the planets are among them.
    name : str
    """

    asked: SetInputs
    errors: Array
    odd_planet: int
    planet: dict[Mesh, Member]
    teeth: tuple[int, ...]
    of_planet: bool
    name: str

    @property
    def clockwise(self) -> bool:
        """Whether the sun turns clockwise relative to the carrier."""
        return self.asked.run.sun_turns < 0.0

    @property
    def delays(self) -> Array:
        """Which teeth meet where (`whole_delays`) [base pitches], shape (2, planets)."""
        asked = self.asked
        return whole_delays(
            asked.found, asked.phases, self.odd_planet, clockwise=self.clockwise, sun_drives=asked.run.sun_drives
        )

    def of_planets(
        self, mesh: Mesh, odd: Sequence[Engagement], teeth: Callable[[Sequence[Engagement]], Teeth]
    ) -> tuple[Teeth, ...]:
        """Teeth of a mesh of every planet: the odd ones of planets are those of one of them.

        Parameters
        ----------
        mesh : {"sun", "ring"}
        odd : sequence of Engagement
            With the odd teeth.
        teeth : callable
            What is made of them, and of the same with ordinary planets.
        """
        from fegear.dynamics.planetary.set_revolution import with_ordinary_teeth

        found = teeth(odd)
        if not self.of_planet:
            return (found,) * self.asked.model.count
        plain = teeth([with_ordinary_teeth(one, self.planet[mesh]) for one in odd])
        return tuple(found if n == self.odd_planet else plain for n in range(self.asked.model.count))


def odd_gears_of_set(scene: Scene, name: str) -> tuple[str, ...]:
    """Gears of a set with odd teeth, in meshes that are solved."""
    pairs = (set_pair(name, mesh) for mesh in solved_meshes(scene, name))
    return tuple(dict.fromkeys(gear for pair in pairs for gear in odd_gears_of(scene, pair)))


def revolution_inputs(scene: Scene, name: str) -> SetRevolutionInputs:
    """Collect what a case says of a set and of its teeth that differ."""
    part, odd = planetary_part(scene, name), odd_gears_of_set(scene, name)
    planet: dict[Mesh, Member] = {}
    for mesh in solved_meshes(scene, name):
        pair = scene.case.pair[set_pair(name, mesh)]
        planet[mesh] = "driver" if pair.driver == part.planet else "driven"
    return SetRevolutionInputs(
        set_inputs(scene, name), pin_errors(part), part.odd_planet - 1, planet,
        tuple(scene.gears[gear].teeth for gear in odd), part.planet in odd, name,
    )  # fmt: skip


def _compute(inputs: SetRevolutionInputs, upstream: Upstream, work: Work) -> SetRevolution:
    from fegear.dynamics.planetary.set_revolution import SetRevolution

    asked = inputs.asked
    run = asked.run
    laws = _laws(inputs, "sun", upstream), _laws(inputs, "ring", upstream)
    cycle = set_cycle(asked.model, laws, asked.phases, asked.sun_torque, run.input, inputs.delays)
    work.progress(0.8)
    frequency = run.mesh_frequency if asked.at_speed else math.nan
    loads = planet_loads(cycle, inputs.errors)
    return SetRevolution(loads, inputs.odd_planet, inputs.teeth, frequency, inputs.clockwise)


def _laws(inputs: SetRevolutionInputs, mesh: Mesh, upstream: Upstream) -> Sequence[MeshTeeth]:
    """Teeth of a mesh of every planet."""
    from fegear.dynamics.planetary.mesh_law import LawSprings

    asked = inputs.asked
    count, load = asked.model.count, mean_force(asked.model, asked.sun_torque)
    found = given_or_wide_teeth(asked, mesh, upstream)
    if found is not None:
        return [found] * count
    pair = pair_over_revolution(upstream, set_pair(asked.name, mesh))
    both = (pair.engagement, *pair.shifted)
    return inputs.of_planets(mesh, both, lambda each: LawSprings(each[0], tuple(each[1:]), load, count))


@dataclass(frozen=True)
class PlanetOver:
    """Load of one planet over all base pitches, and its error where the teeth have one; shape (M,)."""

    error: Array | None
    s: Array = shown_as(declared(PlanetLoads, "s"))
    load: Array = shown("N", "mesh force of this planet with the sun, along the line of action")
    load_ring: Array = shown("N", "mesh force of this planet with the ring, along the line of action")


@dataclass(frozen=True)
class ShownRevolution:
    """What is shown of a set over all base pitches."""

    found: SetRevolution
    te_error: Array | None
    planets: dict[str, PlanetOver]

    @property
    def loads(self) -> PlanetLoads:
        """Of the planets."""
        return self.found.loads

    @property
    def at_ring(self) -> RingLines | None:
        """Lines at the ring; None where the planets' forces cancel, as four about a floating sun do."""
        lines = self.found.at_ring
        return lines if lines.order.size else None

    @property
    def odd_number(self) -> int:
        """Number of the planet with odd teeth, from 1."""
        return self.found.odd_planet + 1


def _shown(data: SetRevolution, _inputs: SetRevolutionInputs) -> ShownRevolution:
    loads = data.loads
    known = bool(loads.cycle.off.size)

    def planet(n: int) -> PlanetOver:
        error = loads.shift(lambda one: one.mesh_force[0, n]) if known else None
        return PlanetOver(error, loads.s, loads.mesh_force[0, n], loads.mesh_force[1, n])

    planets = {str(n + 1): planet(n) for n in range(loads.mesh_force.shape[1])}
    return ShownRevolution(data, loads.shift(lambda one: one.te) if known else None, planets)


def orders_and_lines(result: str, of: str, what: str) -> tuple[tuple[Rows, ...], tuple[Chart, ...]]:
    """Tables and figures of orders and of lines at the ring.

    Parameters
    ----------
    result : str
        Beginning of their names.
    of : str
        Where the orders are.
    what : str
        The transmission error in words.
    """
    orders, lines = f"{result}_orders_{{name}}", f"{result}_lines_{{name}}"
    return (
        Rows(
            orders, f"Orders of the {what} and of the mesh force of set {{name}}",
            ("n", "mesh_order", "frequency", "te", "load"), of=of,
        ),
        Rows(
            lines, "Lines at the ring of set {name} as planets pass",
            ("order", "frequency", "force_order", "passing", "force"), of="at_ring",
        ),
    ), (
        Chart(
            orders, f"Orders of the {what} of set {{name}}",
            f"Set {{name}}: amplitudes of the {what} over the order of the tooth-mesh frequency; integers are mesh "
            "harmonics, the others are due to teeth that differ.",
            (Over("mesh_order", (Line("te", kind="stems"),)),),
            of=of,
        ),
        Chart(
            lines, "Sidebands at the ring of set {name}",
            "Set {name}: amplitudes of the ring mesh forces, seen at the ring as planets pass, over the order of the "
            "tooth-mesh frequency.",
            (Over("order", (Line("force", kind="stems"),)),),
            of="at_ring",
        ),
    )  # fmt: skip


def _answer(seen: Seen) -> Iterator[str]:
    data: SetRevolution = seen.data.found
    if data.base_pitches > 1:
        yield (
            f"Set {seen.name}: the transmission error changes by up to {data.te_residual_max * 1e6:.3g} µm by the odd "
            f"teeth, which mesh again after {data.base_pitches} base pitches."
        )


ODD_REMARKS = (
    Remark(
        "Set {name}: ring mesh forces of the planets cancel as they pass (opposite planets have equal forces); no "
        "lines at the ring.",
        when=lambda seen: seen.data.found.base_pitches > 1 and seen.data.at_ring is None,
    ),
    Remark(
        "Set {name}: all teeth are identical and all base pitches equal; describe [[gear.NAME.odd_tooth]] and set "
        "odd_teeth = true under [effects] for teeth that differ.",
        when=lambda seen: seen.data.found.base_pitches == 1,
    ),
    Remark(
        assuming(
            "Set {name}: tooth 0 of planet {d.odd_number} meshes with tooth 0 of the sun, and on its other flank "
            "with tooth 0 of the ring; the teeth of the other planets are identical."
        ),
        when=lambda seen: seen.data.found.base_pitches > 1,
    ),
)  # fmt: skip
_OVER = Axis("mesh cycle, in base pitches")
_TABLES, _FIGURES = orders_and_lines("planet_revolution", "found.orders", "transmission error")
_SHEET = Sheet(
    of=_shown,
    name=lambda inputs: inputs.name,
    tables=(
        Rows(
            "planet_revolution_{name}",
            "Loads and transmission error of set {name} over {d.found.base_pitches} base pitches",
            (
                "loads.s", Cell("loads.te", error="te_error"), "found.te_residual",
                Cell("load", each="planets", ending="_{key}", error="error"),
                Cell("load_ring", each="planets", ending="_{key}", error="error"),
            ),
            matlab=True,
        ),
        *_TABLES,
    ),
    values=(
        *(
            Number(f"loads.{one}", f"loads.{one}_error", name=f"revolution_{one}", further=", over all base pitches")
            for one in ("largest_share", "te_peak_to_peak")
        ),
        Number("found.te_residual_max", name="set_te_residual_max"),
        *(Number(key, of="found.indicators", name="set_" + key) for key in INDICATORS),
    ),
    figures=(
        Chart(
            "planet_revolution_{name}", "Transmission error and planet loads of set {name} over all base pitches",
            "Set {name}: transmission error at the {d.loads.cycle.driving}, its residual, and mesh forces of the "
            "planets with the sun over {d.found.base_pitches} base pitches, until the same teeth mesh again.",
            (
                Over(
                    _OVER,
                    (
                        Line("loads.te", "transmission error", x="loads.s", look={"markers": False}),
                        Line("found.te_residual", "residual", "red", x="loads.s", look={"markers": False}),
                    ),
                    Axis("transmission error", "um"),
                ),
                Over(
                    _OVER,
                    (Line("load", x="s", each=Family("planets", "planet {key}", most=None), look={"markers": False}),),
                    Axis("mesh force", "N", zero=True),
                ),
            ),
        ),
        *_FIGURES,
    ),
    answer=Answer(_answer, figure="planet_revolution_{name}"),
    remarks=(
        *ODD_REMARKS,
    ),
    settings={"base_pitches": "found.base_pitches", "odd_planet": "odd_number"},
)  # fmt: skip


def check_revolution(scene: Scene, name: str) -> None:
    """Refuse what is not available of sets with odd teeth."""
    check_set(scene, name)
    planet = planetary_part(scene, name).planet
    if scene.case.effects.spacing_errors and scene.case.gear[planet].spacing_errors is not None:
        raise InputError(
            f"gear.{planet}.spacing_errors", "(given)", "are not available for planets (all would have the same)",
            "remove them, or switch effects.spacing_errors off",
        )  # fmt: skip


def needs_revolution(scene: Scene, name: str) -> tuple[Task, ...]:
    """The tasks that make the teeth of its meshes, odd ones too."""
    return tuple(over_revolution_task(scene, set_pair(name, mesh)) for mesh in solved_meshes(scene, name))


def _forecast(scene: Scene, name: str) -> Forecast:
    odd = [scene.gears[gear].teeth for gear in odd_gears_of_set(scene, name)]
    pitches = math.lcm(*odd) if odd else 1
    return Forecast({"base pitches": pitches}, _LAWS + _PITCH * pitches)


PLANET_REVOLUTION = Stage(
    subjects=planetary_sets,
    needs=needs_revolution,
    inputs=revolution_inputs,
    compute=_compute,
    present=_SHEET.present,
    check=check_revolution,
    effects_of=lambda scene, name: (*effects_of_set(scene, name), ODD_TEETH.name),
    cites=citing(
        Citation("mark", "load sharing of coupled tooth pairs", "App. A"),
        Citation("mcfadden-smith", "sidebands of planets passing a sensor"),
        Citation("zakrajsek-townsend-decker", "condition indicators FM0, FM4, energy ratio"),
    ),
    forecast=_forecast,
)
