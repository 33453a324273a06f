"""A rack with its width: equal sectors of its sheared section side by side, with two ends."""
