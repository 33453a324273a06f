"""Drafts of case files: commented, ready to run, and to be changed by their reader."""
