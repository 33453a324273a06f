"""How many of fegear's files run for one number from the case file to the report, and how many call each other.

    python benchmarks/files_of_a_number.py [--tree FOLDER] [--list] [CASE] [RESULT] [OPTION OF fegear run ...]

By default `te_peak_to_peak` of a helical pair. A file runs when one of its functions or class bodies does, is called
when a function of it is, and is loaded when its module is imported. A call of one file by another counts once, however
often and by whichever of their functions it is made: between functions of fegear only, with no library between them. It
goes upward where the called file's layer lies above its caller's (tests/architecture/test_layers_architecture.py). No
import does: what is called there was handed down, as the function that a cache keeps or a plan's results; ``--list``
names them. ``--tree`` counts in another checkout, by its own layers: one counter for two states.

Set FEGEAR_CACHE to an empty folder, or what is recalled does not run. Pictures are drawn in another process, which is
not counted.
"""

import argparse
import ast
import sys
import tempfile
import threading
from collections import Counter
from inspect import CO_OPTIMIZED
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
#: Where the order of the layers is written.
LAYERS = Path("tests/architecture/test_layers_architecture.py")


def layers_of(tree):
    """Layer of each room of a checkout, by its architecture test."""
    for node in ast.parse((tree / LAYERS).read_text("utf-8")).body:
        if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "LAYERS":
            return ast.literal_eval(node.value)
    raise SystemExit(f"{tree / LAYERS}: no LAYERS")


def main():
    asked = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    asked.add_argument("--tree", type=Path, default=ROOT)
    asked.add_argument("--list", action="store_true")
    asked.add_argument("case", nargs="?")
    asked.add_argument("result", nargs="?", default="transmission-error")
    given, options = asked.parse_known_args()
    tree = given.tree.resolve()
    package = str(tree / "fegear") + "/"
    case = given.case or str(tree / "cases" / "helical_load.toml")
    ran, called, calls = set(), set(), Counter()

    def seen(frame, event, _argument):
        if event != "call" or frame.f_code.co_name == "<module>":
            return
        code = frame.f_code
        ran.add(code.co_filename)
        if not code.co_flags & CO_OPTIMIZED:  # a class body
            return
        called.add(code.co_filename)
        caller = frame.f_back and frame.f_back.f_code
        if caller and caller.co_flags & CO_OPTIMIZED and caller.co_filename != code.co_filename:
            calls[caller.co_filename, code.co_filename] += 1

    sys.path.insert(0, str(tree))
    threading.setprofile(seen)
    sys.setprofile(seen)
    from fegear.cli import main as fegear

    with tempfile.TemporaryDirectory() as folder:
        sys.argv = ["fegear", "run", case, "--set", f'results=["{given.result}"]', "--out", f"{folder}/out", *options]
        try:
            fegear()
        except SystemExit as end:
            if end.code:
                raise
        finally:
            sys.setprofile(None)
            threading.setprofile(None)
    show(package, layers_of(tree), ran, called, calls, named=given.list)


def show(package, layers, ran, called, calls, *, named):
    """Print the counts, by rooms where there are many."""

    def room(name):
        first = name.removeprefix(package).split("/")[0].removesuffix(".py")
        return "fegear" if first == "__init__" else first

    files = sorted(name for name in ran if name.startswith(package))
    for name, count in sorted(Counter(map(room, files)).items()):
        print(f"{name}: {count}")
    loaded = [one for one in sys.modules.values() if (getattr(one, "__file__", None) or "").startswith(package)]
    count = sum(name.startswith(package) for name in called)
    print(f"{len(files)} files run, functions of {count} are called, {len(loaded)} are loaded")
    edges = [(one, other) for one, other in calls if one.startswith(package) and other.startswith(package)]
    upward = [(one, other) for one, other in edges if layers[room(other)] > layers[room(one)]]
    print(f"{len(edges)} calls of one file by another, {len(upward)} of them upward")
    if named:
        for one, other in sorted(upward):
            print(f"  {one.removeprefix(package)} -> {other.removeprefix(package)}: {calls[one, other]}")


if __name__ == "__main__":
    main()
