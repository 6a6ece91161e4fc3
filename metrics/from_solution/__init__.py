"""From fields on a mesh to a metric: recovery, Hessian, norm, goal."""
