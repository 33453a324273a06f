"""Make what docs/effects.md shows: one picture for each effect, and the tables of stages and kernels.

Run as ``python docs/effect_pictures.py [--tables] [EFFECT ...]``; the pictures go to docs/images/effects, the tables
between their marks in docs/effects.md. With ``--tables`` nothing is computed; with names, their pictures only.
"""

from __future__ import annotations

import shutil
import sys
import tempfile
from pathlib import Path

from fegear.base.effects import EFFECTS
from fegear.case.reading import read_scene
from fegear.output.effects import sentence, write_effects
from fegear.studies.effects import effect_study, kernel_table, stage_table

DOCS = Path(__file__).parent
CASES = DOCS.parent / "cases"
SPEEDS = "dynamics.speeds={ start = '2000 rpm', stop = '16000 rpm', count = 57 }"
FACTOR = ('results=["dynamic-factor"]', SPEEDS)
#: Case, options and effects of pictures that show more than the scenes of their effects.
LARGER = (
    ("pinion_and_wheel", (), ("neighbour_coupling", "hertz", "corner_contact")),
    ("lin_dynamic_factor", FACTOR, ("contact_loss", "parametric", "friction")),
    ("litvin_shaft_angle", (), ("misalignment",)),
    (
        "torque_ripple",
        ('results=["dynamic-factor"]', "effects.contact_loss=false", "effects.parametric=false",
         "train.mesh.I.backlash=unlimited", "dynamics.speeds={ start = '1200 rpm', stop = '4000 rpm', count = 57 }"),
        ("torque_ripple",),
    ),
)  # fmt: skip


def studies() -> list[tuple[str, tuple[str, ...], tuple[str, ...]]]:
    """Case, options and effects of every picture."""
    drawn = {effect for _, _, effects in LARGER for effect in effects}
    others = [(row.scene[0], row.scene[1:], (name,)) for name, row in EFFECTS.items() if name not in drawn]
    return [*LARGER, *others]


def replaced(text: str, mark: str, new: str) -> str:
    """Text with what stands between the two marks exchanged."""
    start, end = f"<!-- {mark} -->", f"<!-- end of {mark} -->"
    before, rest = text.split(start)
    return f"{before}{start}\n{new}\n{end}{rest.split(end)[1]}"


def main(only: tuple[str, ...] | None = None) -> None:
    """Run the studies of all effects, or of some, and write."""
    images = DOCS / "images" / "effects"
    images.mkdir(parents=True, exist_ok=True)
    for name, overrides, drawn in studies():
        effects = drawn if only is None else tuple(effect for effect in drawn if effect in only)
        if not effects:
            continue
        scene, switched, fixed = effect_study(CASES / f"{name}.toml", overrides, effects)
        if fixed:
            raise SystemExit(f"{name}: {fixed}")
        with tempfile.TemporaryDirectory() as scratch:
            write_effects(scene, switched, fixed, Path(scratch))
            for found in switched:
                shutil.copy(Path(scratch) / "plots" / f"effect_{found.effect}.png", images / f"{found.effect}.png")
                print(sentence(found))
    page = DOCS / "effects.md"
    text = page.read_text("utf-8")
    text = replaced(text, "stages", stage_table(read_scene(path) for path in sorted(CASES.glob("*.toml"))))
    page.write_text(replaced(text, "kernels", kernel_table()), "utf-8")


if __name__ == "__main__":
    named = tuple(sys.argv[1:])
    if unknown := sorted({*named} - {*EFFECTS, "--tables"}):
        raise SystemExit(f"{', '.join(unknown)}: unknown effect; known here: {', '.join(sorted(EFFECTS))}")
    main(named or None)
