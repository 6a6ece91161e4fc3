"""Lines of a domain from corner to corner, straight or curved, and polygons inscribed in them."""
