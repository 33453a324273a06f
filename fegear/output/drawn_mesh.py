"""Drawings of the gears in mesh with the stress inside their teeth, as files for slides and paper."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, cast

from fegear.base.errors import InputError
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.sheet.load_words import loads_as_given
from fegear.engine.stage import Task
from fegear.output.draw_png.stress_drawing import write_drawing
from fegear.output.file_names import file_name
from fegear.results.catalogue import STAGES
from fegear.results.pair.drawn_mesh import stress_drawings

if TYPE_CHECKING:
    from fegear.contact.plane.loaded_pair import LoadedPair
    from fegear.output.export_formats import Request, Written
    from fegear.results.pair.stress_inside import StressInsideData


def _written(request: Request, kind: str) -> Written:
    """Draw every loaded plane pair of the gears that were asked for.

    Raises
    ------
    InputError
        If there is none whose compliance is by finite elements.
    """
    scene = request.scene
    pairs = [
        name for name in scene.plane_pairs
        if (part := scene.case.pair[name]).compliance.source == "fe" and part.all_loads(scene.pairs[name])
        and {part.driver, part.driven} & set(request.gears)
    ]  # fmt: skip
    if not pairs:
        raise InputError(
            "--format", f'"{kind}"', "requires a pair of plane (2D) gears under a load, solved by finite elements",
            "set torque of the pair, or use the window for 3D gears",
        )  # fmt: skip
    tasks = [Task(stage, name) for name in pairs for stage in ("loaded-pair", "stress-inside")]
    quiet = replace(scene, neglects=False)
    found = run_plan(quiet, make_plan(quiet, STAGES, tasks), cache=request.cache).outcomes
    files = []
    for name in pairs:
        loaded = cast("LoadedPair", found[Task("loaded-pair", name)].data)
        inside = cast("StressInsideData", found[Task("stress-inside", name)].data)
        with loads_as_given(scene, name):
            for drawing in stress_drawings(name, loaded.engagement, loaded.nominal, inside):
                files.append(request.folder / f"{file_name(f'mesh_{name}_{drawing.letter}')}.{kind}")
                write_drawing(drawing, scene.name, files[-1])
    return files, ()


written_svg, written_pdf = (partial(_written, kind=kind) for kind in ("svg", "pdf"))
