"""fegear: a finite-element workbench for gear teeth."""

__version__ = "0.2.0"
