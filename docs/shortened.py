"""What a shortened site runs: ``FEGEAR_GALLERY=helical_pair,tutorial`` these, ``-helical_pair,...`` all but these."""

from __future__ import annotations

import os


def chosen(name: str) -> bool:
    """Whether a case or page is run for this site, by its name without folders."""
    wanted = os.environ.get("FEGEAR_GALLERY")
    if wanted is None:
        return True
    names = wanted.split(",")
    left_out = {one[1:] for one in names if one.startswith("-")}
    return name not in left_out if left_out else name in names
