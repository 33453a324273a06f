"""``fegear export``: drawings and meshes for other programs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from fegear.commands.common import INTERRUPTED, AsJson, CaseFile, Overrides, Quiet, Voice, leave, out_option


def export(
    case: CaseFile,
    overrides: Overrides = None,
    gear: Annotated[list[str] | None, typer.Option("--gear", help="Name of a gear; default all of them.")] = None,
    formats: Annotated[
        str,
        typer.Option(
            "--format", help="Any of dxf, step, relief, msh, vtu, inp, solid-inp, solid-vtu, fmu, separated by commas."
        ),
    ] = "dxf,msh,vtu,inp",
    out: Annotated[Path | None, out_option("Output folder; default results/<case>_export.")] = None,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> None:
    """Write drawings (DXF), solids (STEP), reliefs to grind (CSV), meshes of the whole gear, FMUs of its mesh."""
    from fegear.case.reading import read_scene
    from fegear.output.export import export_gears
    from fegear.output.folder import default_folder, whole_or_nothing

    voice = Voice(quiet, as_json)
    try:
        scene = read_scene(case, overrides or ())
        target = out or default_folder(scene.name, "_export")
        with whole_or_nothing(target) as scratch:
            written = export_gears(scene, scratch, gear or (), formats)
    except KeyboardInterrupt:
        leave(INTERRUPTED, 130)
    for name in written.files:
        voice.say(f"Wrote {target / name}")
    for remark in written.remarks:
        voice.note(remark)
    voice.tell({"folder": str(target), "files": written.files, "remarks": written.remarks})
