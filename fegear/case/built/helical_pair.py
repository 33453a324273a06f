"""The helical pair of ``[transmissibility.NAME]``: its mesh, its model, and the model at another parameter value."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fegear.base.arrays import Array
from fegear.base.errors import InputError
from fegear.case.csv_file import read_columns
from fegear.case.part import at
from fegear.case.reading import Scene
from fegear.case.transmissibility import TransmissibilityPart
from fegear.dynamics.helical_pair.mesh_parameters import MeshParameters, partial_face_mu
from fegear.dynamics.helical_pair.model import HelicalPairModel, ReducedPairModel
from fegear.dynamics.train.modes import undamped_modes
from fegear.geometry.pair import MEMBERS, GearPair, Member

#: Columns of a load distribution file.
_DISTRIBUTION = {"z": "length", "load": "line_load", "deflection": "length"}
_HEADS = ("z [mm]", "load [N/mm]", "deflection [um]")
#: A mesh that fits any range, in place of one that is not known yet.
_ANY_MESH = MeshParameters(1.0, 0.0, 1e300)
#: Parameters of the mesh as a case calls them, and the names of its fields.
_OF_MESH = {"base_helix_angle": "base_helix_angle", "kappa": "kappa", "mu": "mu", "mesh_stiffness": "stiffness"}


@dataclass(frozen=True)
class HelicalPairInputs:
    """What the model of a pair depends on besides the loaded flanks that its mesh may be taken from.

    Parameters
    ----------
    part : TransmissibilityPart
        With the mass and size of the gears of its mesh's pair.
    mesh : MeshParameters or None
        None where the mesh is that of a pair of the case.
    pair : GearPair or None
        That pair.
    name : str
    """

    part: TransmissibilityPart
    mesh: MeshParameters | None
    pair: GearPair | None
    name: str = field(compare=False)

    @property
    def prefix(self) -> str:
        """Of its keys."""
        return f"transmissibility.{self.name}"

    def refuse_unbuilt(self) -> None:
        """Refuse a model that cannot be built; where the mesh comes from loaded flanks, only they can say the rest."""
        self.part.build(self.mesh or _ANY_MESH, self.prefix)

    def refuse_unbuilt_ranges(self) -> None:
        """Refuse followed ranges in which no model can be built: what limits a range limits its ends and responses."""
        mesh = self.mesh or _ANY_MESH
        for parameter, asked in (self.part.follow.ranges if self.part.follow else {}).items():
            for value in (*asked.ends, *asked.responses):
                model_at(self.part, mesh, self.name, parameter, value)


def helical_pair_inputs(scene: Scene, name: str) -> HelicalPairInputs:
    """Collect what a case says of ``[transmissibility.NAME]``.

    Raises
    ------
    InputError
        If a half face width is not that which kappa and mu of the pair count in, or the model cannot be built.
    """
    part = scene.case.transmissibility[name]
    if part.mesh.pair is None:
        found = HelicalPairInputs(part, mesh_of(scene, name), None, name)
        found.refuse_unbuilt()
        return found
    pair = scene.pairs[part.mesh.pair]
    half = 0.5 * pair.face_width
    for role in MEMBERS:
        given = getattr(part, role)
        if given is not None and given.half_face_width is not None and abs(given.half_face_width - half) > 1e-9 * half:
            raise InputError(
                f"transmissibility.{name}.{role}.half_face_width", f"{given.half_face_width * 1e3:.6g} mm",
                f"is not half the common face width of pair {part.mesh.pair}, {half * 1e3:.6g} mm", "remove it",
            )  # fmt: skip
    found = HelicalPairInputs(part.with_gears(*(_body(pair, m) for m in MEMBERS)), None, pair, name)
    found.refuse_unbuilt()
    return found


def _body(pair: GearPair, member: Member) -> dict[str, float]:
    """Mass, inertia and size of a gear."""
    gear = pair.gear(member)
    body = gear.mass_properties
    tilt = body.inertia_at_mid_face  # the model's mesh and bearings stand there
    return {
        "mass": body.mass, "inertia_x": tilt, "inertia_y": tilt, "inertia_z": body.inertia,
        "base_radius": gear.base_radius, "half_face_width": 0.5 * pair.face_width,
    }  # fmt: skip


def mesh_of_pair(pair: GearPair, stiffness: float, kappa: float, mu: float) -> MeshParameters:
    """K_M [N/m], kappa and mu of loaded flanks as the mesh of the model.

    Its axes: y along the line of action toward the driver's tip, z along the driver's axis, rotations clockwise.
    """
    from fegear.contact.wide.lines import base_twist
    from fegear.dynamics.helical_pair.mesh_parameters import MeshParameters

    return MeshParameters(stiffness, kappa, mu, math.atan(base_twist(pair)))


def full_matrix_frequencies(model: HelicalPairModel, mesh: Array) -> Array:
    """Natural frequencies [rad/s], falling, with any mesh stiffness over q of both gears, rotations either way round.

    Parameters
    ----------
    model : HelicalPairModel
        Masses and bearings.
    mesh : ndarray, shape (10, 10)
        [N/m]; see `fegear.contact.wide.mesh_matrix`.
    """
    turned = np.tile([1.0, 1.0, -1.0, -1.0, -1.0], 2)  # right-handed rotations there, clockwise ones here
    bearings = np.zeros((10, 10))
    for first, gear in ((0, model.driver), (5, model.driven)):
        bearings[first : first + 5, first : first + 5] = gear.in_q(gear.bearing_stiffness)
    return undamped_modes(model.mass, turned[:, None] * mesh * turned + bearings)[0]


def mesh_of(scene: Scene, name: str) -> MeshParameters:
    """The mesh of a pair, from its numbers or from a load distribution over the face."""
    from fegear.dynamics.helical_pair.mesh_parameters import mesh_parameters

    part, prefix = scene.case.transmissibility[name].mesh, f"transmissibility.{name}.mesh"
    try:
        if part.distribution is None:
            return part.build()
        key = f"{prefix}.distribution"
        z, load, deflection = _read_distribution(scene.file(part.distribution, key), key)
        return mesh_parameters(
            z, load, deflection, face_width=part.face_width or math.nan, base_helix_angle=part.base_helix_angle
        )
    except InputError as error:
        of_case = error.key.startswith(prefix)
        raise error if of_case else at(prefix, error, {error.key: error.key.removeprefix("mesh.")}) from None


def _read_distribution(path: Path, key: str) -> list[NDArray[np.float64]]:
    columns = read_columns(path, key, _DISTRIBUTION)
    for name, head in zip(_DISTRIBUTION, _HEADS, strict=True):
        if name not in columns:
            rule = f"has no column {head}; it has {columns.has}"
            raise InputError(key, f'"{path.name}"', rule, f"heads are {', '.join(_HEADS)}")
    return [columns[name] for name in _DISTRIBUTION]


def own_value(part: TransmissibilityPart, mesh: MeshParameters, parameter: str) -> float:
    """Value of a parameter in the case itself."""
    if parameter in _OF_MESH:
        return float(getattr(mesh, _OF_MESH[parameter]))
    return 1.0 if parameter == "bearing_stiffness" else float(getattr(part.unity_ratio, parameter))


def model_at(
    part: TransmissibilityPart, mesh: MeshParameters, name: str, parameter: str, value: float
) -> HelicalPairModel | ReducedPairModel:
    """The pair with one parameter changed; `mu` follows `kappa` where the case leaves it to.

    Parameters
    ----------
    part : TransmissibilityPart
    mesh : MeshParameters
        Of the case.
    name : str
        Of the pair, for messages.
    parameter : str
        A key of ``follow``.
    value : float
        In SI.
    """
    prefix = f"transmissibility.{name}"
    try:
        if parameter in _OF_MESH:
            changed = {_OF_MESH[parameter]: value}
            own = part.mesh.distribution is None and part.mesh.pair is None
            if parameter == "kappa" and part.mesh.mu is None and own:
                changed["mu"] = partial_face_mu(value)
            return part.build(replace(mesh, **changed), prefix)
        if parameter != "bearing_stiffness":
            unity = part.unity_ratio.model_copy(update={parameter: value})  # type: ignore[union-attr]  # asked for where there is one
            return part.model_copy(update={"unity_ratio": unity}).build(mesh, prefix)
        model = part.build(mesh, prefix)
        if isinstance(model, HelicalPairModel):
            i, j = (replace(g, bearing_stiffness=value * g.bearing_stiffness) for g in (model.driver, model.driven))
            return replace(model, driver=i, driven=j)
        return replace(model, bearing_stiffness=value * model.bearing_stiffness)
    except InputError as error:
        found = f"{math.degrees(value):.6g} deg" if parameter == "base_helix_angle" else value
        key = f"{prefix}.follow.{parameter}"
        if error.key.rpartition(".")[2] in (parameter, _OF_MESH.get(parameter)):
            raise type(error)(key, found, error.rule, error.remedy) from None
        rule = f"contradicts {error.key.removeprefix(prefix + '.')} = {error.value}, which {error.rule}"
        raise type(error)(key, found, rule, f"reduce the range of {parameter}, or change the other value") from None
