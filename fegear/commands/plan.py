"""``fegear plan``: what a case would compute, before it does."""

from __future__ import annotations

import typer

from fegear.commands.common import CaseFile, Overrides


def plan(case: CaseFile, overrides: Overrides = None) -> None:
    """Show what a case would compute and why, with which settings, in about how long, and what it would not."""
    from fegear.case.reading import read_scene
    from fegear.engine.plan import make_plan
    from fegear.engine.plan_text import plan_lines
    from fegear.results.catalogue import STAGES

    scene = read_scene(case, overrides or ())
    typer.echo("\n".join(plan_lines(scene, make_plan(scene, STAGES))))
