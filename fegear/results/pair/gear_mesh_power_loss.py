"""Stage ``gear-mesh-power-loss``: friction loss, loss factors and efficiency of the teeth of a pair."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import RangeError
from fegear.base.notes import assuming
from fegear.base.shown import shown, shows
from fegear.case.built.pair_surface import PairFriction, check_speed, pair_friction, pair_speed
from fegear.case.reading import Scene
from fegear.contact.error_over_pitch import ErrorOverPitch
from fegear.contact.surface import FrictionLaw
from fegear.contact.tooth_loss import ToothLoss
from fegear.engine.citation import Citation
from fegear.engine.figure.items import Mark
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.engine.sheet.number import Number, exact
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.seen import Seen
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Forecast, Upstream, Work
from fegear.geometry.pair import GearPair
from fegear.results.gear.path_marks import LINE_OF_ACTION, path_marks
from fegear.results.pair.loaded_teeth import check_teeth, loaded_teeth, teeth_stage

#: Laws by the works that they stand in.
_WORKS = {
    "schlenk": "schlenk", "iso-6336-20": "iso-ts-6336-20", "iso-6336-21": "iso-ts-6336-21",
    "iso-6336-22": "iso-ts-6336-22", "buckingham": "lin-huston-coy", "benedict-kelley": "lin-huston-coy",
}  # fmt: skip


_NEGLECTED = "bearings, churning, windage and seals are neglected"


@dataclass(frozen=True)
class ToothLossInputs:
    """What is read of the case besides the loaded pair.

    Parameters
    ----------
    friction : PairFriction
    speed : float
        Of the driver [rad/s].
    loads : tuple of float
        Of the case, ascending [N].
    nominal : int
        Number of the nominal one.
    given : bool
        Whether the case names the friction law.
    name : str
    """

    friction: PairFriction
    loads: tuple[float, ...]
    nominal: int
    given: bool = field(compare=False)
    name: str = field(compare=False)
    speed: float = shown("rpm", "speed of the driver")

    @property
    def load(self) -> float:
        """The nominal load [N]."""
        return self.loads[self.nominal]

    def law(self, pair: GearPair, load: float) -> FrictionLaw:
        """Friction law under a load [N]."""
        return self.friction.of(pair, self.speed, load)


@dataclass(frozen=True)
class ToothLossData:
    """Losses of a pair.

    Parameters
    ----------
    pair : GearPair
    over_loads : tuple of ToothLoss
        By the computed load and the friction law, under every load.
    nominal : int
        Number of the nominal load.
    load : ndarray, shape (L,)
        Every load [N].
    error : float
        Share by which loss and loss factor may be off, of integration and of the loads over the face.
    ohlendorf, wimmer : float
        H_V of both; NaN outside their ranges.
    """

    pair: GearPair
    over_loads: tuple[ToothLoss, ...]
    nominal: int
    error: float
    load: Array = shown("N", "load along the line of action")
    ohlendorf: float = shown("", "H_V, equal sharing of two pairs, spur gears", name="loss_factor_ohlendorf")
    wimmer: float = shown("", "H_V of rigid gears, uniform load along the contact lines", name="loss_factor_wimmer")

    @property
    def found(self) -> ToothLoss:
        """Under the nominal load."""
        return self.over_loads[self.nominal]

    @property
    @shows("deg", "roll angle of the driver")
    def roll_angle(self) -> Array:
        """At each place on the path [rad]."""
        return np.asarray(self.pair.roll_angle(self.found.x, "driver"))

    @property
    @shows("", "loss factor H_{V}")
    def loss_factors(self) -> Array:
        """Under every load."""
        return np.array([one.loss_factor for one in self.over_loads])

    @property
    @shows("%", "power loss")
    def lost(self) -> Array:
        """Share of the power, under every load."""
        return np.array([1.0 - one.efficiency for one in self.over_loads])

    @property
    def both_alike(self) -> bool:
        """Whether both formulas say the same, as those of spur gears do."""
        return math.isclose(self.ohlendorf, self.wimmer, rel_tol=1e-9)

    @property
    @shows("N", "largest load on the tip corners of spur gears off the path of contact")
    def on_corners(self) -> float:
        """[N]."""
        off = (self.found.x < self.pair.x_start) | (self.found.x > self.pair.x_end)
        return 0.0 if self.pair.driver.helix_angle != 0.0 else float(self.found.load[off].max(initial=0.0))


def _inputs(scene: Scene, name: str) -> ToothLossInputs:
    part = scene.case.pair[name]
    load, loads = part.normal_load(scene.pairs[name]) or math.nan, part.all_loads(scene.pairs[name])
    law, speed = pair_friction(scene, name, "gear-mesh-power-loss"), pair_speed(scene, name)
    return ToothLossInputs(law, loads, loads.index(load), part.friction is not None, name, speed)


def _check(scene: Scene, name: str) -> None:
    check_teeth(scene, name)
    check_speed(scene, name, "gear-mesh-power-loss")
    pair_friction(scene, name, "gear-mesh-power-loss")


def _compute(inputs: ToothLossInputs, upstream: Upstream, _work: Work) -> ToothLossData:
    teeth = loaded_teeth(upstream, inputs.name)
    losses, error = teeth.losses(inputs.speed, lambda load: inputs.law(teeth.pair, load))
    return _data(teeth.pair, losses, inputs, error)


def _data(pair: GearPair, losses: tuple[ToothLoss, ...], inputs: ToothLossInputs, error: float) -> ToothLossData:
    from fegear.formulas.friction import ohlendorf, wimmer

    closed = []
    for formula in (ohlendorf, wimmer):
        try:
            closed.append(formula(pair))
        except RangeError:
            closed.append(math.nan)
    return ToothLossData(pair, losses, inputs.nominal, error, np.array(inputs.loads), closed[0], closed[1])


def _marks(seen: Seen) -> tuple[Mark, ...]:
    return path_marks(seen.data.pair)


def _along_the_path(quantity: str, role: str) -> Over:
    """A quantity of one tooth pair from A to E."""
    line = Line(f"found.{quantity}", role=role, x="found.x", look={"dash": "solid", "markers": False})
    return Over(LINE_OF_ACTION, (line,), options={"zero": True}, marks=_marks)


def _rigid(key: str, label: str, role: str, alike: bool) -> Line:
    """Loss factor of rigid gears, which says of no load."""
    return Line(
        key, label, role, look={"dash": "dash", "markers": False},
        when=lambda seen: seen.data.both_alike is alike and not math.isnan(getattr(seen.data, key)),
    )  # fmt: skip


def _compared(seen: Seen) -> str:
    """Loss factors by formulas, in brackets behind the computed one."""
    closed = {"Wimmer": seen.data.wimmer, "Ohlendorf": seen.data.ohlendorf}
    return ", ".join(f"{who} {value:.4f}" for who, value in closed.items() if not math.isnan(value))


def _caption(seen: Seen) -> str:
    found = seen.data.found
    return (
        f"Pair {seen.name}: load on a tooth pair, friction coefficient (law {seen.asked.friction.law}) and the power "
        f"that this pair loses from A to E. Loss factor H_V by the computed load {found.loss_factor:.4f} "
        f"({_compared(seen)}); the teeth lose {found.loss:.4g} W of {found.transmitted:.5g} W."
    )


_LAW = "law {asked.friction.law}"
_SHEET = Sheet(
    tables=(
        Rows(
            "tooth_loss_{name}", "Power loss of a tooth pair of {name} along the path of contact",
            ("found.x", "roll_angle", "found.load", Cell("found.coefficient", meaning=_LAW), "found.power"),
        ),
        Rows(
            "tooth_loss_loads_{name}", "Tooth loss of pair {name} under every load",
            (
                Cell("total_load", lambda seen: seen.asked.loads, lambda _: ErrorOverPitch, name="load"),
                "transmitted", "loss", "loss_factor", "mean_coefficient", "efficiency",
            ),
            of="over_loads", when=lambda seen: len(seen.asked.loads) > 1,
        ),
    ),
    values=(
        Number("found.loss", lambda seen: seen.data.error * seen.data.found.loss),
        Number("found.transmitted", exact, meaning="power: load times base circle speed"),
        Number(
            "found.efficiency", lambda seen: seen.data.error * (seen.data.found.loss / seen.data.found.transmitted),
            name="tooth_efficiency", further=f": {_NEGLECTED}",
        ),
        Number("found.loss_factor", lambda seen: seen.data.error * seen.data.found.loss_factor),
        Number("wimmer", exact),
        Number("ohlendorf", exact),
        Number("found.mean_coefficient", meaning=f"coefficient that takes as much, {_LAW}"),
    ),
    figures=(
        Chart(
            "tooth_loss_{name}", "Power loss of pair {name}", _caption,
            (
                _along_the_path("load", "blue"), _along_the_path("coefficient", "green"),
                _along_the_path("power", "red"),
            ),
            under="{asked.load:said}, {asked.speed:.5g}",
        ),
        Chart(
            "tooth_loss_loads_{name}", "Gear mesh power loss of pair {name} over load",
            "Pair {name}: loss factor H_V by the computed load and of rigid gears, and power loss as a share of "
            "the power by the law {asked.friction.law}. At low load tips with relief are not in contact.",
            (
                Over(
                    "load",
                    (
                        Line("loss_factors", "computed load", "series:0"),
                        _rigid("ohlendorf", "Ohlendorf", "series:1", alike=False),
                        _rigid("wimmer", "Wimmer", "grey", alike=False),
                        _rigid("wimmer", "Ohlendorf and Wimmer", "series:1", alike=True),
                    ),
                    x_options={"zero": True},
                ),
                Over(
                    "load", (Line("lost", role="red", look={"dash": "solid"}),), options={"zero": True},
                    x_options={"zero": True},
                ),
            ),
            when=lambda seen: len(seen.asked.loads) > 1, under="{asked.speed:.5g}",
        ),
    ),
    remarks=(
        Remark(
            f"Pair {{name}}: loss of sliding teeth only; {_NEGLECTED}. Loads are those without friction."
        ),
        Remark(
            assuming("Pair {name}: friction law not specified; Schlenk with the lubricant of the case assumed."),
            when=lambda seen: not seen.asked.given,
        ),
        Remark(
            "Pair {name}: tip corners carry up to {d.on_corners:.4g} off the path of contact; their sliding "
            "velocity is extrapolated along the line of action.",
            when="on_corners",
        ),
        Remark(
            "Pair {name}: H_V of Ohlendorf is valid for contact ratios between 1 and 2.",
            when=lambda seen: math.isnan(seen.data.ohlendorf),
        ),
    ),
    settings={
        "friction": lambda seen: seen.asked.friction.law,
        "local": lambda seen: seen.asked.friction.local,
        "speed": lambda seen: seen.asked.speed,
    },
)  # fmt: skip


def _cites(scene: Scene, name: str) -> Iterator[Citation]:
    yield Citation("ohlendorf", "loss factor H_V of equal sharing")
    yield Citation("wimmer", "loss factor H_V of uniform load along contact lines")
    part = scene.case.pair[name].friction
    law = "schlenk" if part is None else part.name
    if law in _WORKS:
        yield Citation(_WORKS[law], "friction coefficient")


def _forecast(_scene: Scene, _name: str) -> Forecast:
    return Forecast({}, 0.05)


GEAR_MESH_POWER_LOSS = teeth_stage(
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    check=_check,
    cites=_cites,
    forecast=_forecast,
)
