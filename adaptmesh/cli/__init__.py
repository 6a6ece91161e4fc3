"""The command `adaptmesh`."""
