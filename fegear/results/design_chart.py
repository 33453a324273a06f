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
from fegear.models.motion import excitations_at
from fegear.models.train import assemble, train_inputs, train_part
from fegear.results import forecasts
from fegear.results.dynamic_factor import check_motion
from fegear.results.gear_train import gear_train, the_train
from fegear.results.loaded_pair import loaded_pair
from fegear.results.train_parts import needs_speeds, own_meshes

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.case.dynamics import DesignChartPart
    from fegear.case.reading import Scene
    from fegear.contact import Engagement
    from fegear.dynamics.gear_train import GearTrain
    from fegear.engine.stage import Done, Work

    Array = NDArray[np.float64]


@dataclass(frozen=True)
class Trial:
    """One point of the chart: all that a process needs to compute it."""

    scene: Scene
    train: GearTrain
    engagement: Engagement
    mesh: int
    amount: float
    length: float
    delta: float


@dataclass(frozen=True)
class DesignChartData:
    """The chart; arrays of shape (amounts, lengths), nan where a point has no result."""

    amounts: Array
    lengths: Array
    dynamic_factor: Array
    effective_error: Array
    unmodified: float
    delta: float
    failures: tuple[str, ...]


def chart_trial(trial: Trial) -> dict[str, float]:
    """Compute one point: largest dynamic factor over the case's speeds, where, and A_e of the static error."""
    from fegear.dynamics.charts import speed_chart
    from fegear.dynamics.excitation import effective_error
    from fegear.dynamics.mesh_excitation import mesh_excitation
    from fegear.dynamics.motion_model import MotionModel
    from fegear.geometry.relief import CombinedRelief, normalised_tip_relief

    scene, i = trial.scene, trial.mesh
    part, pair = scene.case.dynamics, trial.engagement.pair
    engagement = replace(trial.engagement, driver_relief=CombinedRelief(), driven_relief=CombinedRelief())
    if trial.amount > 0.0:
        chart = part.chart
        shape = chart.shape if chart else "linear"
        amount = trial.amount * trial.delta
        engagement = replace(
            engagement,
            driver_relief=normalised_tip_relief(pair, "driver", amount, trial.length, shape),
            driven_relief=normalised_tip_relief(pair, "driven", amount, trial.length, shape),
        )
    mesh = trial.train.meshes[i]
    found = mesh_excitation(engagement if mesh.a_drives else engagement.reversed(), mesh.force)
    by_mesh = {name: one.excitation for name, one in zip(trial.train.names, trial.train.meshes, strict=True)}
    by_mesh[trial.train.names[i]] = replace(found, phase=mesh.excitation.phase)
    data = assemble(train_inputs(scene), by_mesh)
    speeds = part.speed_values / data.speed_ratio
    model = MotionModel(data.train, excitations_at(scene, data, float(speeds[-1])), 1.0)
    curve = speed_chart(model, speeds, mesh=i, direction=part.direction, tolerance=part.tolerance)
    worst, where = curve.worst
    return {
        "dynamic_factor": worst,
        "speed": where * data.speed_ratio,
        "contact_loss": float(curve.apart.max()),
        "unsteady": float(np.count_nonzero(curve.periods == 0)),
        "effective_error": effective_error(data.errors[i]),
    }


def trial_content(trial: Trial) -> object:
    """All that a point's numbers depend on."""
    case = trial.scene.case
    plain = case.model_dump(include={"gear", "pair", "train", "effects", "accuracy"})
    dynamics = case.dynamics.model_dump()
    chart = dynamics.pop("chart")
    excitations = [mesh.excitation for mesh in trial.train.meshes]
    springs = [(f.breaks, f.coefficients) for e in excitations for f in (*e.stiffness, *e.separation)]
    return (
        plain,
        dynamics,
        chart["shape"] if chart else "",
        springs,
        trial.mesh,
        trial.amount,
        trial.length,
        trial.delta,
    )


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
        raise InputError("effects.friction", "true", "is not known to design-chart", "leave it out")
    ratio = scene.pairs[pair].contact_ratio
    if not 1.0 <= ratio < 2.0:
        raise InputError(
            f"pair.{pair}", f"contact ratio {ratio:.4f}", "has no highest point of single tooth contact, from which "
            "lengths of relief count",
        )  # fmt: skip


def _run(scene: Scene, _subject: str, done: Done, progress: Work) -> Outcome:
    from fegear.design import welbourn_amount
    from fegear.engine.executor import map_points
    from fegear.engine.point_job import Failure

    part, name, data = _chart(scene), _mesh(scene), gear_train(done)
    i = data.train.mesh_index(name)
    engagement = loaded_pair(done, train_part(scene).loaded_pair_of(name)).engagement
    delta = welbourn_amount(engagement, float(data.forces[i]))
    amounts, lengths = np.unique(part.amounts), np.unique(part.lengths)
    points = [Trial(scene, data, engagement, i, 0.0, 0.0, delta)]
    points += [Trial(scene, data, engagement, i, float(a), float(n), delta) for a in amounts for n in lengths]
    found = map_points(
        chart_trial, points, progress.executor, progress.cache, key=trial_content, progress=progress.progress
    )
    failures = tuple(
        f"amount {p.amount:.4g} Delta, length {p.length:.4g}: {r.reason}"
        for p, r in zip(points, found, strict=True)
        if isinstance(r, Failure)
    )
    if isinstance(found[0], Failure):
        raise FegearError(f"The unmodified gears of the design chart have no result: {found[0].reason}")

    def column(key: str) -> Array:
        return np.array([np.nan if isinstance(r, Failure) else cast("dict[str, float]", r)[key] for r in found[1:]])

    reasons = [r.reason if isinstance(r, Failure) else "" for r in found[1:]]
    factor, error = column("dynamic_factor"), column("effective_error")
    table = Table(
        f"design_chart_{name}",
        (
            Column("amount", np.repeat(amounts, lengths.size), "", "of tip relief over Delta"),
            Column("length", np.tile(lengths, amounts.size), "", "L_n, 1 from the tip to the HPSTC"),
            Column("dynamic_factor", factor, "", "largest over the speeds"),
            Column("speed", column("speed"), "rpm", f"of {data.speed_of}, where it is largest"),
            Column("effective_error", error, "um", "A_e of the static transmission error"),
            Column("contact_loss_fraction", column("contact_loss"), "", "largest over the speeds"),
            Column("unsteady_speeds", column("unsteady"), "", "how many speeds have no repeating motion"),
            Column("failure", np.array(reasons, dtype=str), "", "why a point has no result"),
        ),
        f"Dynamic factor of mesh {name} against tip relief",
    )
    plain = cast("dict[str, float]", found[0])["dynamic_factor"]
    chart = DesignChartData(
        amounts, lengths, factor.reshape(amounts.size, -1), error.reshape(amounts.size, -1), plain, delta, failures
    )
    values = [
        Value(
            "design_chart.delta", delta, "um", None, "Welbourn's Delta: deflection at the HPSTC under the mean force"
        ),
        Value("design_chart.unmodified", plain, "", None, "largest dynamic factor of perfect involutes"),
    ]
    for a, row in zip(amounts, chart.dynamic_factor, strict=True):
        if np.isfinite(row).any():
            k = int(np.nanargmin(row))
            values += [
                Value(f"design_chart.best_length_{a:g}", float(lengths[k]), "", None, f"L_n at {a:g} Delta"),
                Value(f"design_chart.least_factor_{a:g}", float(row[k]), "", None, f"at {a:g} Delta"),
            ]
    settings: dict[str, object] = {"points": len(points), "speeds": int(scene.case.dynamics.speed_values.size)}
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
    subjects=the_train,
    run=_run,
    needs=_needs,
    check=_check,
    effects=("contact_loss", "parametric"),
    requires=(
        Need("contact_loss", "reliefs are chosen for the forces at which teeth part"),
        Need("parametric", "relief acts on single tooth pairs, and without it all are one spring"),
    ),
    cites=citing(Citation("lin-townsend-oswald", "design charts of tip relief by dynamic factor")),
    forecast=_forecast,
)
