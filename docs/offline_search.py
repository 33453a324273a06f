"""Hook of mkdocs: the search works from a folder too, where a browser lets a page start no worker and read no JSON."""

from __future__ import annotations

from pathlib import Path

from mkdocs.exceptions import PluginError

#: Where the theme's script starts its worker.
_START = "if (!window.Worker) {"
_FROM_A_FOLDER = """\
if (location.protocol === "file:") {
  window.Worker = undefined;
  var scripts = document.getElementById("mkdocs-search-results") ? ["lunr.js", "search_index.js", "worker.js"] : [];
  var loadNext = function () {
    var script = document.createElement("script");
    script.src = joinUrl(base_url, "search/" + scripts.shift());
    script.onload = scripts.length ? loadNext : function () {
      window.postMessage = function (message) { onWorkerMessage({data: message}); };
      data = searchData;
      onScriptsLoaded();
    };
    document.head.appendChild(script);
  };
  if (scripts.length) loadNext();
} else """


def on_post_build(config):
    """Give the index as a script, and let pages that were opened from a folder load it as one."""
    folder = Path(config.site_dir) / "search"
    index = (folder / "search_index.json").read_text("utf-8")
    (folder / "search_index.js").write_text(f"var searchData = {index};\n", "utf-8")
    script = (folder / "main.js").read_text("utf-8")
    before, start, after = script.rpartition(_START)
    if not start:
        raise PluginError("the search's script starts its worker in another way than docs/offline_search.py knows")
    (folder / "main.js").write_text(before + _FROM_A_FOLDER + start + after, "utf-8")
