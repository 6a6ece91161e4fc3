"""Whether a change of the code has left every mesh the same, to the bit.

::

    python tests/same_bits.py > before.json            # a hash of each mesh, by name
    python tests/same_bits.py --compare before.json    # after the change: names what differs
    python tests/same_bits.py curves                   # only those with these words in their names

Only the public API is called, so that the script judges two states of the project whose files have
other places. Both have to be on the same machine: other versions of NumPy or of the mathematical
library round differently.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import platform
import sys
from pathlib import Path

import numpy as np
from reference.results import MAKERS

import adaptmesh as am

PARTS = ("points", "triangles", "regions", "edges", "edge_tags")


def digest(result):
    """The SHA-256 of a mesh, an array, or a list or dict of these: types, shapes and bytes."""
    sha = hashlib.sha256()
    for array in arrays_of(result):
        array = np.ascontiguousarray(array)
        if array.dtype.hasobject:
            raise TypeError(f"{type(result).__name__} has no bits to compare")
        sha.update(f"{array.dtype.str} {array.shape};".encode())
        sha.update(array.tobytes())
    return sha.hexdigest()


def arrays_of(result):
    if isinstance(result, am.Mesh):
        yield from (getattr(result, part) for part in PARTS)
        if result.kept is not None:
            yield result.kept
    elif isinstance(result, am.Domain):
        yield from (result.points, result.segments)
    elif isinstance(result, dict):
        for name in sorted(result):
            yield np.frombuffer(name.encode(), np.uint8)
            yield from arrays_of(result[name])
    elif isinstance(result, list | tuple):
        for item in result:
            yield from arrays_of(item)
    else:
        yield np.asarray(result)


def summary(result):
    """How large it is, to tell in a comparison how much it has changed."""
    results = result if isinstance(result, list) else [result]
    return [[len(r.points), len(r.triangles)] for r in results if isinstance(r, am.Mesh)]


def hashes(words=()):
    """The hash and size of each result whose name has one of these words; all without words."""
    results = {}
    for name, make in MAKERS.items():
        if words and not any(word in name for word in words):
            continue
        print(name, file=sys.stderr, flush=True)
        try:
            result = make()
            results[name] = {"sha256": digest(result), "size": summary(result)}
        except Exception as error:  # a failure, too, is to be the same
            results[name] = {"failed": f"{type(error).__name__}: {error}"}
    return results


def differences(before, after):
    """A line for each name whose result is not the same, or is in one of the two only."""
    for name in sorted({*before, *after}):
        old, new = before.get(name), after.get(name)
        if old is None or new is None:
            yield f"{name}: only {'after' if old is None else 'before'}"
        elif old != new:
            told = [str(r.get("failed") or r["size"]) for r in (old, new)]
            yield f"{name}: {told[0]} before, {told[1]} after"


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("words", nargs="*", help="only results with these words in their names")
    parser.add_argument("--compare", metavar="FILE", help="the output of an earlier call")
    arguments = parser.parse_args()
    results = hashes(arguments.words)
    failed = [name for name, result in results.items() if "failed" in result]
    machine = {"python": platform.python_version(), "numpy": np.__version__}
    if arguments.compare is None:
        json.dump({"machine": machine, "results": results}, sys.stdout, indent=1)
        print()
        return f"failed: {', '.join(failed)}" if failed else 0
    stored = json.loads(Path(arguments.compare).read_text("utf-8"))
    if stored["machine"] != machine:
        print(f"note: {stored['machine']} before, {machine} after: rounding may differ")
    before = stored["results"]
    if arguments.words:
        before = {name: before[name] for name in before if name in results}
    told = list(differences(before, results))
    for line in told:
        print(line)
    print(f"{len(results)} results, {len(told)} not the same as before")
    return 1 if told else 0


if __name__ == "__main__":
    sys.exit(main())
