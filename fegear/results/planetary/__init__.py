"""Results of planetary sets: speeds and phases, load sharing of the planets, modes, vibration."""
