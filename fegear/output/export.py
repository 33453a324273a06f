"""``fegear export``: drawings and meshes of the gears of a case."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.case.names import nearest
from fegear.errors import InputError
from fegear.models.settings import mesh_settings
from fegear.models.tooth_mesh import own_sector_mesh
from fegear.output.dxf import write_dxf
from fegear.output.file_names import file_name

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from fegear.case.reading import Scene

FORMATS = ("dxf", "msh", "vtu", "inp")


def export_gears(scene: Scene, folder: Path, names: Sequence[str], formats: str) -> list[str]:
    """Write every format of every named gear.

    Parameters
    ----------
    scene : Scene
    folder : Path
    names : sequence of str
        Gears of the scene.
    formats : str
        Formats separated by commas.

    Returns
    -------
    list of str
        Names of the files.

    Raises
    ------
    InputError
        If a gear or a format is unknown.
    """
    wanted = {part.strip() for part in formats.split(",") if part.strip()}
    for one in sorted(wanted.difference(FORMATS)):
        raise InputError("--format", f'"{one}"', "is no format that fegear writes", nearest(one, FORMATS))
    if not wanted:
        raise InputError("--format", f'"{formats}"', "names no format", f"choose from {', '.join(FORMATS)}")
    written: list[Path] = []
    for name in names:
        if name not in scene.gears:
            raise InputError("--gear", f'"{name}"', "is no gear of this case", nearest(name, scene.gears))
        if "dxf" in wanted:
            written += write_dxf(scene.gears[name], folder, file_name(name))
        if wanted.difference({"dxf"}):
            from fegear.output.mesh_export import write_meshes

            settings, mesh = mesh_settings(scene.case.accuracy), own_sector_mesh(scene, name)
            written += write_meshes(scene.gears[name], folder, file_name(name), wanted, settings, mesh)
    return [path.name for path in written]
