"""Mesh as many random domains with nearly coincident sides as you like, and check each exactly.

python tests/near_coincident_sides.py 20000 [first seed]
"""

import sys
import time
from collections import Counter, defaultdict

from reference.near_coincident import check, random_domain


def main(n, first=0):
    """Print what came of each kind, and all that may not be."""
    counts, start, slowest = defaultdict(Counter), time.process_time(), (0.0, 0)
    for seed in range(first, first + n):
        began = time.process_time()
        try:
            kind, outcome = check(seed)
        except Exception as failure:
            kind, outcome = random_domain(seed)[0], f"FAILED: {failure!r}"
        if outcome.startswith("FAILED"):
            print(f"seed {seed}, {kind}: {outcome}"[:400], flush=True)
            outcome = "FAILED"
        counts[kind][outcome] += 1
        slowest = max(slowest, (time.process_time() - began, seed))
    for kind, outcomes in counts.items():
        print(f"{kind:14} {dict(outcomes)}")
    total = sum(counts.values(), Counter())
    print(f"{dict(total)}; slowest: seed {slowest[1]}, {slowest[0]:.2g} s; "
          f"{time.process_time() - start:.0f} s CPU")  # fmt: skip


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
