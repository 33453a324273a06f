"""`python -m fegear.atlas RACK [FILE]`: build the atlas of a rack of ISO 53; stopped, it goes on where it was."""

from __future__ import annotations

import sys
from pathlib import Path

from fegear.atlas.shipped import RACKS, built, file_name
from fegear.base.solution_cache import cache_on_disk
from fegear.base.store import cache_folder


def main(arguments: list[str]) -> int:
    """Build an atlas and write it."""
    if not 1 <= len(arguments) <= 2 or arguments[0] not in RACKS:
        print(f"Usage: python -m fegear.atlas RACK [FILE], with RACK one of {', '.join(RACKS)}", file=sys.stderr)
        return 2
    rack, path = arguments[0], Path(arguments[1] if len(arguments) > 1 else file_name(arguments[0]))

    def said(done: int, total: int) -> None:
        print(f"\r{done} gears solved, {total} wanted so far", end="", file=sys.stderr, flush=True)

    atlas = built(rack, cache=cache_on_disk(cache_folder()), progress=said)
    atlas.save(path)
    print(f"\n{path}: {atlas.gears} gears, {path.stat().st_size / 1e6:.2f} MB", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
