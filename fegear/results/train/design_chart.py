"""Stage ``design-chart``: largest dynamic factor over speed, against amount and length of tip relief (TM-89901)."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import cast

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import FegearError, InputError
from fegear.case.built.pair_spec import pair_spec
from fegear.case.built.tooth_influence import GearToSolve, gear_to_solve
from fegear.case.built.train import motion_spec, train_inputs, train_part
from fegear.case.dynamics import DesignChartPart
from fegear.case.reading import Scene
from fegear.contact.pair_spec import PairSpec
from fegear.contact.plane.engagement import Engagement
from fegear.dynamics.motion.motion_spec import MotionSpec
from fegear.dynamics.train.dynamic_factor import factor_between, factor_line
from fegear.dynamics.train.gear_train import GearTrain
from fegear.dynamics.train.train_spec import TrainSpec, assemble
from fegear.engine.citation import Citation, citing
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.geometry.pair import MEMBERS
from fegear.geometry.relief import Shape
from fegear.results import forecasts
from fegear.results.pair.loaded_teeth import loaded_pair
from fegear.results.train.design_chart_sheet import CHART_SHEET, DesignChartData, UnequalRelief
from fegear.results.train.gear_train import gear_train, needs_plane_teeth, needs_speeds, own_meshes, the_train
from fegear.results.train.motion import check_motion

#: Harmonics of the static transmission error that the chart keeps (TM-89901, Fig. 7).
HARMONICS = 4
#: Motions that are found here sooner than other processes start.
_FEW = 300


@dataclass(frozen=True)
class ChartInputs:
    """What the chart depends on.

    Parameters
    ----------
    amounts, lengths : ndarray
        Of tip relief, over Delta and in L_n.
    unequal : tuple of (float, float, float)
        Amounts on driver and driven gear and length of reliefs that stand alone.
    shape : {"linear", "parabolic"}
    mesh : str
        That is relieved and looked at.
    train : TrainSpec
    motion : MotionSpec
    teeth : PairSpec
        Of that mesh.
    gears : tuple of GearToSolve
        Whose influence functions its compliances come from; empty for closed forms and tables.
    """

    amounts: Array
    lengths: Array
    unequal: tuple[tuple[float, float, float], ...]
    shape: Shape
    mesh: str
    train: TrainSpec
    motion: MotionSpec
    teeth: PairSpec
    gears: tuple[GearToSolve, ...]


@dataclass(frozen=True)
class Trial:
    """One point of the chart: all that a process needs to compute it."""

    inputs: ChartInputs
    train: GearTrain
    engagement: Engagement
    mesh: int
    amounts: tuple[float, float]
    length: float
    delta: float


def chart_trial(trial: Trial) -> dict[str, float]:
    """Compute one point: largest dynamic factor over the case's speeds, where, and A_e of the static error."""
    from fegear.dynamics.motion.moving_train import steady_motions
    from fegear.dynamics.train.charts import SpeedChart
    from fegear.dynamics.train.excitation import effective_error
    from fegear.dynamics.train.mesh_excitation import mesh_excitation
    from fegear.geometry.relief import CombinedRelief, normalised_tip_relief

    asked, i = trial.inputs, trial.mesh
    pair = trial.engagement.pair
    driver, driven = (
        normalised_tip_relief(pair, member, amount * trial.delta, trial.length, asked.shape)
        if amount > 0.0 else CombinedRelief()
        for member, amount in zip(MEMBERS, trial.amounts, strict=True)
    )  # fmt: skip
    engagement = replace(trial.engagement, driver_relief=driver, driven_relief=driven)
    mesh = trial.train.meshes[i]
    found = mesh_excitation(engagement if mesh.a_drives else engagement.reversed(), mesh.force)
    by_mesh = {name: one.excitation for name, one in zip(trial.train.names, trial.train.meshes, strict=True)}
    by_mesh[trial.train.names[i]] = found
    data = assemble(asked.train, by_mesh)
    states = steady_motions(asked.motion, data)
    curve = SpeedChart.of(asked.motion.speeds, states, i, float(data.forces[i]))
    worst, where = curve.worst
    error = data.errors[i]
    amplitudes = 2.0 * np.abs(error.fourier(error.pitches * np.arange(1, HARMONICS + 1)))
    return {
        "dynamic_factor": worst,
        "speed": where,
        "contact_loss": float(curve.apart.max()),
        "unsteady": float(np.count_nonzero(curve.periods == 0)),
        "effective_error": effective_error(error),
        **{f"amplitude_{n + 1}": float(a) for n, a in enumerate(amplitudes)},
    }


def trial_content(trial: Trial) -> object:
    """All that a point's numbers depend on: not the chart that it belongs to, so that a larger one finds it again."""
    asked = trial.inputs
    return (
        asked.shape, asked.mesh, asked.train, asked.motion, asked.teeth, asked.gears,
        trial.amounts, trial.length, trial.delta,
    )  # fmt: skip


def _chart(scene: Scene) -> DesignChartPart:
    found = scene.case.dynamics.chart
    if found is None:
        raise InputError(
            "dynamics.chart", "(not given)", "is required for design-chart",
            "set chart = { amounts = [0.5, 1.0], lengths = [0.6, 0.8, 1.0] }",
        )  # fmt: skip
    return found


def _mesh(scene: Scene) -> str:
    own = own_meshes(scene)
    name = _chart(scene).mesh or (own[0] if own else "")
    if name not in own:
        raise InputError("dynamics.chart.mesh", f'"{name}"', "is not a mesh of this train with solved teeth")
    return name


def _check(scene: Scene, subject: str) -> None:
    needs_speeds(scene, subject)
    check_motion(scene)
    needs_plane_teeth(scene, _mesh(scene), "results", '"design-chart"')
    pair = train_part(scene).pair_of(_mesh(scene))
    ratio = scene.pairs[pair].contact_ratio
    if not 1.0 <= ratio < 2.0:
        raise InputError(
            f"pair.{pair}", f"contact ratio {ratio:.4f}", "has no highest point of single tooth contact (reference "
                                                          "of the relief length)",
        )  # fmt: skip


def _inputs(scene: Scene, _subject: str) -> ChartInputs:
    part, mesh = _chart(scene), _mesh(scene)
    pair = train_part(scene).loaded_pair_of(mesh)
    teeth = pair_spec(scene, pair)
    solved = teeth.gears if teeth.compliance == "fe" else ()
    return ChartInputs(
        np.unique(part.amounts), np.unique(part.lengths), tuple((u.driver, u.driven, u.length) for u in part.unequal),
        part.shape, mesh, train_inputs(scene).spec, motion_spec(scene),
        teeth, tuple(gear_to_solve(scene, gear) for gear in solved),
    )  # fmt: skip


def _compute(asked: ChartInputs, upstream: Upstream, work: Work) -> DesignChartData:
    from fegear.contact.plane.flanks import welbourn_amount
    from fegear.engine.executor import map_points
    from fegear.engine.processes import Failure

    data = gear_train(upstream)
    i = data.train.mesh_index(asked.mesh)
    engagement = loaded_pair(upstream, asked.teeth.name).engagement
    delta = welbourn_amount(engagement, float(data.forces[i]))
    chart = [((float(a), float(a)), float(n)) for a in asked.amounts for n in asked.lengths]
    # beside each unequal relief, both of its amounts on both gears
    beside = [((a, b), n) for one, two, n in asked.unequal for a, b in ((one, two), (one, one), (two, two))]
    reliefs = list(dict.fromkeys([((0.0, 0.0), 0.0), *chart, *(r if any(r[0]) else ((0.0, 0.0), 0.0) for r in beside)]))
    points = [Trial(asked, data, engagement, i, amounts, length, delta) for amounts, length in reliefs]
    executor = work.executor
    if executor.scheduler is None and len(points) * asked.motion.speeds.size <= _FEW:
        executor = replace(executor, here=True)
    found_points = map_points(chart_trial, points, executor, work.cache, key=trial_content, progress=work.progress)
    made = dict(zip(reliefs, found_points, strict=True))
    plain, found = made[(0.0, 0.0), 0.0], [made[point] for point in chart]
    if isinstance(plain, Failure):
        raise FegearError(f"The unmodified gears of the design chart have no result: {plain.reason}")

    def grid(key: str) -> Array:
        return np.array([_number(one, key) for one in found]).reshape(asked.amounts.size, -1)

    factor, error = grid("dynamic_factor"), grid("effective_error")
    at = {point: made[point if any(point[0]) else ((0.0, 0.0), 0.0)] for point in beside}
    return DesignChartData(
        asked.amounts, asked.lengths, factor, error, grid("speed"), grid("contact_loss"), grid("unsteady"),
        np.array([grid(f"amplitude_{n}") for n in range(1, HARMONICS + 1)]),
        tuple(r.reason if isinstance(r, Failure) else "" for r in found),
        tuple(_unequal(one, two, n, at) for one, two, n in asked.unequal), factor_line(error, factor),
        _number(plain, "dynamic_factor"), _number(plain, "effective_error"), delta, data.speed_of,
    )  # fmt: skip


def _number(point: object, key: str) -> float:
    """One number of a point; nan where it failed."""
    return cast("dict[str, float]", point)[key] if isinstance(point, dict) else np.nan


def _unequal(
    driver: float, driven: float, length: float, at: dict[tuple[tuple[float, float], float], object]
) -> UnequalRelief:
    """A relief of its own on each gear, and its factor predicted from both amounts on both gears."""
    point = at[(driver, driven), length]
    known = [at[(amount, amount), length] for amount in (driver, driven)]
    errors, factors = ([_number(one, key) for one in known] for key in ("effective_error", "dynamic_factor"))
    error = _number(point, "effective_error")
    return UnequalRelief(
        driver, driven, length, _number(point, "dynamic_factor"), _number(point, "speed"), error,
        factor_between(error, (errors[0], errors[1]), (factors[0], factors[1])), getattr(point, "reason", ""),
    )  # fmt: skip


def _needs(scene: Scene, _subject: str) -> tuple[Task, ...]:
    return (Task("gear-train"), Task("loaded-pair", train_part(scene).loaded_pair_of(_mesh(scene))))


def _forecast(scene: Scene, _subject: str) -> Forecast:
    """A motion over the speeds for each point of the chart."""
    part = scene.case.dynamics
    if part.chart is None:
        return Forecast()
    points = 1 + len(part.chart.amounts) * len(part.chart.lengths) + 3 * len(part.chart.unequal)
    speeds = int(part.speed_values.size)
    return Forecast({"points": points, "speeds": speeds}, points * (0.1 + speeds * forecasts.seconds_per_speed(scene)))


DESIGN_CHART = Stage(
    subjects=the_train,
    needs=_needs,
    inputs=_inputs,
    compute=_compute,
    present=CHART_SHEET.present,
    check=_check,
    cites=citing(Citation("lin-townsend-oswald", "design charts of tip relief by dynamic factor")),
    forecast=_forecast,
    in_points=True,
)
