"""Repair and mesh as many random dirty outlines as you like: python tests/dirty_outlines.py 1000"""

import sys
import time
from collections import Counter, defaultdict

from reference.dirty import check, dirty_outline


def main(n):
    """Print what came of each kind, and all that may not be."""
    counts, worst, start = defaultdict(Counter), 0.0, time.process_time()
    for seed in range(n):
        try:
            kind, outcome, error = check(seed)
        except Exception as failure:
            print(f"seed {seed}, {dirty_outline(seed)[0]}: {failure!r}"[:500])
            kind, outcome, error = dirty_outline(seed)[0], "FAILED", 0.0
        counts[kind][outcome] += 1
        worst = max(worst, error)
    for kind, outcomes in counts.items():
        print(f"{kind:16} {dict(outcomes)}")
    total = sum(counts.values(), Counter())
    print(
        f"{dict(total)}; area of the mesh off by {worst:.2g} at most; "
        f"{time.process_time() - start:.0f} s CPU"
    )


if __name__ == "__main__":
    main(int(sys.argv[1]))
