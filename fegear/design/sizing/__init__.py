"""From a requirement to a design: variants of a pair, what each breaks, which none is better than."""
