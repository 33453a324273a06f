"""The parts of a case file, one file per part."""

from fegear.case.model import Case

__all__ = ["Case"]
