"""``gear.NAME.tooth_mesh``: a user's own mesh in place of the generated one."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.fem.mesh import SectorMesh


def own_sector_mesh(scene: Scene, name: str) -> SectorMesh | None:
    """Read the tooth mesh that the case names for a gear, in millimetres; None if it names none.

    Parameters
    ----------
    scene : Scene
    name : str
        Name of the gear.

    Raises
    ------
    InputError
        If the file is missing or its mesh cannot be used.
    """
    part = scene.case.gear[name]
    file = part.tooth_mesh
    if file is None:
        return None
    from fegear.fem.imported import read_sector_mesh

    gear, key = scene.gears[name], f"gear.{name}.tooth_mesh"
    own = part.tooth_mesh_fillet == "own"
    return read_sector_mesh(scene.file(file, key), gear.tooth, gear.module, gear.bore_radius, key=key, own_fillet=own)
