"""``fegear verify``: repeat on this machine what fegear's numbers are compared with."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from fegear.commands.arguments import AsJson, Quiet
from fegear.commands.terminal import INTERRUPTED, Voice, leave

if TYPE_CHECKING:
    from fegear.verify.row import Outcome


def verify(
    rows: Annotated[list[str] | None, typer.Argument(metavar="[ROW]...", help="Checks to run. Default: all.")] = None,
    against: Annotated[
        str | None, typer.Option("--against", help="Only checks of one kind: printed, program or own.")
    ] = None,
    only_list: Annotated[bool, typer.Option("--list", help="List the checks without running them.")] = False,
    quiet: Quiet = False,
    as_json: AsJson = False,
) -> None:
    """Compare fegear with printed numbers, other programs and independent code, here and now.

    Exit code 0: every row holds; 1: some do not.
    """
    from fegear.base.errors import MissingLibraryError
    from fegear.verify.row import AGAINST, run
    from fegear.verify.rows import chosen, said

    voice = Voice(quiet, as_json)
    wanted = chosen(rows or (), against)
    found: list[Outcome] = []
    try:
        with voice.watcher() as watching:
            for kind, means in AGAINST.items():
                group = [row for row in wanted if row.against == kind]
                if group:
                    voice.say(f"\nCompared with {means}:")
                for row in group:
                    if only_list:
                        voice.say(f"  {row.name:42} {row.capability}")
                        continue
                    watching.begin(row.capability, len(found) + 1, len(wanted))
                    try:
                        found.append(run(row))
                    except MissingLibraryError as error:
                        voice.say(f"  {row.name:42} not run: {error}")
                        continue
                    watching.end(found[-1].seconds)
                    voice.say(said(found[-1]))
    except KeyboardInterrupt:
        leave(INTERRUPTED, 130)
    if only_list:
        voice.tell(
            {"rows": [{"name": row.name, "against": row.against, "capability": row.capability} for row in wanted]}
        )
        return
    holding, numbers = sum(one.holds for one in found), sum(len(one.compared) for one in found)
    seconds = sum(one.seconds for one in found)
    voice.say(f"\n{holding} of {len(found)} checks passed, {numbers} values, {seconds:.0f} s CPU time.")
    voice.tell({"rows": [one.plain() for one in found], "holding": holding, "seconds": seconds})
    if holding < len(found):
        raise typer.Exit(1)
