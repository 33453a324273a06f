"""Stage ``flank-root-stress``: result ``root-stress-history`` of pairs with a width, with the stress along the face.

Figure of root stress over the face: largest tension up the fillet over face position and way of the tooth.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.case.built.loaded_flanks import FLANK_EFFECTS
from fegear.case.built.pair_inputs import gear_name
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.figure import Axis, Figure, Panel
from fegear.engine.figure.items import HeatMap
from fegear.engine.outcome import Outcome, Value
from fegear.engine.stage import Forecast, Stage
from fegear.engine.table import Column, Table
from fegear.geometry.pair import MEMBERS
from fegear.results import forecasts
from fegear.results.forecasts import RING
from fegear.results.gear.stiffness_over_face import needs_solid_solution, solid_solution_of
from fegear.results.pair.loaded_flanks import loaded_flanks, needs_flanks, wide_pairs
from fegear.results.pair.root_stress_history import stress_figure, stress_table, stress_values, table_names

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.contact.plane.tooth_stress import ToothStress
    from fegear.contact.wide.root_stress import StressOverFace
    from fegear.engine.stage import Task, Upstream, Work
    from fegear.fem.plane.influence import Side
    from fegear.geometry.pair import Member
    from fegear.results.pair.loaded_flanks import LoadedFlanksData


#: Places along the face per module, at which stress is looked for, and how many at least.
_PER_MODULE, _FEWEST = 4.0, 17


#: Seconds of a roll position, both gears and both solutions, for each load.
_SECONDS = 0.05


_SIDES: tuple[tuple[Side, float], ...] = (("tension", 1.0), ("compression", -1.0))


@dataclass(frozen=True)
class FlankRootStressInputs:
    """What this stage reads.

    Parameters
    ----------
    rate : float or None
        Velocity of the contact along the line of action [m/s], where the case gives a speed.
    name : str
        Of the pair.
    labels, gears : mapping of str to str
        Names of the tables and of the gears by member.
    """

    rate: float | None
    name: str = field(compare=False)
    labels: Mapping[Member, str] = field(compare=False)
    gears: Mapping[Member, str] = field(compare=False)


@dataclass(frozen=True)
class FlankRootStressData:
    """What the stage hands to tables and pictures.

    Parameters
    ----------
    loaded : LoadedFlanksData
    stress : mapping of Member to ToothStress
        Largest over the face, under every load.
    over_face : mapping of Member to mapping of Side to StressOverFace
        At the nominal load.
    across : mapping of Member to (float, float)
        Helical gears: largest tension at right angles to the helix at the nominal load, and its estimated error [Pa].
    """

    loaded: LoadedFlanksData
    stress: Mapping[Member, ToothStress]
    over_face: Mapping[Member, Mapping[Side, StressOverFace]]
    across: Mapping[Member, tuple[float, float]]


def places_along(loaded: LoadedFlanksData) -> Array:
    """Places along the face at which root stress is looked for [m], both ends among them."""
    lines, module = loaded.found.lines, loaded.found.pair.driver.module
    count = max(_FEWEST, 2 * round(0.5 * _PER_MODULE * (lines.high - lines.low) / module) + 1)
    return np.linspace(lines.low, lines.high, count)


def _inputs(scene: Scene, name: str) -> FlankRootStressInputs:
    speed = scene.case.pair[name].speed
    rate = None if speed is None else speed * scene.pairs[name].driver.base_radius
    gears = {member: gear_name(scene, name, member) for member in MEMBERS}
    return FlankRootStressInputs(rate, name, table_names(scene, name), gears)


def _compute(asked: FlankRootStressInputs, upstream: Upstream, work: Work) -> FlankRootStressData:
    from fegear.contact.plane.tooth_stress import ToothStress
    from fegear.contact.wide.root_stress import rooted_lines
    from fegear.fem.plane.root_stress import curves_apart
    from fegear.fem.solid.influence import ENTRY_SHARES

    loaded = loaded_flanks(upstream, asked.name)
    found, coarse, z = loaded.found, loaded.error.coarse, places_along(loaded)
    coupling = loaded.asked.effects.neighbour_coupling
    stress: dict[Member, ToothStress] = {}
    maps: dict[Member, dict[Side, StressOverFace]] = {}
    across: dict[Member, tuple[float, float]] = {}
    for number, member in enumerate(MEMBERS):
        influence = solid_solution_of(upstream, asked.gears[member])
        rooted = rooted_lines(found.pair, member, found.lines, influence.fine, coupling=coupling)
        again = influence.coarse and rooted_lines(found.pair, member, coarse.lines, influence.coarse, coupling=coupling)
        largest: dict[Side, list[Array]] = {"tension": [], "compression": []}
        off = []
        for i in range(found.load.size):
            felt = {side: rooted.stress(side, found.contact.force[:, :, i], z) for side, _ in _SIDES}
            for side, sign in _SIDES:
                largest[side].append(felt[side].largest(sign)[0])
            if i == loaded.nominal:
                maps[member] = felt
            if again:
                other = again.stress("tension", coarse.contact.force[:, :, i], z)
                by_coarse = np.stack([np.interp(rooted.x, other.x, at) for at in other.value.T], axis=1)
                off.append(ENTRY_SHARES["root_tension"] * curves_apart(felt["tension"].value, by_coarse))
            else:  # slices know how far they are off
                off.append(influence.error.get("root_tension", np.nan) * np.abs(largest["tension"][-1]))
        tension, compression, error = (np.stack(x, axis=1) for x in (largest["tension"], largest["compression"], off))
        stress[member] = ToothStress(rooted.x, tension, compression, error)
        if found.pair.driver.helix_angle and influence.coarse:  # slices know no shear along the face
            n = loaded.nominal
            largest_across = rooted.largest("tension", found.contact.force[:, :, n], z, across=True)
            worst = int(np.argmax(tension[:, n]))
            share = error[worst, n] / tension[worst, n]
            across[member] = largest_across, float(share * largest_across)
        work.progress((number + 1) / len(MEMBERS))
    return FlankRootStressData(loaded, stress, maps, across)


def _present(data: FlankRootStressData, inputs: FlankRootStressInputs) -> Outcome:
    name, loaded, pair = inputs.name, data.loaded, data.loaded.found.pair
    i, loads = loaded.nominal, loaded.asked.loads
    tables, values = [], []
    shown = {member: {"fe": one} for member, one in data.stress.items()}
    for member, label in inputs.labels.items():
        gear, over = inputs.gears[member], data.over_face[member]
        more = _places(over)
        tables.append(stress_table(label, gear, shown[member], i, inputs.rate, loads, more))
        tables.append(_over_face(label, gear, over))
        where = _where(data.stress[member], over, i)
        values += stress_values(f"{name}.{member}", "", f"gear {gear}, {where}", data.stress[member], i)
        values += _across_the_root(f"{name}.{member}", gear, data.across.get(member))
    figures = (
        stress_figure(name, pair, loads[i], shown, i, inputs.gears),
        root_stress_map(name, loads[i], data.over_face, inputs.gears),
    )
    settings = {"places_along_the_face": int(data.over_face["driver"]["tension"].z.size)}
    remarks = () if not data.across else (_direction(data, inputs, i),)
    return Outcome(data, tuple(tables), tuple(values), settings, remarks, figures=figures)


def _across_the_root(of: str, gear: str, found: tuple[float, float] | None) -> list[Value]:
    if found is None:
        return []
    value, error = found
    told = f"gear {gear}: largest tension at right angles to the helix, as formulas for the normal section mean it"
    return [Value(f"{of}.largest_root_tension_across", value, "MPa", None if np.isnan(error) else error, told)]


def _direction(data: FlankRootStressData, inputs: FlankRootStressInputs, i: int) -> str:
    """What the direction of the stress makes of it."""
    more = " and ".join(
        f"{100.0 * (value / data.stress[member].tension[:, i].max() - 1.0):+.1f} % ({member})"
        for member, (value, _) in data.across.items()
    )
    return (
        f"Pair {inputs.name}: root stresses over the mesh and the face are those along the transverse section; the "
        f"largest at right angles to the helix differs by {more}: values largest_root_tension_across."
    )


def _places(over: Mapping[Side, StressOverFace]) -> tuple[Column, ...]:
    pull, press = over["tension"].largest(1.0)[1], over["compression"].largest(-1.0)[1]
    at = np.argmax(over["tension"].value, axis=1)
    radius = over["tension"].radius[np.arange(at.size), at]
    return (
        Column("stress_face_position", pull, "mm", "where stress is largest along the face, from its middle"),
        Column("stress_radius", radius, "mm", "and its distance from the axis"),
        Column("compression_face_position", press, "mm", "where compression is largest along the face"),
    )


def _where(stress: ToothStress, over: Mapping[Side, StressOverFace], i: int) -> str:
    worst = int(np.argmax(stress.tension[:, i]))
    z = float(over["tension"].largest(1.0)[1][worst])
    return f"largest tension at face position {z * 1e3:.4g} mm"


def _over_face(label: str, gear: str, over: Mapping[Side, StressOverFace]) -> Table:
    """Every place along the face at every position of the tooth, at the nominal load."""
    pull, press = over["tension"], over["compression"]
    columns = (
        Column("x", np.repeat(pull.x, pull.z.size), "mm", "position of the tooth's contact in the middle of the face"),
        Column("face_position", np.tile(pull.z, pull.x.size), "mm", "from the middle of the face"),
        Column("stress", pull.value.ravel(), "MPa", "largest tension up the fillet below the loaded flank"),
        Column("radius", pull.radius.ravel(), "mm", "where it sits, from the axis"),
        Column("compression", press.value.ravel(), "MPa", "most negative stress up the other fillet"),
        Column("compression_radius", press.radius.ravel(), "mm", "where it sits, from the axis"),
    )
    return Table(f"root_stress_over_face_{label}", columns, f"Root stress of gear {gear} along its face in the mesh")


def needs_flank_roots(scene: Scene, name: str) -> tuple[Task, ...]:
    """The tasks of a pair's loaded flanks and of both gears' solutions."""
    part = scene.case.pair[name]
    return (*needs_flanks(scene, name), *needs_solid_solution(part.driver, part.driven))


def _forecast(scene: Scene, name: str) -> Forecast:
    positions, loads = scene.case.load_distribution.positions, forecasts.loads(scene, name)
    return Forecast({"positions": positions, "loads": loads}, 0.5 + _SECONDS * positions * loads)


#: Points of the map over the way of the tooth and along the face.
_ACROSS, _ALONG = 181, 81


def root_stress_map(
    name: str, load: float, over_face: Mapping[Member, Mapping[Side, StressOverFace]], gears: Mapping[Member, str]
) -> Figure:
    """Draw both gears with one scale of colours."""
    maps = {member: over["tension"] for member, over in over_face.items()}
    top = max(float(one.value.max()) for one in maps.values()) * 1e-6
    panels = []
    for member, one in maps.items():
        # Roll positions stand unevenly; straight between them.
        x, z = np.linspace(one.x[0], one.x[-1], _ACROSS), np.linspace(one.z[0], one.z[-1], _ALONG)
        way = np.stack([np.interp(x, one.x, along) for along in one.value.T]) * 1e-6
        value = np.stack([np.interp(z, one.z, along) for along in way.T], axis=1)
        panels.append(
            Panel(
                Axis("position of the tooth's contact on the line of action", "mm"), Axis("face position z", "mm"),
                (HeatMap(x * 1e3, z * 1e3, value, "largest root tension", "MPa", limits=(0.0, top)),),
                title=f"{member} {gears[member]}: {one.value.max() * 1e-6:.4g} MPa",
            )
        )  # fmt: skip
    return Figure(
        f"root_stress_over_face_{name}",
        f"Root stress over the face of pair {name}",
        f"Pair {name}: largest tension up the fillet of a tooth of either gear along its face, on its way through the "
        "mesh; the position is that of its contact line in the middle of the face.",
        tuple(panels),
        under=f"{load:.5g} N",
    )


FLANK_ROOT_STRESS = Stage(
    subjects=wide_pairs,
    needs=needs_flank_roots,
    inputs=_inputs,
    compute=_compute,
    present=_present,
    effects=FLANK_EFFECTS,
    cites=citing(
        *RING, Citation("mark", "root stress of a tooth on its way through the mesh", "section 3, Appendix B")
    ),
    forecast=_forecast,
)
