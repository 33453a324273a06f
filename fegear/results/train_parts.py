"""What several results of a train share: its meshes, the speeds that they need, and a sentence on teeth that part."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.errors import InputError
from fegear.models.neglected_effects import percent
from fegear.models.train import train_part

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.dynamics.gear_train import GearTrain
    from fegear.dynamics.pull import Pull

RPM = 30.0 / math.pi
#: A mesh with less of the largest mean force carries none.
_NO_SHARE = 1e-9


def meshes(scene: Scene) -> tuple[str, ...]:
    """All meshes of the train, by name."""
    return () if scene.case.train is None else tuple(scene.case.train.mesh)


def own_meshes(scene: Scene) -> tuple[str, ...]:
    """Meshes whose teeth are described by their own pair."""
    return tuple(name for name in meshes(scene) if train_part(scene).mesh[name].like is None)


def carries_nothing(data: GearTrain, mesh: int) -> bool:
    """Whether a mesh idles."""
    return bool(data.forces[mesh] <= _NO_SHARE * float(np.max(np.abs(data.forces))))


def needs_plane_teeth(scene: Scene, mesh: str, key: str, value: str) -> None:
    """Refuse what follows one place of contact on the path where the teeth of a mesh touch along lines over the face.

    Raises
    ------
    InputError
    """
    pair = train_part(scene).loaded_pair_of(mesh)
    if pair in scene.wide_pairs:
        helical = scene.pairs[pair].driver.helix_angle != 0.0
        raise InputError(
            key, value, f"follows one place of contact on the path, and the teeth of mesh {mesh} touch along the face",
            "leave it out" if helical else f'leave it out, or write pair.{pair}.width = "plane"',
        )  # fmt: skip


def needs_one_speed(scene: Scene, _subject: str) -> None:
    """Refuse histories without a speed."""
    if math.isnan(scene.case.dynamics.one_speed):
        raise InputError("dynamics.speed", "(not given)", "is needed for this result", 'write speed = "10000 rpm"')


def needs_speeds(scene: Scene, _subject: str) -> None:
    """Refuse sweeps without speeds."""
    if not scene.case.dynamics.speed_values.size:
        raise InputError(
            "dynamics.speeds", "(not given)", "is needed for this result",
            'write speeds = { start = "2000 rpm", stop = "16000 rpm", count = 57 }',
        )  # fmt: skip


def pull_remarks(pull: Pull | None) -> tuple[str, ...]:
    """Say how far the linearised force of a mesh falls below zero, if it does."""
    if pull is None:
        return ()
    where = f"{percent(pull.share)} of the mean force, at {pull.speed * RPM:.5g} rpm of {pull.speed_of}"
    sentence = (
        f"Mesh {pull.mesh}: the linearised mesh force falls to {pull.force:.4g} N ({where}), so teeth part, which this "
        "result neglects; ask for dynamic-factor and write contact_loss = true under [effects]."
    )
    return (sentence,)
