"""Which libraries a plan needs that are not installed."""

from __future__ import annotations

from fegear.base.errors import MissingLibraryError
from fegear.base.extras import absent, install
from fegear.engine.plan import Plan

#: Without them a run goes on, and says what it did not draw.
_PICTURES = ("space",)


def missing(plan: Plan, *, plots: bool = True) -> tuple[str, ...]:
    """Extras that a plan needs and that are not installed, pictures' only with `plots`."""
    wanted = dict.fromkeys(step.stage.extra for step in plan.steps if step.stage.extra)
    return tuple(extra for extra in wanted if (plots or extra not in _PICTURES) and absent(extra))


def require(plan: Plan) -> None:
    """Refuse a plan that cannot be computed with what is installed, before anything is.

    Raises
    ------
    MissingLibraryError
    """
    for extra in missing(plan, plots=False):
        raise MissingLibraryError(f"{install(extra)}.")
