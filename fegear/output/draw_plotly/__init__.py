"""Figures as plotly JSON: plain dicts of data and layout, made without plotly's Python, which takes long to import.

Arrays travel as plotly.js's own typed arrays (base64). Colours are those of light ground; `darker` says which shade
stands for each on dark ground, so that a page changes between them by replacing one by the other.
"""

from fegear.engine.figure.figure import NOTEBOOK
from fegear.output.draw_plotly.layout import darker, plotly_json, template
from fegear.output.draw_plotly.notebook import notebook_bundle, page_html

__all__ = ["darker", "notebook_bundle", "page_html", "plotly_json", "template"]

NOTEBOOK[:] = [notebook_bundle]
