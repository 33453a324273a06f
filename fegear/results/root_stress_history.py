"""Stage ``root-stress-history``: root stress of one tooth of either gear on its way through the mesh."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.citation import Citation, citing
from fegear.engine.figure import Axis, Curve, Figure, Mark, Panel
from fegear.engine.outcome import Column, Outcome, Table, Value
from fegear.engine.stage import Forecast, Stage
from fegear.errors import InputError
from fegear.geometry.pair import MEMBERS
from fegear.models.pair_checks import check_relief
from fegear.models.pair_inputs import gear_name
from fegear.results import forecasts
from fegear.results.loaded_pair import EFFECTS, engagement_marks, needs_pair, spur_pairs
from fegear.results.sources import RING
from fegear.results.transmission_error import POSITIONS

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.case.reading import Scene
    from fegear.contact.tooth_stress import ToothStress
    from fegear.engine.stage import Upstream, Work
    from fegear.geometry.pair import Member
    from fegear.models.loaded_pair import LoadedPair


@dataclass(frozen=True)
class RootStressData:
    """What the stage hands to pictures."""

    pair: LoadedPair
    stress: dict[Member, ToothStress]


def _check(scene: Scene, name: str) -> None:
    check_relief(scene, name)
    source = scene.case.pair[name].compliance.source
    if source != "fe":
        raise InputError(f"pair.{name}.compliance.source", f'"{source}"', "knows no root stress", 'set source = "fe"')


def _table(name: str, gear: str, s: ToothStress, i: int, rate: float | None, loads: tuple[float, ...]) -> Table:
    columns = [
        Column("x", s.x, "mm", "position of the tooth's contact on the line of action"),
        Column("stress", s.tension[:, i], "MPa", "largest tangential tension of the fillet below the loaded flank"),
        Column("compression", s.compression[:, i], "MPa", "most negative stress of the other fillet"),
        Column("stress_error", s.tension_error[:, i], "MPa", "estimated error of stress"),
    ]
    if rate is not None:
        columns.insert(0, Column("t", (s.x - s.x[0]) / rate, "s", "from the first position"))
    for k, load in enumerate(loads):
        if k != i:
            columns.append(Column(f"stress at {load:.6g} N", s.tension[:, k], "MPa", "as stress, under this load"))
    return Table(f"root_stress_history_{name}", tuple(columns), f"Root stress of a tooth of gear {gear} in the mesh")


def table_names(scene: Scene, name: str) -> dict[Member, str]:
    """``<pair>_<gear>``; where a gear meshes with its like the driven one's name ends in ``_driven``."""
    names = {member: gear_name(scene, name, member) for member in MEMBERS}
    twins = names["driver"] == names["driven"]
    return {m: f"{name}_{g}" + ("_driven" if twins and m == "driven" else "") for m, g in names.items()}


@dataclass(frozen=True)
class RootStressInputs:
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


def _inputs(scene: Scene, name: str) -> RootStressInputs:
    speed = scene.case.pair[name].speed
    rate = None if speed is None else speed * scene.pairs[name].driver.base_radius
    gears = {member: gear_name(scene, name, member) for member in MEMBERS}
    return RootStressInputs(rate, name, table_names(scene, name), gears)


def _compute(_inputs: RootStressInputs, upstream: Upstream, work: Work) -> RootStressData:
    from fegear.contact.mesh_curve import roll_positions
    from fegear.contact.tooth_stress import tooth_stress

    (found,) = upstream.values()
    pair: LoadedPair = found.pair
    x = roll_positions(pair.engagement, POSITIONS)
    stress: dict[Member, ToothStress] = {}
    for number, member in enumerate(MEMBERS):
        stress[member] = tooth_stress(pair.engagement, pair.shifted, pair.loads, x, member)
        work.progress((number + 1) / len(MEMBERS))
    return RootStressData(pair, stress)


def _present(data: RootStressData, inputs: RootStressInputs) -> Outcome:
    name, pair = inputs.name, data.pair
    i = pair.loads.index(pair.nominal)
    tables, values = [], []
    for member, label in inputs.labels.items():
        s, gear = data.stress[member], inputs.gears[member]
        tables.append(_table(label, gear, s, i, inputs.rate, pair.loads))
        worst, least = int(np.argmax(s.tension[:, i])), int(np.argmin(s.compression[:, i]))
        values += [
            Value(
                f"{name}.{member}.largest_root_tension", float(s.tension[worst, i]), "MPa",
                float(s.tension_error[worst, i]), f"gear {gear}, contact at x = {s.x[worst] * 1e3:.5g} mm",
            ),
            Value(
                f"{name}.{member}.largest_root_compression", float(s.compression[least, i]), "MPa", None,
                f"gear {gear}, contact at x = {s.x[least] * 1e3:.5g} mm",
            ),
            Value(
                f"{name}.{member}.root_stress_range", float(np.ptp(s.tension[:, i])), "MPa", None,
                "largest less smallest stress below the loaded flank over the mesh",
            ),
        ]  # fmt: skip
    figures = (_figure(name, data, inputs.gears),)
    return Outcome(data, tuple(tables), tuple(values), figures=figures)


def _figure(name: str, data: RootStressData, gears: Mapping[Member, str]) -> Figure:
    pair, stress = data.pair, data.stress
    i, curves = pair.loads.index(pair.nominal), []
    for member, s in stress.items():
        tension, error, compression = (v[:, i] * 1e-6 for v in (s.tension, s.tension_error, s.compression))
        label = f"{member} {gears[member]}"
        curves.append(Curve(s.x * 1e3, tension, f"{label}, tension", member, error))
        curves.append(Curve(s.x * 1e3, compression, f"{label}, compression", f"{member} compression", width=1.2))
    largest = " and ".join(f"{s.tension[:, i].max() * 1e-6:.4g} MPa ({member})" for member, s in stress.items())
    x = Axis("position of the tooth's contact on the line of action", "mm")
    return Figure(
        f"root_stress_history_{name}",
        f"Root stress through the mesh of pair {name}",
        f"Pair {name} at {pair.nominal:.5g} N: fillet stress of one tooth, its own load's and its neighbours' "
        f"added. A to E: points of the path of contact. Largest tension {largest}.",
        (Panel(x, Axis("largest root stress", "MPa"), tuple(curves), (*engagement_marks(pair), Mark("y", 0.0))),),
        under=f"{pair.nominal:.5g} N",
    )


def _forecast(scene: Scene, _name: str) -> Forecast:
    """Kernels of both gears over the path, and those of their neighbours."""
    seconds = 0.25 if scene.case.effects.corner_contact else 0.12
    return forecasts.constant(seconds if scene.case.effects.neighbour_coupling else 0.3 * seconds)


ROOT_STRESS_HISTORY = Stage(
    name="root-stress-history",
    title="Root stress through the mesh",
    results=("root-stress-history",),
    about="root stress of both gears as a tooth passes through the mesh",
    subjects=spur_pairs,
    needs=needs_pair,
    inputs=_inputs,
    compute=_compute,
    present=_present,
    check=_check,
    effects=EFFECTS,
    cites=citing(
        *RING, Citation("mark", "root stress of a tooth on its way through the mesh", "section 3, Appendix B")
    ),
    forecast=_forecast,
)
