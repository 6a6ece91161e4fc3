"""A mesh made again for another metric: from its domain, or by editing it."""
