"""Dirty input made into a clean domain, with a record of what was done."""
