"""Names by which the parts of a case refer to each other: gears, pairs, bodies and meshes that must be there."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.case.nearest import nearest

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping

    from fegear.case.model import Case
    from fegear.case.train import TrainPart


def check_references(case: Case, built: Mapping[str, Collection[str]]) -> None:
    """Refuse names that nothing in the case has, whether or not a wanted result reads them.

    Parameters
    ----------
    case : Case
    built : mapping of str to collection of str
        Names of its gears, spur gears, pairs and spur pairs, by what they are called in messages.

    Raises
    ------
    InputError
        With the nearest name.
    """
    train = case.train
    of_train = {"body": train.body if train else (), "mesh": train.mesh if train else ()}
    known = {**built, **of_train, "gauge": case.gauge}
    if train is not None:
        _check_pairs_by_name(train, known["pair"])
    for key, name, kind in _references(case):
        if name is not None and name not in known[kind]:
            if kind == "body" and name in known["gear"] and train is not None:
                raise _gear_as_body(key, name, train)
            raise InputError(key, f'"{name}"', f"is not a {kind} of this case", nearest(name, known[kind]))


def _check_pairs_by_name(train: TrainPart, pairs: Collection[str]) -> None:
    """Refuse a mesh that says no pair and has the name of none."""
    for name, mesh in train.mesh.items():
        if mesh.pair is None and name not in pairs:
            one = nearest(name, pairs) if len(pairs) != 1 else f'set pair = "{next(iter(pairs))}"'
            raise InputError(
                f"train.mesh.{name}.pair", "(not given)", f"is required: no pair of this case is called {name}", one
            )  # fmt: skip


def _gear_as_body(key: str, name: str, train: TrainPart) -> InputError:
    """A gear where a body is asked for."""
    carriers = [body for body, part in train.body.items() if name in (part.gears or ())]
    return InputError(
        key, f'"{name}"', "is a gear, not a body of the train",
        f'set "{carriers[0]}", the body that has this gear' if carriers else
        f"specify one of the bodies {', '.join(train.body)}",
    )  # fmt: skip


def _references(case: Case) -> Iterator[tuple[str, str | None, str]]:
    """Key, name and kind of everything that is referred to."""
    yield "stiffness.gear", case.stiffness.gear, "gear"
    yield "stiffness.pair", case.stiffness.pair, "pair"
    yield "cost.gear", case.cost.gear, "spur gear"
    yield "cost.pair", case.cost.pair, "pair"
    for name, gauge in case.gauge.items():
        yield f"gauge.{name}.gear", gauge.gear, "gear"
        yield f"gauge.{name}.pair", gauge.pair, "pair"
        yield f"gauge.{name}.measured.bridge", gauge.measured.bridge if gauge.measured else None, "gauge"
    for name, encoders in case.encoders.items():
        yield f"encoders.{name}.pair", encoders.pair, "pair"
    if case.study is not None:
        yield "study.gear", case.study.gear, "spur gear"
    if case.design is not None:
        yield "design.pair", case.design.pair, "pair"
    if case.fillet_design is not None:
        yield "fillet_design.pair", case.fillet_design.pair, "pair"
        yield "fillet_design.gear", case.fillet_design.gear, "gear"
    if case.loading is not None:
        yield "loading.pair", case.loading.pair, "spur pair"
    for name, part in case.transmissibility.items():
        error = part.excitation.transmission_error if part.excitation else None
        key = f"transmissibility.{name}.excitation.transmission_error.pair"
        yield key, error.pair if error else None, "pair"
        yield f"transmissibility.{name}.mesh.pair", part.mesh.pair, "pair"
    for name, compound in case.compound.items():
        for gear in () if compound.search is None else compound.search.teeth:
            yield f"compound.{name}.search.teeth", gear, "gear"
    for name, rack in case.rack.items():
        yield f"rack.{name}.pinion", rack.pinion, "gear"
    if case.train is not None:
        yield from _of_train(case.train)
        dynamics = case.dynamics
        yield "dynamics.speed_of", dynamics.speed_of, "body"
        yield "dynamics.loss_taken_by", dynamics.loss_taken_by, "body"
        yield "dynamics.chart.mesh", dynamics.chart.mesh if dynamics.chart else None, "mesh"


def _of_train(part: TrainPart) -> Iterator[tuple[str, str | None, str]]:
    for name, body in part.body.items():
        yield from ((f"train.body.{name}.gears", gear, "gear") for gear in body.gears or ())
    for name, shaft in part.shaft.items():
        yield from ((f"train.shaft.{name}.{end}", getattr(shaft, end), "body") for end in ("a", "b"))
    for name, mesh in part.mesh.items():
        yield from ((f"train.mesh.{name}.{role}", getattr(mesh, role), "body") for role in ("driver", "driven"))
        yield f"train.mesh.{name}.pair", part.pair_of(name), "pair"
        yield f"train.mesh.{name}.like.pair", part.loaded_pair_of(name), "pair"
        yield f"train.mesh.{name}.back_pair", mesh.back_pair, "pair"
    for name, damper in part.damper.items():
        yield from ((f"train.damper.{name}.{end}", getattr(damper, end), "body") for end in ("a", "b"))
    yield from (("train.torque", torque, "body") for torque in part.torque)
    for name, ripple in part.torque_ripple.items():
        yield from ((f"train.torque_ripple.{name}.{end}", getattr(ripple, end), "body") for end in ("body", "order_of"))
    yield "train.balance", part.balance, "body"
