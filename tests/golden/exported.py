"""What exports write, kept in ``exported.json``: drawings, grinding tables, meshes and models of a few gears.

    python tests/golden/exported.py [--accept]

Of each file it is kept how many numbers it has, a sum of them in which every one has a weight of its own, and a
checksum of what stands between them; of a mesh for ParaView the numbers of its points, cells and fields. Heads with
dates do not count, nor what a program says of itself.
"""

import argparse
import json
import re
import sys
import tempfile
import zlib
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
KEPT = Path(__file__).with_suffix(".json")
COARSE = ("accuracy.tolerance=0.3",)
#: Case, what makes it cheap, gears (none: all) and formats, by name.
EXPORTS = {
    "relieved": ("spur_misaligned", (), ("pinion",), "dxf,relief"),
    "meshes": ("pinion_and_wheel", COARSE, ("pinion",), "msh,vtu,inp"),
    "model": ("gearbox_misaligned", (), (), "rexs"),
    "ring": ("ring_gear", (), (), "dxf"),
    "asymmetric": ("asymmetric_pair", (), ("wheel",), "dxf"),
    "rack": ("rack_and_pinion", (), ("axis",), "dxf"),
    "meshed rack": (
        "rack_and_pinion",
        (*COARSE, "rack.axis.teeth=2", "rack.axis.face_width=4 mm"),
        ("axis",),
        "msh,vtu,inp,solid-inp",
    ),
    "solid": ("helical_pair", (*COARSE, "gear.pinion.face_width=4 mm"), ("pinion",), "solid-inp,solid-vtu"),
}
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")


def told(numbers, words=""):
    """Count of numbers, sum of their logarithms in which each has a weight of its own, checksum of the words."""
    found = np.array([*numbers, 0.0], dtype=float)
    weights = np.cos(1.0 + 2.399963 * np.arange(found.size))  # turned by the golden angle: no two alike
    mixed = np.dot(
        weights, np.sign(found) * np.log(1.0 + np.abs(found) / 1e-6)
    )  # of round-off in a zero little is left
    return [found.size - 1, float(f"{mixed:.8g}"), zlib.crc32(words.encode())]


def of_file(path):
    """What is kept of a file."""
    if path.suffix == ".vtu":
        import meshio

        mesh = meshio.read(path)
        parts = [mesh.points, *(block.data for block in mesh.cells), *mesh.point_data.values()]
        parts += [part for of_blocks in mesh.cell_data.values() for part in of_blocks]
        names = [*mesh.point_data, *mesh.cell_data, *(block.type for block in mesh.cells)]
        return told(np.concatenate([np.ravel(part).astype(float) for part in parts]), " ".join(names))
    text = path.read_text("utf-8", errors="replace")
    for begin, end in (("ENTITIES", "ENDSEC"), ("<relations>", "</model>")):
        text = text.partition(begin)[2].partition(end)[0] or text  # what stands around them has dates
    lines = "\n".join(line for line in text.split("\n") if not line.startswith("**"))  # comments of a deck
    return told([float(one) for one in _NUMBER.findall(lines)], _NUMBER.sub("#", lines))


def of_export(name):
    """What is kept of an export, by file, and how many sentences it says."""
    from fegear.case.reading import read_scene
    from fegear.output.export import export_gears

    case, changes, gears, formats = EXPORTS[name]
    scene = read_scene(ROOT / "cases" / f"{case}.toml", changes)
    with tempfile.TemporaryDirectory() as folder:
        export_gears(scene, Path(folder), gears, formats)
        return {path.name: of_file(path) for path in sorted(Path(folder).iterdir())}


def kept():
    """All that is kept, by export and file."""
    return json.loads(KEPT.read_text("utf-8")) if KEPT.exists() else {}


def differences(old, new):
    """What differs, in words."""
    return [
        f"{file}: {old.get(file)} was kept, {new.get(file)} is found"
        for file in {**old, **new} if not same(old.get(file), new.get(file))
    ]  # fmt: skip


def same(one, other):
    """Whether two files are the same but for round-off."""
    if one is None or other is None:
        return False
    return [one[0], one[2]] == [other[0], other[2]] and abs(one[1] - other[1]) <= 1e-6 * max(1.0, abs(one[1]))


def main():
    """Compare, or keep."""
    wishes = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    wishes.add_argument("--accept", action="store_true", help="keep what is found")
    asked, new = wishes.parse_args(), {name: of_export(name) for name in EXPORTS}
    for name, files in new.items():
        print(name, *differences(kept().get(name, {}), files), sep="\n  ")
    if asked.accept:
        parts = []
        for name, files in new.items():
            lines = [f"  {json.dumps(file)}: {json.dumps(one)}" for file, one in files.items()]
            parts.append(f" {json.dumps(name)}: {{\n" + ",\n".join(lines) + "\n }")
        KEPT.write_text("{\n" + ",\n".join(parts) + "\n}\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
