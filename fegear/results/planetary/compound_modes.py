"""Stage ``compound-modes``: natural frequencies and mode types of a planetary set described as data."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.base.notes import assuming
from fegear.base.printed import figures
from fegear.base.shown import shown
from fegear.case.built.compound import compound_inputs, compound_part
from fegear.case.part import at
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.axis import Axis
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import ALL, Chart, Family, Line, Over
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Stage
from fegear.results import forecasts
from fegear.results.planetary.compound_set import compound_sets

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from fegear.base.arrays import Array
    from fegear.case.built.compound import CompoundInputs
    from fegear.case.reading import Scene
    from fegear.dynamics.compound.compound_modes import CompoundModel, CompoundModes
    from fegear.engine.sheet.seen import Seen
    from fegear.engine.stage import Upstream, Work

#: Frequencies closer than this share of the highest are one, with several modes.
_ONE = 1e-8


def _model(inputs: CompoundInputs) -> CompoundModel:
    from fegear.dynamics.compound.compound_modes import CompoundModel, loaded_flanks

    meshes = inputs.found.meshes
    flanks = (1,) * len(meshes) if inputs.drive is None else loaded_flanks(inputs.drive.tooth, inputs.direction)
    return CompoundModel(inputs.found, flanks, dict(inputs.turning))


def _check(scene: Scene, name: str) -> None:
    """Refuse modes without mesh stiffness, or of bodies that can move and whose mass is not known."""
    for number, mesh in enumerate(compound_part(scene, name).mesh):
        if mesh.stiffness is None:
            raise InputError(f"compound.{name}.mesh[{number}].stiffness", "(not given)", "is required for modes",
                             'set stiffness = "400 N/um"')  # fmt: skip
    model = _model(compound_inputs(scene, name))
    try:
        masses = model.masses
    except InputError as error:
        raise at(f"compound.{name}", error) from None
    if not model.free.shape[1]:
        raise InputError(f"compound.{name}.shaft", f"{masses.size // 3} bodies", "are all rigidly supported: no modes",
                         'give a bearing or pin stiffness, e.g. pin = "200 N/um"')  # fmt: skip


def _compute(inputs: CompoundInputs, _upstream: Upstream, _work: Work) -> CompoundModes:
    from fegear.dynamics.compound.compound_modes import compound_modes

    return compound_modes(_model(inputs))


@dataclass(frozen=True)
class SingleMode:
    """One mode."""

    kind: str
    frequency: float = shown("Hz", "undamped natural frequency")


@dataclass(frozen=True)
class Strain:
    """Share of the strain energy in one mesh over modes, which stand at `place` where they are drawn."""

    place: NDArray[np.intp] = shown("", "mode")
    share: Array = shown("", "strain energy share of mesh", name="strain")


@dataclass(frozen=True)
class ShownModes:
    """Natural modes as they are shown."""

    found: CompoundModes
    meshes: tuple[str, ...]
    mode: NDArray[np.intp] = shown("", "mode number, increasing frequency")

    @property
    def single(self) -> dict[str, SingleMode]:
        """Modes that are not rigid motions, by number."""
        every = enumerate(zip(self.found.frequency, self.found.kind, strict=True))
        return {str(k): SingleMode(kind, float(hz)) for k, (hz, kind) in every if hz > 0.0}

    @property
    def drawn(self) -> NDArray[np.intp]:
        """Modes that move, of those of one frequency the first."""
        frequency = self.found.frequency
        other = np.append(True, np.diff(frequency) > _ONE * frequency[-1])
        return np.flatnonzero((frequency > 0.0) & other)

    @property
    def strains(self) -> dict[str, Strain]:
        """By mesh, of all modes."""
        return {name: Strain(self.mode, share) for name, share in zip(self.meshes, self.found.strain, strict=True)}

    @property
    def bars(self) -> dict[str, Strain]:
        """By mesh, of the modes that are drawn, and of pins and bearings."""
        drawn = self.drawn
        place = np.arange(drawn.size)
        found = {name: Strain(place, one.share[drawn]) for name, one in self.strains.items()}
        rest = 1.0 - np.sum([one.share for one in found.values()], axis=0)
        return {**found, "pins and bearings": Strain(place, np.maximum(rest, 0.0))}


def _shown(found: CompoundModes, inputs: CompoundInputs) -> ShownModes:
    names = tuple(mesh.name for mesh in inputs.found.meshes)
    return ShownModes(found, names, np.arange(found.frequency.size))


def _remarks(seen: Seen) -> Iterator[str]:
    asked = seen.asked
    counts = ", ".join(f"{count} of type {kind}" for kind, count in Counter(seen.data.found.kind).items())
    yield f"Set {seen.name}: {counts}; gyroscopic forces of the rotation of carriers are neglected."
    if asked.drive is None:
        yield assuming(
            f"Set {seen.name}: loaded flanks require compound.{seen.name}.input; planets are assumed to push "
            "counter-clockwise in every mesh."
        )
    carriers = list(asked.found.carriers())
    few = [one.name for one in asked.found.planets if one.count < 3]
    if len(carriers) > 1 and few:
        yield f"Set {seen.name}: modes are for the given angle between carriers {', '.join(carriers)}."


def _answer(seen: Seen) -> Iterator[str]:
    moving = list(seen.data.single.values())
    if moving:
        first = moving[0]
        yield (
            f"Set {seen.name}: lowest natural frequency {figures(first.frequency)} Hz ({first.kind}), "
            f"{len(seen.data.drawn)} different ones up to {figures(moving[-1].frequency)} Hz."
        )


def _types(seen: Seen) -> Axis:
    found = seen.data.found
    labels = (f"{found.frequency[k] * 1e-3:.3g}\n{found.kind[k][0].upper()}" for k in seen.data.drawn)
    return Axis("natural frequency [kHz] and type", categories=tuple(labels))


_SHEET = Sheet(
    answer=Answer(_answer, figure=lambda seen: f"compound_modes_{seen.name}"),
    of=_shown,
    tables=(
        Rows(
            "compound_modes_{name}", "Natural modes of set {name}",
            (
                "mode", "found.frequency", "found.kind", "found.turning", "found.moving",
                Cell("share", each="strains", name="strain_{key}", further=" {key}"),
            ),
        ),
    ),
    values=(Number("frequency", each="single", name="natural_frequency_{key}", further=", {one.kind}"),),
    figures=(
        Chart(
            "compound_modes_{name}", "Natural modes of set {name}",
            "Set {name}: strain energy distribution of the modes. R: rotational, T: translational, "
            "P: planet, M: mixed mode.",
            (
                Over(
                    _types,
                    (
                        Line("share", x="place", each=Family("bars", most=ALL), kind="bars"),
                    ),
                    Axis("strain energy share", limits=(0.0, 1.0)), panel={"stacked": True},
                ),
            ),
        ),
    ),
    remarks=(_remarks,),
)  # fmt: skip


COMPOUND_MODES = Stage(
    subjects=compound_sets,
    inputs=compound_inputs,
    compute=_compute,
    present=_SHEET.present,
    check=_check,
    cites=citing(Citation("lin-parker", "model of the planetary set and mode types")),
    forecast=lambda _scene, _name: forecasts.constant(0.1),
)
