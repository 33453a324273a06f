"""Scenes: what a case file asks for, the plan of stages that answers it, and their running."""
