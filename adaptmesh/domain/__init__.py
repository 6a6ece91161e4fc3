"""What to mesh: sides, paths of curves, holes, regions, names, periodicity."""
