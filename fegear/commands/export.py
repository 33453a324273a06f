"""``fegear export``: drawings and meshes for other programs."""

from __future__ import annotations

import stat
from pathlib import Path
from typing import Annotated

import typer

from fegear.commands.arguments import AsJson, CaseFile, Overrides, Quiet, out_option
from fegear.commands.terminal import INTERRUPTED, Voice, leave
from fegear.output.export_formats import FORMATS


def export(
    case: CaseFile,
    overrides: Overrides = None,
    gear: Annotated[list[str] | None, typer.Option("--gear", help="Name of a gear or rack. Default: all.")] = None,
    formats: Annotated[
        str,
        typer.Option(
            "--format",
            help=f"Any of {', '.join(FORMATS)}, separated by commas; formats of other distributions by their names.",
        ),
    ] = "dxf,msh,vtu,inp",
    out: Annotated[Path | None, out_option("Output folder. Default: results/<case>_export.")] = None,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> None:
    """Write drawings (DXF), solids (STEP), reliefs for grinding (CSV), FE meshes, mesh FMUs or a REXS model.

    CASE can also be the results folder of a run: formats that hold results (rexs) then contain them.
    """
    from fegear.base.errors import InputError
    from fegear.case.reading import build_scene, read_scene
    from fegear.case.text_file import leads_to
    from fegear.output.export import export_gears, wanted_formats
    from fegear.output.folder import default_folder, whole_or_nothing
    from fegear.output.run_folder import read_side

    voice = Voice(quiet, as_json)
    results = read_side(case, "CASE") if leads_to(case, stat.S_ISDIR) else None
    if results is not None and not all(row.takes_results for row in wanted_formats(formats).values()):
        taking = " or ".join(name for name, row in FORMATS.items() if row.takes_results)
        rule = f"is a results folder, which can be exported as {taking} only"
        raise InputError("CASE", str(case), rule, f"use --format {taking}, or specify the case file")
    try:
        if results is None:
            scene = read_scene(case, overrides or ())
        else:
            scene = build_scene(dict(results.document), case.resolve().name, case)
        target = out or default_folder(scene.name, "_export")
        with whole_or_nothing(target) as scratch:
            written = export_gears(scene, scratch, gear or (), formats, results, voice.say)
    except KeyboardInterrupt:
        leave(INTERRUPTED, 130)
    for name in written.files:
        voice.say(f"Wrote {target / name}")
    for remark in written.remarks:
        voice.note(remark)
    voice.tell({"folder": str(target), "files": written.files, "remarks": written.remarks})
