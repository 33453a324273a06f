"""Hook of mkdocs: every link, picture and style of the finished site leads to a file of the site or to the web.

What the browser loads with a page (pictures, styles, scripts) must not come from the web at all.
"""

from __future__ import annotations

import os
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

from mkdocs.exceptions import PluginError


class _Links(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.found: set[tuple[str, bool]] = set()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        for name in ("href", "src"):
            if given.get(name):
                self.found.add((str(given[name]), name == "src" or tag == "link"))


def faults(site: Path) -> list[str]:
    """Links of the site's pages that lead nowhere, or that would be fetched; reports of runs are not looked at."""
    found = []
    for page in sorted(site.rglob("*.html")):
        if page.name == "report.html" or page.name == "404.html":
            continue
        links = _Links()
        links.feed(page.read_text("utf-8"))
        for link, loaded in sorted(links.found):
            parts = urlsplit(link)
            where = page.relative_to(site).as_posix()
            if parts.scheme or parts.netloc:
                if loaded and parts.scheme != "data" and "canonical" not in link:
                    found.append(f"{where} loads {link}")
            elif parts.path and not (page.parent / unquote(parts.path)).exists():
                found.append(f"{where} links to {link}")
    return found


def on_post_build(config):
    """Refuse a site with a dead link; a gallery that was cut short has some of necessity."""
    wrong = faults(Path(config.site_dir))
    if os.environ.get("FEGEAR_GALLERY") is not None:
        wrong = [fault for fault in wrong if "gallery/" not in fault and "_files/" not in fault]
    if wrong:
        raise PluginError("links that lead nowhere:\n" + "\n".join(wrong))
