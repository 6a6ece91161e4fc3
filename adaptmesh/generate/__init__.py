"""From a domain and a metric to a mesh."""
