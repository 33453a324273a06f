"""The helical pair of ``[transmissibility.NAME]``: its mesh, its model, and the model at another parameter value."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

from fegear.case.csv_columns import read_columns
from fegear.case.part import at
from fegear.dynamics.helical_pair import HelicalPairModel
from fegear.dynamics.mesh_parameters import partial_face_mu
from fegear.errors import InputError

if TYPE_CHECKING:
    from pathlib import Path

    import numpy as np
    from numpy.typing import NDArray

    from fegear.case.reading import Scene
    from fegear.case.transmissibility import TransmissibilityPart
    from fegear.dynamics.helical_pair import ReducedPairModel
    from fegear.dynamics.mesh_parameters import MeshParameters

#: Columns of a load distribution file.
_DISTRIBUTION = {"z": "length", "load": "line_load", "deflection": "length"}
_HEADS = ("z [mm]", "load [N/mm]", "deflection [um]")
#: Parameters of the mesh as a case calls them, and the names of its fields.
_OF_MESH = {"base_helix_angle": "base_helix_angle", "kappa": "kappa", "mu": "mu", "mesh_stiffness": "stiffness"}


def mesh_of(scene: Scene, name: str) -> MeshParameters:
    """The mesh of a pair, from its numbers or from a load distribution over the face."""
    from fegear.dynamics.mesh_parameters import mesh_parameters

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
            raise InputError(key, f'"{path.name}"', f"has no column {head}", f"heads are {', '.join(_HEADS)}")
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
            if parameter == "kappa" and part.mesh.mu is None and part.mesh.distribution is None:
                changed["mu"] = partial_face_mu(value)
            return part.build(replace(mesh, **changed), prefix)
        if parameter != "bearing_stiffness":
            unity = part.unity_ratio.model_copy(update={parameter: value})  # type: ignore[union-attr]
            return part.model_copy(update={"unity_ratio": unity}).build(mesh, prefix)
        model = part.build(mesh, prefix)
        if isinstance(model, HelicalPairModel):
            i, j = (replace(g, bearing_stiffness=value * g.bearing_stiffness) for g in (model.driver, model.driven))
            return replace(model, driver=i, driven=j)
        return replace(model, bearing_stiffness=value * model.bearing_stiffness)
    except InputError as error:
        found = f"{math.degrees(value):.6g} deg" if parameter == "base_helix_angle" else value
        raise type(error)(f"{prefix}.follow.{parameter}", found, error.rule, error.remedy) from None
