"""The live workbench, ``fegear open``: a case as a form and as text, and its results next to it as they change.

It holds no mechanics and no drawing of its own: what is computed is the engine's, what is drawn are the figures of the
report from the same descriptions.
"""
