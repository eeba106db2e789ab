#!/usr/bin/env python3
"""Has reemit solve sound rooms in every way with very little light, and make stills and exports of them.

Usage: every_way.py PROGRAM ROOM... [--solve-only ROOM...]

Values are the business of other tests, which need far more light. This one is for builds with sanitizers, where that
would take long: with few packets every part of the code is reached all the same. All runs must succeed.
"""
import argparse
import json
import pathlib
import sys
import tempfile

from judge_runs import Checker, seal_of

LIMIT = 120  # [s] of one run
LITTLE = ["--packets", "3000", "--zones", "300"]
SHORT = ["--time", "3s"]  # photons behind mirrors and glass would take the most of it
SMALL = ["--size", "24x18", "--spp", "2"]


def commands(room, solve_only):
    """Arguments and output of each run."""
    limits = SHORT if solve_only else []
    for method in ("shooting", "walk"):
        yield ["solve", room, "-o", f"{method}.h5", "--method", method, "--json", *LITTLE, *limits], f"{method}.h5"
    yield ["solve", "--resume", "shooting.h5", "--packets", "6000", "--json", *limits], "shooting.h5"
    yield ["audit", "walk.h5", "--json"], None
    if solve_only:
        return
    yield ["render", "shooting.h5", "-o", "gathered.exr", *SMALL], "gathered.exr"
    yield ["render", room, "--integrator", "path", "-o", "paths.exr", *SMALL], "paths.exr"
    yield ["render", "walk.h5", "--integrator", "zones", "-o", "zones.png", *SMALL], "zones.png"
    yield ["export", "walk.h5", "-o", "vertices.ply", "--samples", "16", "--light-samples", "16"], "vertices.ply"


def try_room(checker, room, solve_only, folder):
    """What went wrong in one room."""
    complaints = []
    for arguments, output in commands(str(room), solve_only):
        if output and not (folder / output).exists():
            old = b"what was here before"
            (folder / output).write_bytes(old + seal_of(old) if output.endswith(".h5") else old)
        _, printed, found = checker.run(arguments, folder, [room.name], output, allowed=(0,))
        if arguments[0] == "solve" and not found and json.loads(printed)["balanced"] is not True:
            found = ["the books are not balanced"]
        if found:
            complaints += [" ".join(arguments), *found]
    return complaints


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("rooms", type=pathlib.Path, nargs="+", metavar="ROOM")
    parser.add_argument("--solve-only", type=pathlib.Path, nargs="+", default=[], metavar="ROOM")
    options = parser.parse_args()
    checker = Checker(options.program.resolve(), LIMIT)
    failed = False
    for room in options.rooms + options.solve_only:
        with tempfile.TemporaryDirectory(prefix="every_way_") as folder:
            complaints = try_room(checker, room.resolve(), room in options.solve_only, pathlib.Path(folder))
        if complaints:
            print(f"{room.name}:\n  " + "\n  ".join(complaints), flush=True)
            failed = True
    print(f"slowest: {checker.slowest[0]:.1f} s, {checker.slowest[1]}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
