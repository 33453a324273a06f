"""A figure, described once and as data: what is drawn over which axes, in the units in which it is read.

Renderers draw a description as PNG, as SVG and as the report's interactive plot; they take everything from it, so they
cannot disagree. Names, labels and titles are plain text, in which ``_{...}`` sets what it holds lower.
"""
