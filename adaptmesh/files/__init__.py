"""Reading and writing files safely: whole or not at all, bounded, errors with their place."""
