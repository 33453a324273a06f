"""How many of fegear's files run for one number on its way from a case file to the report.

    python benchmarks/files_of_a_number.py [CASE] [RESULT] [OPTION OF fegear run ...]

By default `te_peak_to_peak` of a helical pair. A file runs when one of its functions or class bodies does, is called
when a function of it is, and is loaded when its module is imported. Set FEGEAR_CACHE to an empty folder, or what is
recalled does not run. Pictures are drawn in another process, which is not counted.
"""

import sys
import tempfile
import threading
from inspect import CO_OPTIMIZED
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def main():
    case = sys.argv[1] if len(sys.argv) > 1 else str(ROOT / "cases" / "helical_load.toml")
    result = sys.argv[2] if len(sys.argv) > 2 else "transmission-error"
    ran, called = set(), set()

    def seen(frame, event, _argument):
        if event == "call" and frame.f_code.co_name != "<module>":
            ran.add(frame.f_code.co_filename)
            if frame.f_code.co_flags & CO_OPTIMIZED:  # no class body
                called.add(frame.f_code.co_filename)

    threading.setprofile(seen)
    sys.setprofile(seen)
    from fegear.cli import main as fegear

    with tempfile.TemporaryDirectory() as folder:
        sys.argv = ["fegear", "run", case, "--set", f'results=["{result}"]', "--out", f"{folder}/out", *sys.argv[3:]]
        try:
            fegear()
        except SystemExit as end:
            if end.code:
                raise
        finally:
            sys.setprofile(None)
            threading.setprofile(None)
    package = str(ROOT / "fegear")
    files = sorted(name for name in ran if name.startswith(package))
    loaded = [one for one in sys.modules.values() if (getattr(one, "__file__", None) or "").startswith(package)]
    rooms: dict[str, int] = {}
    for name in files:
        room = Path(name).relative_to(package).parts[0]
        rooms[room] = rooms.get(room, 0) + 1
    for room, count in sorted(rooms.items()):
        print(f"{room}: {count}")
    count = sum(name.startswith(package) for name in called)
    print(f"{len(files)} files run, functions of {count} are called, {len(loaded)} are loaded")


if __name__ == "__main__":
    main()
