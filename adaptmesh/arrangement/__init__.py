"""Arrangements: segments divided so that they meet only at ends, and the faces between them."""
