"""How well a mesh fits its metric, and why not better."""
