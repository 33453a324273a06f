"""Stage ``design-chart``: largest dynamic factor over speed, against amount and length of tip relief (TM-89901)."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.engine.citation import Citation, citing
from fegear.engine.figure import Axis, Curve, Figure, Mark, Panel
from fegear.engine.outcome import Column, Outcome, Table, Value
from fegear.engine.stage import Forecast, Need, Stage, Task
from fegear.errors import FegearError, InputError
from fegear.models.motion import excitations_at, motion_inputs
from fegear.models.pair_inputs import pair_inputs
from fegear.models.tooth_influence import gear_to_solve
from fegear.models.train import assemble, train_inputs, train_part
from fegear.results import forecasts
from fegear.results.gear_train import gear_train, the_train
from fegear.results.loaded_pair import loaded_pair
from fegear.results.motion import check_motion
from fegear.results.train_parts import needs_speeds, own_meshes

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.case.dynamics import DesignChartPart
    from fegear.case.reading import Scene
    from fegear.contact import Engagement
    from fegear.dynamics.gear_train import GearTrain
    from fegear.engine.stage import Upstream, Work
    from fegear.geometry.relief import Shape
    from fegear.models.motion import MotionInputs
    from fegear.models.pair_inputs import PairInputs
    from fegear.models.tooth_influence import GearToSolve
    from fegear.models.train import TrainInputs


@dataclass(frozen=True)
class ChartInputs:
    """What the chart depends on.

    Parameters
    ----------
    amounts, lengths : ndarray
        Of tip relief, over Delta and in L_n.
    shape : {"linear", "parabolic"}
    mesh : str
        That is relieved and looked at.
    train : TrainInputs
    motion : MotionInputs
    teeth : PairInputs
        Of that mesh.
    gears : tuple of GearToSolve
        Whose influence functions its compliances come from; empty for closed forms and tables.
    """

    amounts: Array
    lengths: Array
    shape: Shape
    mesh: str
    train: TrainInputs
    motion: MotionInputs
    teeth: PairInputs
    gears: tuple[GearToSolve, ...]


@dataclass(frozen=True)
class Trial:
    """One point of the chart: all that a process needs to compute it."""

    inputs: ChartInputs
    train: GearTrain
    engagement: Engagement
    mesh: int
    amount: float
    length: float
    delta: float


@dataclass(frozen=True)
class DesignChartData:
    """The chart; arrays of shape (amounts, lengths), nan where a point has no result.

    Parameters
    ----------
    amounts, lengths : ndarray
    dynamic_factor, effective_error, speed, contact_loss, unsteady : ndarray
        Largest factor, A_e [m], speed of the largest [rad/s], share of the time without contact, unsteady speeds.
    reasons : tuple of str
        Why a point has no result, the last axis fastest; empty where it has one.
    unmodified : float
        Largest dynamic factor of perfect involutes.
    delta : float
        Welbourn's Delta [m].
    speed_of : str
        Body that speeds refer to.
    """

    amounts: Array
    lengths: Array
    dynamic_factor: Array
    effective_error: Array
    speed: Array
    contact_loss: Array
    unsteady: Array
    reasons: tuple[str, ...]
    unmodified: float
    delta: float
    speed_of: str


def chart_trial(trial: Trial) -> dict[str, float]:
    """Compute one point: largest dynamic factor over the case's speeds, where, and A_e of the static error."""
    from fegear.dynamics.charts import speed_chart
    from fegear.dynamics.excitation import effective_error
    from fegear.dynamics.mesh_excitation import mesh_excitation
    from fegear.dynamics.motion_model import MotionModel
    from fegear.geometry.relief import CombinedRelief, normalised_tip_relief

    asked, i = trial.inputs, trial.mesh
    pair = trial.engagement.pair
    engagement = replace(trial.engagement, driver_relief=CombinedRelief(), driven_relief=CombinedRelief())
    if trial.amount > 0.0:
        amount = trial.amount * trial.delta
        engagement = replace(
            engagement,
            driver_relief=normalised_tip_relief(pair, "driver", amount, trial.length, asked.shape),
            driven_relief=normalised_tip_relief(pair, "driven", amount, trial.length, asked.shape),
        )
    mesh = trial.train.meshes[i]
    found = mesh_excitation(engagement if mesh.a_drives else engagement.reversed(), mesh.force)
    by_mesh = {name: one.excitation for name, one in zip(trial.train.names, trial.train.meshes, strict=True)}
    by_mesh[trial.train.names[i]] = replace(found, phase=mesh.excitation.phase)
    data = assemble(asked.train, by_mesh)
    motion = asked.motion
    speeds = motion.speeds / data.speed_ratio
    model = MotionModel(data.train, excitations_at(motion, data, float(speeds[-1])), 1.0)
    curve = speed_chart(model, speeds, mesh=i, direction=motion.direction, tolerance=motion.tolerance)
    worst, where = curve.worst
    return {
        "dynamic_factor": worst,
        "speed": where * data.speed_ratio,
        "contact_loss": float(curve.apart.max()),
        "unsteady": float(np.count_nonzero(curve.periods == 0)),
        "effective_error": effective_error(data.errors[i]),
    }


def trial_content(trial: Trial) -> object:
    """All that a point's numbers depend on: not the chart that it belongs to, so that a larger one finds it again."""
    asked = trial.inputs
    return (
        asked.shape, asked.mesh, asked.train, asked.motion, asked.teeth, asked.gears,
        trial.amount, trial.length, trial.delta,
    )  # fmt: skip


def _chart(scene: Scene) -> DesignChartPart:
    found = scene.case.dynamics.chart
    if found is None:
        raise InputError(
            "dynamics.chart", "(not given)", "is needed for design-chart",
            "write chart = { amounts = [0.5, 1.0], lengths = [0.6, 0.8, 1.0] }",
        )  # fmt: skip
    return found


def _mesh(scene: Scene) -> str:
    own = own_meshes(scene)
    name = _chart(scene).mesh or (own[0] if own else "")
    if name not in own:
        raise InputError("dynamics.chart.mesh", f'"{name}"', "is no mesh of this train with teeth of its own")
    return name


def _check(scene: Scene, subject: str) -> None:
    needs_speeds(scene, subject)
    check_motion(scene)
    pair = train_part(scene).pair_of(_mesh(scene))
    if scene.case.effects.friction:
        raise InputError("effects.friction", "true", "is not known to design-chart", "remove it")
    ratio = scene.pairs[pair].contact_ratio
    if not 1.0 <= ratio < 2.0:
        raise InputError(
            f"pair.{pair}", f"contact ratio {ratio:.4f}", "has no highest point of single tooth contact, from which "
            "lengths of relief count",
        )  # fmt: skip


def _inputs(scene: Scene, _subject: str) -> ChartInputs:
    part, mesh = _chart(scene), _mesh(scene)
    pair = train_part(scene).loaded_pair_of(mesh)
    teeth = pair_inputs(scene, pair)
    solved = teeth.gears if teeth.compliance.source == "fe" else ()
    return ChartInputs(
        np.unique(part.amounts), np.unique(part.lengths), part.shape, mesh, train_inputs(scene), motion_inputs(scene),
        teeth, tuple(gear_to_solve(scene, gear) for gear in solved),
    )  # fmt: skip


def _compute(asked: ChartInputs, upstream: Upstream, work: Work) -> DesignChartData:
    from fegear.design import welbourn_amount
    from fegear.engine.executor import map_points
    from fegear.engine.point_job import Failure

    data = gear_train(upstream)
    i = data.train.mesh_index(asked.mesh)
    engagement = loaded_pair(upstream, asked.teeth.name).engagement
    delta = welbourn_amount(engagement, float(data.forces[i]))
    reliefs = [(0.0, 0.0), *((float(a), float(n)) for a in asked.amounts for n in asked.lengths)]
    points = [Trial(asked, data, engagement, i, amount, length, delta) for amount, length in reliefs]
    plain, *found = map_points(
        chart_trial, points, work.executor, work.cache, key=trial_content, progress=work.progress
    )
    if isinstance(plain, Failure):
        raise FegearError(f"The unmodified gears of the design chart have no result: {plain.reason}")

    def grid(key: str) -> Array:
        values = [np.nan if isinstance(one, Failure) else cast("dict[str, float]", one)[key] for one in found]
        return np.array(values).reshape(asked.amounts.size, -1)

    return DesignChartData(
        asked.amounts, asked.lengths, grid("dynamic_factor"), grid("effective_error"), grid("speed"),
        grid("contact_loss"), grid("unsteady"), tuple(r.reason if isinstance(r, Failure) else "" for r in found),
        cast("dict[str, float]", plain)["dynamic_factor"], delta, data.speed_of,
    )  # fmt: skip


def _present(chart: DesignChartData, asked: ChartInputs) -> Outcome:
    amounts, lengths = chart.amounts, chart.lengths
    amount, length = np.repeat(amounts, lengths.size), np.tile(lengths, amounts.size)
    table = Table(
        f"design_chart_{asked.mesh}",
        (
            Column("amount", amount, "", "of tip relief over Delta"),
            Column("length", length, "", "L_n, 1 from the tip to the HPSTC"),
            Column("dynamic_factor", chart.dynamic_factor.ravel(), "", "largest over the speeds"),
            Column("speed", chart.speed.ravel(), "rpm", f"of {chart.speed_of}, where it is largest"),
            Column("effective_error", chart.effective_error.ravel(), "um", "A_e of the static transmission error"),
            Column("contact_loss_fraction", chart.contact_loss.ravel(), "", "largest over the speeds"),
            Column("unsteady_speeds", chart.unsteady.ravel(), "", "how many speeds have no repeating motion"),
            Column("failure", np.array(chart.reasons, dtype=str), "", "why a point has no result"),
        ),
        f"Dynamic factor of mesh {asked.mesh} against tip relief",
    )
    about = "Welbourn's Delta: deflection at the HPSTC under the mean force"
    values = [
        Value("design_chart.delta", chart.delta, "um", None, about),
        Value("design_chart.unmodified", chart.unmodified, "", None, "largest dynamic factor of perfect involutes"),
    ]
    for a, row in zip(amounts, chart.dynamic_factor, strict=True):
        if np.isfinite(row).any():
            k = int(np.nanargmin(row))
            values += [
                Value(f"design_chart.best_length_{a:g}", float(lengths[k]), "", None, f"L_n at {a:g} Delta"),
                Value(f"design_chart.least_factor_{a:g}", float(row[k]), "", None, f"at {a:g} Delta"),
            ]
    failures = tuple(
        f"amount {a:.4g} Delta, length {n:.4g}: {reason}"
        for a, n, reason in zip(amount, length, chart.reasons, strict=True)
        if reason
    )
    settings: dict[str, object] = {"points": 1 + amount.size, "speeds": int(asked.motion.speeds.size)}
    return Outcome(chart, (table,), tuple(values), settings, failures, _figures(chart))


def _figures(chart: DesignChartData) -> tuple[Figure, ...]:
    """Largest dynamic factor and A_e over the length of relief for every amount."""
    if chart.lengths.size < 2:
        return ()
    factor, error = (
        tuple(
            Curve(chart.lengths, row, f"{amount:.4g} Δ", f"series:{k}", markers=True)
            for k, (amount, row) in enumerate(zip(chart.amounts, rows, strict=True))
        )
        for rows in (chart.dynamic_factor, chart.effective_error * 1e6)
    )
    length = Axis("length of relief L_{n}")
    plain = Mark("y", chart.unmodified, "unmodified")
    return (
        Figure(
            "design_chart",
            "Design chart of tip relief",
            "Largest dynamic factor over the speeds, and effective error, against the length of tip relief (1 from the "
            f"tip to the highest point of single contact), by amount over Δ = {chart.delta * 1e6:.4g} µm.",
            (
                Panel(length, Axis("largest dynamic factor"), factor, (plain,)),
                Panel(length, Axis("effective error A_{e}", "um", zero=True), error),
            ),
            columns=2,
        ),
    )


def _needs(scene: Scene, _subject: str) -> tuple[Task, ...]:
    return (Task("gear-train"), Task("loaded-pair", train_part(scene).loaded_pair_of(_mesh(scene))))


def _forecast(scene: Scene, _subject: str) -> Forecast:
    """A motion over the speeds for each point of the chart."""
    part = scene.case.dynamics
    if part.chart is None:
        return Forecast()
    points = 1 + len(part.chart.amounts) * len(part.chart.lengths)
    speeds = int(part.speed_values.size)
    return Forecast({"points": points, "speeds": speeds}, points * (0.1 + speeds * forecasts.seconds_per_speed(scene)))


DESIGN_CHART = Stage(
    name="design-chart",
    title="Design chart of tip relief",
    results=("design-chart",),
    about="dynamic factor over amount and length of tip relief",
    subjects=the_train,
    needs=_needs,
    inputs=_inputs,
    compute=_compute,
    present=_present,
    check=_check,
    effects=("contact_loss", "parametric"),
    requires=(
        Need("contact_loss", "reliefs are chosen for the forces at which teeth part"),
        Need("parametric", "relief acts on single tooth pairs, and without it all are one spring"),
    ),
    cites=citing(Citation("lin-townsend-oswald", "design charts of tip relief by dynamic factor")),
    forecast=_forecast,
)
