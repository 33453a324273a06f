"""What each stage will take, before it runs: processor seconds of one core, within about a factor of three.

The numbers were measured on one core of a server over all the cases (benchmarks/forecasts.py tells the ratios). They
follow what a stage does most of: gears solved, engagements shared, speeds run; below a twentieth of a second nobody
needs to know more.
"""

from __future__ import annotations

import math
from dataclasses import asdict
from fractions import Fraction
from typing import TYPE_CHECKING

from fegear.engine.stage import Forecast
from fegear.models.motion import in_time
from fegear.models.settings import mesh_settings, seconds_of_gear
from fegear.models.train import build_train

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fegear.case.reading import Scene

#: Importing mesher and solvers, once in a process.
_LIBRARIES = 0.2
#: One engagement followed over its path, or solved over a base pitch, and what corners off the path add to it.
_HISTORY, _HISTORY_CORNERS = 0.006, 0.02
_ERROR, _ERROR_CORNERS = 0.015, 0.1
#: One mesh as springs: tooth pairs that stand alone, and pairs that share.
_ALONE, _SHARED = 0.05, 0.6
#: One speed in time: linear, with contact loss, each further period until the motion repeats, friction of one mesh.
_LINEAR, _LOSS, _PERIOD, _FRICTION = 0.015, 0.055, 0.4, 0.06


def constant(seconds: float) -> Forecast:
    """A stage that takes about as long for every case."""
    return Forecast({}, seconds)


def shapes(scene: Scene, gears: Iterable[str]) -> dict[object, float]:
    """Seconds of the finite-element solutions of gears, each shape once; none on meshes of the user's own.

    Loading mesher and solvers counts as a shape too, for it happens once.
    """
    settings = mesh_settings(scene.case.accuracy)
    found: dict[object, float] = {}
    for name in gears:
        gear = scene.gears[name]
        if scene.case.gear[name].tooth_mesh is None:
            key = (gear.tooth, gear.bore_radius / gear.module, gear.material.poisson_ratio, gear.plane_assumption)
            found[key] = seconds_of_gear(settings)
    return {"libraries": _LIBRARIES, **found}


def _gears(scene: Scene, pair: str) -> tuple[str, str]:
    return scene.case.pair[pair].driver, scene.case.pair[pair].driven


def _by_elements(scene: Scene, pair: str) -> bool:
    return scene.case.pair[pair].compliance.source == "fe"


def _engagements(scene: Scene, pair: str) -> int:
    """The engagement itself, and those with one compliance each off by its error."""
    if not _by_elements(scene, pair):
        return 1
    return 4 if scene.case.effects.neighbour_coupling else 3


def _loads(scene: Scene, pair: str) -> int:
    return len(scene.case.pair[pair].all_loads(scene.pairs[pair]))


def loaded_pair(scene: Scene, name: str) -> Forecast:
    """Tables over the flank, from the influence functions of both gears or from closed forms."""
    source = scene.case.pair[name].compliance.source
    return Forecast({"compliance": source}, 0.1 if source == "fe" else 0.06)


def load_sharing(scene: Scene, name: str) -> Forecast:
    """One history for each engagement."""
    each = _HISTORY + (_HISTORY_CORNERS if scene.case.effects.corner_contact else 0.0)
    return Forecast({"positions": 200, "loads": _loads(scene, name)}, each * _engagements(scene, name))


def transmission_error(scene: Scene, name: str) -> Forecast:
    """One quadrature for each load, and the errors of the nominal one."""
    each = _ERROR + (_ERROR_CORNERS if scene.case.effects.corner_contact else 0.0)
    seconds = each * (_loads(scene, name) + 0.5)
    if scene.case.effects.spacing_errors:
        seconds += 0.03
    return Forecast({"loads": _loads(scene, name), "harmonics": 64}, seconds)


def root_stress_history(scene: Scene, _name: str) -> Forecast:
    """Kernels of both gears over the path, and those of their neighbours."""
    seconds = 0.25 if scene.case.effects.corner_contact else 0.12
    return constant(seconds if scene.case.effects.neighbour_coupling else 0.3 * seconds)


def relief(scene: Scene, name: str) -> Forecast:
    """Reliefs to grind, fitted by repeated load sharing."""
    design = scene.case.design
    grind = len(design.grind) if design else 2
    return constant(0.1 + 0.3 * grind * (1.3 if _engagements(scene, name) > 1 else 1.0))


def relief_chart(scene: Scene, name: str) -> Forecast:
    """Candidates of the chart, and the optimiser."""
    chart = scene.case.design.chart if scene.case.design else None
    amounts = len((chart and chart.amounts) or ()) or 16
    lengths = len((chart and chart.lengths) or ()) or 26
    loads = len((chart and chart.loads) or ()) or _loads(scene, name)
    corners = 3.0 if scene.case.effects.corner_contact else 1.0
    return Forecast(
        {"candidates": amounts * lengths, "loads": loads}, corners * (0.3 + 1e-4 * amounts * lengths * loads)
    )


def robustness(scene: Scene, _name: str) -> Forecast:
    """Every deviation with every other, for each candidate."""
    part = scene.case.design.robustness if scene.case.design else None
    count = len(part.load_factors) * len(part.spacing_errors) * len(part.relief_errors) if part else 15
    return Forecast({"deviations": count}, 0.005 + 5e-4 * count)


def gear_train(scene: Scene, _subject: str) -> Forecast:
    """Springs of every mesh."""
    effects, count = scene.case.effects, len(scene.case.train.mesh) if scene.case.train else 0
    each = _SHARED if effects.corner_contact or effects.neighbour_coupling else _ALONE
    return constant(each * count)


def _sizes(scene: Scene) -> tuple[int, int]:
    train = scene.case.train
    return (len(train.mesh), len(train.body)) if train else (0, 0)


def dynamic_increments(scene: Scene, _subject: str) -> Forecast:
    """One small solution for each frequency and pair of meshes."""
    count, (meshes, bodies) = scene.case.dynamics.frequencies.count, _sizes(scene)
    return Forecast({"frequencies": count}, 0.005 + 1.3e-6 * count * meshes**2 * bodies)


def mesh_force_spectrum(scene: Scene, _name: str) -> Forecast:
    """Harmonics at the one speed, and over all speeds."""
    part, (meshes, bodies) = scene.case.dynamics, _sizes(scene)
    over = part.speed_values.size * min(part.harmonics, 64)
    seconds = 0.1 + 2e-6 * (over + part.harmonics) * meshes * bodies
    return Forecast({"harmonics": part.harmonics, "speeds": int(part.speed_values.size)}, seconds)


def tooth_force(scene: Scene, _name: str) -> Forecast:
    """At least 256 harmonics at one speed."""
    part = scene.case.dynamics
    harmonics = max(part.harmonics, 256)
    return Forecast({"harmonics": harmonics, "positions": part.positions}, 0.06 * harmonics / 256)


def dynamic_root_stress(scene: Scene, _name: str) -> Forecast:
    """Root stress from the influence functions, whatever the compliances come from, and the neighbours' forces."""
    return constant(0.12 if scene.case.effects.neighbour_coupling else 0.04)


def _periods(scene: Scene) -> int:
    """Periods of the fastest mesh after which all meshes stand as before."""
    orders = [Fraction(order) for order in build_train(scene).mesh_orders]
    parts = [1 / order for order in orders]
    turns = Fraction(math.lcm(*(p.numerator for p in parts)), math.gcd(*(p.denominator for p in parts)))
    return round(float(turns * max(orders)))


def _seconds_per_speed(scene: Scene) -> float:
    effects, (meshes, _) = scene.case.effects, _sizes(scene)
    each = (_LOSS if effects.contact_loss else _LINEAR) * (1.0 + _PERIOD * (_periods(scene) - 1))
    return each + (_FRICTION * meshes if effects.friction else 0.0)


def motion(scene: Scene, _subject: str) -> Forecast:
    """One steady motion for each speed; one that does not repeat takes ten times as long, which nobody foresees."""
    speeds = int(scene.case.dynamics.speed_values.size)
    settings = {"speeds": speeds, "periods": _periods(scene), "tolerance": scene.case.dynamics.tolerance}
    left_out = sum(not scene.case.effects.is_on(effect) for effect in ("contact_loss", "friction"))
    return Forecast(settings, _seconds_per_speed(scene) * speeds + 0.1 * left_out)


def dynamic_factor(scene: Scene, _name: str) -> Forecast:
    """Read from the motion, or the linearised train at each speed."""
    speeds = int(scene.case.dynamics.speed_values.size)
    return Forecast({"speeds": speeds}, 0.005 if in_time(scene) else 0.02 * speeds)


def design_chart(scene: Scene, _subject: str) -> Forecast:
    """A motion over the speeds for each point of the chart."""
    part = scene.case.dynamics
    if part.chart is None:
        return Forecast()
    points = 1 + len(part.chart.amounts) * len(part.chart.lengths)
    speeds = int(part.speed_values.size)
    return Forecast({"points": points, "speeds": speeds}, points * (0.1 + speeds * _seconds_per_speed(scene)))


def tooth_contact(scene: Scene, _name: str) -> Forecast:
    """Contacts at every angle, and their extremes."""
    positions = scene.case.tooth_contact.positions
    return Forecast({"positions": positions}, 0.1 + 6e-4 * positions)


def transmissibility(scene: Scene, name: str) -> Forecast:
    """One response for each frequency."""
    count = scene.case.transmissibility[name].frequencies
    return Forecast({"frequencies": count}, 0.005 + 1e-5 * count)


def crosscheck(scene: Scene, _subject: str) -> Forecast:
    """Every closed form for every gear and pair."""
    return constant(0.05 + 0.08 * (len(scene.gears) + len(scene.pairs)))


def root_stress_study(scene: Scene, _subject: str) -> Forecast:
    """One gear without neighbours and without its error for each combination."""
    study, settings = scene.case.study, mesh_settings(scene.case.accuracy)
    if study is None:
        return Forecast()
    count = math.prod(len(values or [0]) for values in (study.teeth, study.profile_shift, study.rack_tip_radius))
    return Forecast({"gears": count, **asdict(settings)}, _LIBRARIES + 0.3 * count * seconds_of_gear(settings))
