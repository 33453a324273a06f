"""``fegear plan``: what a case would compute, before it does."""

from __future__ import annotations

from fegear.commands.common import AsJson, CaseFile, Overrides, Voice, Wanted, changes


def plan(case: CaseFile, overrides: Overrides = None, wanted: Wanted = None, as_json: AsJson = False) -> None:
    """Show what a case would compute and why, with which settings, in about how long, and what it would not."""
    from fegear.case.reading import read_scene
    from fegear.engine.plan import make_plan
    from fegear.engine.plan_text import plan_content, plan_lines
    from fegear.results.catalogue import STAGES

    voice = Voice(as_json=as_json)
    scene = read_scene(case, changes(overrides, wanted))
    planned = make_plan(scene, STAGES)
    for line in plan_lines(scene, planned):
        voice.say(line)
    voice.tell(plan_content(scene, planned))
