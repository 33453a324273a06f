"""The solid of a gear as a STEP file, with the relief that the case gives it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.case.built.flank_modifications import described_relief
from fegear.fem.solid.step_model import seconds_of_step, write_step
from fegear.geometry.outline import relieved_outline
from fegear.output.file_names import file_name

if TYPE_CHECKING:
    from fegear.geometry.gear import Gear
    from fegear.output.export_formats import Request, Written


def seconds_of(gear: Gear) -> float:
    """About how many seconds of CPU time the file of a gear takes."""
    return seconds_of_step(gear.teeth)


def written_step(request: Request) -> Written:
    """Write ``<gear>.step``."""
    name, gear, part = request.name, request.gear, request.scene.case.gear[request.name]
    reliefs = [described_relief(request.scene, name, back=back).relief for back in (False, True)]
    path = request.folder / f"{file_name(name)}.step"
    pieces, back = (
        None if relief is None else relieved_outline(one, relief)
        for one, relief in zip((gear, gear.from_the_back), reliefs, strict=True)
    )
    write_step(path, gear, pieces, back=back if gear.asymmetric else None)
    remarks = []
    if part.face_width is None:
        remarks.append(
            f"Gear {name}, STEP: face width {gear.face_width * 1e3:.6g} mm assumed (face_width not specified)."
        )
    if part.body is not None:
        remarks.append(f"Gear {name}, STEP: solid disc of full face width; add web and hub in CAD.")
    return [path], remarks
