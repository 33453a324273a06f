"""Drafts of case files: commented, ready to run, and to be changed by their reader."""

from fegear.drafts.answers import Answers, Question, check, questions
from fegear.drafts.kinds import KINDS, Kind
from fegear.drafts.text import draft

__all__ = ["KINDS", "Answers", "Kind", "Question", "check", "draft", "questions"]
