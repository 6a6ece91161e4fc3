"""The boundary of a domain cut into unit edges."""
