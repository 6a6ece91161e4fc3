"""Two hundred iterations in one process: nothing is lost, nothing grows."""

from pathlib import Path

import numpy as np
import pytest

import adaptmesh as am

STATUS = Path("/proc/self/statm")
ITERATIONS = 200


def resident():
    """Megabytes of memory of this process."""
    return int(STATUS.read_text().split()[1]) * 4096 / 1e6


@pytest.mark.slow
@pytest.mark.skipif(not STATUS.exists(), reason="memory is read as Linux tells it")
def test_two_hundred_iterations_keep_names_areas_and_memory(plate, tmp_path):
    start = am.generate(plate, 0.3)
    memory = []

    def turning(mesh, previous):
        """A front that turns all the way round, so that no mesh is like the one before."""
        memory.append(resident())
        angle = 2 * np.pi * (len(memory) - 1) / ITERATIONS
        front = np.tanh(8 * ((mesh.points - [2, 1]) @ [np.cos(angle), np.sin(angle)]))
        return front if previous is None else front + 1e-3 * previous

    history = am.adapt_loop(
        turning,
        start,
        target_vertices=400,
        tolerance=0,
        max_iterations=ITERATIONS,
        save=tmp_path / "run",
        keep_last=1,
    )
    assert len(history) == ITERATIONS + 1
    assert max(memory[150:]) - max(memory[20:70]) < 10

    settled = history[10:]
    assert np.ptp([it.n_points for it in settled]) < 0.15 * 400
    assert min(it.unit_fraction for it in settled) > 0.93
    for iteration in history[::40]:
        mesh = iteration.mesh
        assert am.validate(mesh)
        assert (mesh.names, mesh.region_names) == (start.names, start.region_names)
        for region in start.region_names:
            was, now = (m.areas[m.triangles_in(region)].sum() for m in (start, mesh))
            assert now == pytest.approx(was, rel=1e-13)
        for name in start.names:
            was, now = (
                np.linalg.norm(np.diff(m.points[m.edges_named(name)], axis=1), axis=2).sum()
                for m in (start, mesh)
            )
            assert now == pytest.approx(was, rel=1e-13)
    # The front of half a turn later is the same line: no drift, in numbers of vertices or in error.
    # Errors of single meshes scatter by 15 %, so that means of 80 differ by 2.5 % by chance.
    half = ITERATIONS // 2
    first, second = history[20:half], history[20 + half : ITERATIONS]
    for number, by_chance in (
        (lambda it: it.n_points, 0.03),
        (lambda it: it.errors["solution"], 0.1),
    ):
        early, late = np.mean([number(it) for it in first]), np.mean([number(it) for it in second])
        assert late == pytest.approx(early, rel=by_chance)
