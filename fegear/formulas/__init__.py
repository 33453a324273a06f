"""Closed forms of the literature, one file per source: stiffness, contact and root stress of gear teeth."""
