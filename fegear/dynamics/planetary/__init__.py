"""Planetary sets: assembly, speeds, phases of the meshes, load sharing of the planets, vibration."""
