"""What accuracy costs: configurations from quick to exact, with error (against a converged reference) and seconds."""
