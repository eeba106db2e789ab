#!/usr/bin/env python3
"""Shoots very many rays in closed rooms and counts what got out or came to the back of a face: nothing must.

Usage: leak_runs.py PROGRAM [--rays 1e9] [--keep FOLDER] [ROOM...]

Without ROOM: an L-shaped room, a tessellated sphere seen from inside, a room full of tables and chairs, and the
gallery, made here or taken from scenes/library; each is solved with the packets that make so many rays. Prints a line of
a table for each room. Exit code 0: nothing escaped, nothing came to a back, and all books balance; 1 otherwise.
"""
import argparse
import json
import math
import pathlib
import subprocess
import sys
import tempfile

LIBRARY = pathlib.Path(__file__).resolve().parent.parent / "scenes" / "library"
MATERIALS = {"wall": {"reflectance": 0.6, "sides": "front"}, "wood": {"reflectance": 0.4},
             "lamp": {"reflectance": 0.5, "radiance": 10, "sides": "front"}}


def room(objects, groups=None):
    text = {"format": "reemit-room", "version": 1, "materials": MATERIALS, "objects": objects}
    if groups:
        text["groups"] = groups
    return text


def l_shaped_room():
    """Two arms of 3 m, 1 m wide, 1 m high; the lamp hangs at one end, round the corner from the other."""
    outline = [(0, 0), (3, 0), (3, 1), (1, 1), (1, 3), (0, 3)]
    faces = [{"name": "floor", "material": "wall", "polygon": {"vertices": [[x, 0, z] for x, z in reversed(outline)]}},
             {"name": "ceiling", "material": "wall", "polygon": {"vertices": [[x, 1, z] for x, z in outline]}}]
    for i, (x, z) in enumerate(outline):
        x1, z1 = outline[(i + 1) % len(outline)]
        faces.append({"name": f"wall {i}", "material": "wall",
                      "polygon": {"vertices": [[x, 0, z], [x1, 0, z1], [x1, 1, z1], [x, 1, z]]}})
    faces.append({"name": "lamp", "material": "lamp", "box": {"min": [2.4, 0.8, 0.3], "max": [2.8, 0.9, 0.7]}})
    return room(faces)


def sphere_obj(folder):
    """A sphere of 64 x 32 faces, wound so that its front is inside, with a lit patch at its top, off the grid of floats."""
    meridians, parallels = 64, 32
    lines = ["mtllib sphere.mtl", "usemtl wall"]
    for i in range(1, parallels):
        polar = math.pi * i / parallels
        for j in range(meridians):
            azimuth = 2 * math.pi * j / meridians
            lines.append("v " + " ".join(f"{c:.9g}" for c in (
                3.3 + math.sin(polar) * math.cos(azimuth), math.cos(polar) - 7.7, 0.1 + math.sin(polar) * math.sin(azimuth))))
    lines += [f"v 3.3 {1 - 7.7:.9g} 0.1", f"v 3.3 {-1 - 7.7:.9g} 0.1"]
    top, bottom = (parallels - 1) * meridians + 1, (parallels - 1) * meridians + 2
    at = lambda i, j: (i - 1) * meridians + j % meridians + 1
    lines.append("usemtl lamp")
    lines += [f"f {top} {at(1, j)} {at(1, j + 1)}" for j in range(meridians)]
    lines.append("usemtl wall")
    for i in range(1, parallels - 1):
        lines += [f"f {at(i, j)} {at(i + 1, j)} {at(i + 1, j + 1)} {at(i, j + 1)}" for j in range(meridians)]
    lines += [f"f {bottom} {at(parallels - 1, j + 1)} {at(parallels - 1, j)}" for j in range(meridians)]
    (folder / "sphere.mtl").write_text("newmtl wall\nKd 0.6 0.6 0.6\nnewmtl lamp\nKd 0.3 0.3 0.3\nKe 5 5 5\n")
    file = folder / "sphere.obj"
    file.write_text("\n".join(lines) + "\n")
    return file


def furnished_room():
    """Twelve tables with four chairs each, legs that stand on the floor and go into the tops, turned off the axes."""
    def box(name, low, high):
        return {"name": name, "material": "wood", "box": {"min": low, "max": high}}
    def turned(degrees, place):
        return [{"rotate": {"axis": [0, 1, 0], "angle_deg": degrees}}, {"translate": place}]
    legs = [(0.02, 0.02), (0.92, 0.02), (0.02, 0.72), (0.92, 0.72)]
    table = [box("top", [0, 0.70, 0], [1.0, 0.74, 0.8])]
    table += [box(f"leg {i}", [x, 0, z], [x + 0.06, 0.72, z + 0.06]) for i, (x, z) in enumerate(legs)]
    chair = [box("seat", [0, 0.42, 0], [0.4, 0.45, 0.4]), box("rest", [0, 0.45, 0.37], [0.4, 0.9, 0.4])]
    chair += [{"name": f"foot {i}", "material": "wood",
               "cylinder": {"base": [x, 0, z], "top": [x, 0.43, z], "radius": 0.015}}
              for i, (x, z) in enumerate([(0.03, 0.03), (0.37, 0.03), (0.03, 0.37), (0.37, 0.37)])]
    objects = [{"name": "hull", "material": "wall", "box": {"min": [0, 0, 0], "max": [12, 3, 10], "inward": True}}]
    for i in range(12):
        x, z = 2 + 2.4 * (i % 4), 2 + 2.6 * (i // 4)
        turn = 7 * i
        objects.append({"name": f"table {i}", "group": "table", "transform": turned(turn, [x, 0, z])})
        for k, (dx, dz) in enumerate([(0.1, 0.85), (0.7, 0.85), (0.1, -0.5), (0.7, -0.5)]):
            c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))
            objects.append({"name": f"chair {i}.{k}", "group": "chair",
                            "transform": turned(turn, [x + c * dx + s * dz, 0, z - s * dx + c * dz])})
        objects.append({"name": f"lamp {i}", "material": "lamp", "sphere": {"center": [x + 0.5, 2.6, z + 0.4], "radius": 0.1}})
    return room(objects, {"table": table, "chair": chair})


def run(program, arguments):
    done = subprocess.run([program, *arguments], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"leak_runs.py: {' '.join([program, *arguments])} ended with {done.returncode}\n{done.stderr}")
    return json.loads(done.stdout)


def look_at(program, file, rays, solution):
    """A line of the table, and whether all of it is as it must be."""
    def solve(packets):
        return run(program, ["solve", str(file), "-o", str(solution), "--packets", str(int(packets)), "--json", "-q"])
    trial = 200_000
    first = solve(trial)
    done = solve(max(trial, 1.01 * rays * first["packets"] / first["rays"]))
    audit = run(program, ["audit", str(solution), "--json"])
    escaped = sum(band["escaped_W"] for band in audit["bands"])
    on_backs = sum(band["absorbed_on_backs_W"] for band in audit["bands"])
    gap = sum(abs(band["balance_quanta"]) for band in audit["bands"])
    print(f"| {file.stem} | {done['zones']:,} | {done['rays']:,} | {audit['events']['second_looks']:,} | {escaped:g} | {on_backs:g} | "
          f"{gap} |", flush=True)
    return escaped == 0 and on_backs == 0 and gap == 0 and done["rays"] >= rays


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("rooms", nargs="*", type=pathlib.Path)
    parser.add_argument("--rays", type=float, default=1e9)
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the rooms made here")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = options.keep or pathlib.Path(name)
        folder.mkdir(parents=True, exist_ok=True)
        rooms = options.rooms
        if not rooms:
            made = {"l_shaped_room": l_shaped_room(), "furnished_room": furnished_room()}
            for stem, text in made.items():
                (folder / f"{stem}.json").write_text(json.dumps(text))
            rooms = [folder / "l_shaped_room.json", sphere_obj(folder), folder / "furnished_room.json", LIBRARY / "gallery.json"]
        print("| room | zones | rays | traced twice | escaped [W] | on backs [W] | imbalance [quanta] |")
        print("|---|---|---|---|---|---|---|")
        good = [look_at(options.program, file, options.rays, pathlib.Path(name) / "leaks.h5") for file in rooms]
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main())
