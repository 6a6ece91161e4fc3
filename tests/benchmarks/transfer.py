"""How long a transfer takes, and how well it conserves: python tests/benchmarks/transfer.py [size]

Two meshes of the unit square, graded along x and along y, with about 1e5 triangles each unless
another size is given. CPU seconds, the best of three.
"""

import sys
import time

import numpy as np

import adaptmesh as am
from adaptmesh.transfer.spaces import Space


def integral(mesh, values, space):
    on_triangles = values[Space(mesh, space).nodes_of_triangles]
    return float(mesh.areas @ on_triangles[:, 3 if space == "P2" else 0 :].mean(axis=1))


def main(size):
    square = am.Domain.rectangle(0, 0, 1, 1)
    old = am.generate(square, lambda x: size * (0.3 + np.abs(x[:, 0] - 0.5)))
    new = am.generate(square, lambda x: size * (0.3 + np.abs(x[:, 1] - 0.5)))
    print(f"{len(old.triangles)} -> {len(new.triangles)} triangles")
    for space in ("P0", "P1", "P2"):
        values = np.random.default_rng(0).random(Space(old, space).size)
        for label, options in {
            "interpolation": {},
            "conservative": {"method": "conservative"},
            "with bounds": {"method": "conservative", "keep_bounds": True},
        }.items():
            times = []
            for _ in range(3):
                # Fresh objects: a mesh remembers its edges.
                meshes = [am.Mesh(m.points, m.triangles) for m in (old, new)]
                start = time.process_time()
                moved = am.transfer(values, *meshes, space=space, **options)
                times.append(time.process_time() - start)
            change = integral(new, moved, space) / integral(old, values, space) - 1
            print(f"{space} {label:14s} {min(times):6.3f} s   integral changed by {change:9.1e}")


if __name__ == "__main__":
    main(float(sys.argv[1]) if len(sys.argv) > 1 else 0.0098)
