"""Hook of mkdocs and Markdown extension: TeX between dollar signs becomes MathML while the site is built.

Browsers draw MathML by themselves, so the pages need neither a script nor a network; only the font, without which
brackets and roots do not grow, comes with the site (STIX Two Math, SIL Open Font License, as packaged by ziamath).
``$$`` alone on a line opens and closes a displayed equation, which gets a number on its page; ``$...$`` stands in a
line of text.
"""

from __future__ import annotations

import itertools
import re
import xml.etree.ElementTree as ET
from importlib.metadata import distribution
from pathlib import Path

from latex2mathml.converter import convert
from markdown.extensions import Extension
from markdown.inlinepatterns import InlineProcessor
from markdown.preprocessors import Preprocessor
from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File

#: Before it, fenced code has been stashed away (25) and HTML blocks have not yet been (20).
_AFTER_FENCES = 22
#: After `code` (190), before backslash escapes (180).
_AFTER_CODE = 185
_FONT = Path(str(distribution("ziamath").locate_file("ziamath/fonts/STIXTwoMath-Regular.ttf")))
_DISPLAY = re.compile(r"^\$\$\n(.*?)\n\$\$$", re.DOTALL | re.MULTILINE)
_INLINE = r"(?<![\\$\w])\$(?![\s$])([^$\n]+?)(?<![\s\\])\$(?![\w$])"
#: The sign for a prime is raised as it is; raised again it is too small to see.
_PRIME = re.compile(r"<msup>(<mi>[^<]+</mi>)<mi>&#x02032;</mi></msup>")
#: Names of functions keep off what stands before and behind them; the converter sets them as plain letters.
_NAMES = "<mi>(?:sin|cos|tan|ln|log)</mi>"
_FUNCTION = re.compile(rf"(<msup>{_NAMES}<mn>\d</mn></msup>|(?<!<msup>){_NAMES})")
_FUNCTION_AFTER = re.compile(rf"(</mi>|</mn>|</msub>)(?=<msup>{_NAMES}|{_NAMES})")


def mathml(tex: str, *, display: bool) -> str:
    """MathML of an equation; what the converter does not know is refused, for it would be printed as it stands."""
    text = convert(tex, display="block" if display else "inline")
    text = _FUNCTION.sub(r"\1<mspace width='0.17em' />", _FUNCTION_AFTER.sub(r"\1<mspace width='0.17em' />", text))
    text = _PRIME.sub(r"<mrow>\1<mo lspace='0' rspace='0'>&#x02032;</mo></mrow>", text)
    try:
        root = ET.fromstring(text)
    except ET.ParseError:
        raise PluginError(f"the equation {tex!r} does not become MathML") from None
    left = [node.text for node in root.iter() if node.text and ("\\" in node.text or "&" in node.text)]
    if left:
        raise PluginError(f"the equation {tex!r} has parts that do not become MathML: {left}")
    return text


class _Displayed(Preprocessor):
    def run(self, lines: list[str]) -> list[str]:
        count = itertools.count(1)

        def stash(found: re.Match[str]) -> str:
            number = next(count)
            html = (
                f'<div class="equation" id="equation-{number}">{mathml(found[1], display=True)}'
                f'<a class="number" href="#equation-{number}">({number})</a></div>'
            )
            return f"\n{self.md.htmlStash.store(html)}\n"

        return _DISPLAY.sub(stash, "\n".join(lines)).split("\n")


class _Inline(InlineProcessor):
    def handleMatch(self, m: re.Match[str], data: str):  # type: ignore[override]  # noqa: ARG002  (markdown's interface)
        return self.md.htmlStash.store(mathml(m[1], display=False)), m.start(0), m.end(0)


class Equations(Extension):
    """Equations in TeX."""

    def extendMarkdown(self, md):
        """Register both forms."""
        md.preprocessors.register(_Displayed(md), "displayed_equations", _AFTER_FENCES)
        md.inlinePatterns.register(_Inline(_INLINE, md), "inline_equations", _AFTER_CODE)


def on_config(config):
    """Let every page have equations."""
    config.markdown_extensions.append(Equations())
    return config


def on_files(files, config):
    """Put the font beside the style sheet that names it."""
    files.append(File.generated(config, _FONT.name, content=_FONT.read_bytes()))
    return files
