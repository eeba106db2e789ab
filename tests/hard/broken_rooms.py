#!/usr/bin/env python3
"""Makes rooms whose geometry is broken, lets reemit read and solve them, and checks how it ends.

Usage: broken_rooms.py PROGRAM [--seed N] [--count N] [--only N] [--keep FOLDER] [--limit SECONDS] [--verbose]
       broken_rooms.py --self-test

Every kind of fault in KINDS comes in .obj, .json, .mgf and .gltf in turn: 60 rooms hold each of them in each format once. The
same seed and number give the same room; --only N repeats one.

What must hold of every run stands in judge_runs.py; beyond that a room is either solved, and the books of its solution
balance, or refused (exit code 2) with the place of what is wrong: line, JSON pointer, or the name of a surface or
material. Exit code 0: all of this held; 1: it did not; the files are kept aside, with a command that repeats it.
"""
import argparse
import base64
import itertools
import json
import math
import os
import pathlib
import random
import struct
import sys
import tempfile
import time

sys.dont_write_bytecode = True  # the module beside this file leaves nothing in the source tree
from judge_runs import Checker, print_summary, try_case

SIZE = (4.0, 3.0, 5.0)  # of the hull around most rooms [m]
REFLECTANCE = {"wall": 0.5, "front": 0.5, "lamp": 0.2}
RADIANCE = 10.0  # of lamps [W/(m2 sr)]


# ---------------------------------------------------------------- rooms

class Room:
    """Polygons by name and material, and round shapes; words say what is wrong with it."""

    def __init__(self, rng):
        self.rng, self.words, self.surfaces, self.round = rng, [], [], []

    def say(self, words):
        self.words.append(words)

    def add(self, name, material, polygons):
        self.surfaces.append((name, material, [list(p) for p in polygons]))

    def shell(self, lamp_height=2.9):
        """A closed hull and a lamp below its ceiling."""
        self.add("hull", "wall", box((0, 0, 0), SIZE, inward=True))
        if lamp_height is not None:
            y = lamp_height
            self.add("lamp", "lamp", [[(1.5, y, 2), (2.5, y, 2), (2.5, y, 3), (1.5, y, 3)]])

    def point(self, margin=0.2):
        return tuple(self.rng.uniform(margin, s - margin) for s in SIZE)

    def move_all(self, change):
        self.surfaces = [(n, m, [[change(v) for v in p] for p in faces]) for n, m, faces in self.surfaces]


def box(low, high, inward=False):
    corner = [(x, y, z) for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return [[corner[i] for i in (reversed(f) if inward else f)] for f in faces]


def crate(rng):
    low = [rng.uniform(0, s - 1.2) for s in SIZE]
    return box(low, [a + rng.uniform(0.2, 1) for a in low])


def plus(a, b, scale=1.0):
    return tuple(x + scale * y for x, y in zip(a, b))


def along(rng, length=1.0):
    """A vector of that length in a random direction."""
    v = [rng.gauss(0, 1) for _ in range(3)]
    norm = math.sqrt(sum(x * x for x in v)) or 1.0
    return tuple(length * x / norm for x in v)


def round_faces(shape, sides=16):
    """Polygons of a sphere (center, radius) or cylinder (base, top, radius)."""
    if shape[0] == "sphere":
        _, c, r = shape
        at = lambda i, j: plus(c, (math.sin(math.pi * i / 8) * math.cos(2 * math.pi * j / sides), math.cos(math.pi * i / 8),
                                   math.sin(math.pi * i / 8) * math.sin(2 * math.pi * j / sides)), r)
        return [[at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)] for i in range(8) for j in range(sides)]
    _, a, b, r = shape
    axis = plus(b, a, -1)
    other = (1, 0, 0) if abs(axis[0]) < max(abs(axis[1]), abs(axis[2])) else (0, 1, 0)
    u = cross(axis, other)
    v = cross(axis, u)
    u, v = ([x / math.sqrt(sum(y * y for y in w)) for x in w] for w in (u, v))
    ring = [plus(plus((0, 0, 0), u, r * math.cos(2 * math.pi * j / sides)), v, r * math.sin(2 * math.pi * j / sides))
            for j in range(sides)]
    low, high = [plus(a, d) for d in ring], [plus(b, d) for d in ring]
    mantle = [[low[j], high[j], high[(j + 1) % sides], low[(j + 1) % sides]] for j in range(sides)]
    return mantle + [low, high[::-1]]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


# ---------------------------------------------------------------- what is broken

def degenerate_faces(room):
    """Faces without area: corners that repeat, that lie on a line, or all in one place; now and then nothing else."""
    if room.rng.random() < 0.8:
        room.shell()
    faces = []
    for _ in range(room.rng.randrange(1, 60)):
        p, d = room.point(), along(room.rng)
        faces.append(room.rng.choice([
            [p, p, p], [p, plus(p, d), p], [p, plus(p, d), plus(p, d, 2)], [p, plus(p, d), plus(p, d, 0.5), plus(p, d, 0.2)],
            [p, plus(p, d), plus(p, d), p], [p, plus(p, d, 1e-12), plus(p, along(room.rng), 1e-12)]]))
    room.add("nothing", room.rng.choice(["wall", "front", "lamp"]), faces)


def triangle_soup(room):
    """Triangles at random, which pierce each other and the hull."""
    if room.rng.random() < 0.7:
        room.shell()
    size = room.rng.choice([0.2, 1.0, 6.0])
    count = room.rng.randrange(50, 400 if size < 2 else 120)
    for material in ("wall", "front", "lamp"):
        room.add(f"soup {material}", material, [[plus(p, along(room.rng), size * room.rng.random()) for _ in range(3)]
                                                for p in (room.point() for _ in range(count // 3))])


def self_intersecting_shells(room):
    """Boxes whose corners were exchanged, and stars drawn in one stroke."""
    room.shell()
    for i in range(room.rng.randrange(1, 8)):
        faces = crate(room.rng)
        corners = sorted({v for f in faces for v in f})
        new = dict(zip(corners, room.rng.sample(corners, len(corners))))
        room.add(f"twisted {i}", room.rng.choice(["wall", "front"]), [[new[v] for v in f] for f in faces])
    for i in range(room.rng.randrange(1, 5)):
        n, c, r = room.rng.choice([5, 7, 11, 201]), room.point(1), 0.8
        star = [(c[0] + r * math.cos(4 * math.pi * k / n), c[1], c[2] + r * math.sin(4 * math.pi * k / n)) for k in range(n)]
        room.add(f"star {i}", "wall", [star])


def coincident_faces(room):
    """Faces drawn twice and more, the same or the other way round, exactly or by a hair apart."""
    room.shell()
    for i in range(room.rng.randrange(1, 6)):
        faces = crate(room.rng)
        room.add(f"crate {i}", "wall", faces)
        for k in range(room.rng.randrange(1, 4)):
            hair = along(room.rng, room.rng.choice([0, 0, 1e-12, 1e-9, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3]))
            again = [[plus(v, hair) for v in (f if room.rng.random() < 0.5 else f[::-1])] for f in faces]
            room.add(f"crate {i} again {k}", room.rng.choice(["wall", "front", "lamp"]), again)


def overlaps_in_one_plane(room):
    """Rectangles on the floor, in the ceiling and within the hull that overlap; some are lamps."""
    room.shell(None)
    for y in (0.0, SIZE[1], room.rng.uniform(0.5, 2.5)):
        for i in range(room.rng.randrange(1, 40)):
            x, z, w, h = (room.rng.uniform(-0.5, 4) for _ in range(4))
            turn = room.rng.choice([0.0, 0.0, 0.1, math.pi / 4])
            f = [(x + a * w * math.cos(turn) - b * h * math.sin(turn), y, z + a * w * math.sin(turn) + b * h * math.cos(turn))
                 for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
            f = f if room.rng.random() < 0.5 else f[::-1]
            room.add(f"panel {y:.1f} {i}", room.rng.choice(["wall", "front", "lamp"]), [f])


def needles(room):
    """Triangles as long as the room and very thin, in a bundle and at random."""
    room.shell()
    for i in range(room.rng.randrange(1, 80)):
        p, q = room.point(0), room.point(0)
        thin = 10 ** room.rng.uniform(-13, -2)
        room.add(f"needle {i}", room.rng.choice(["wall", "wall", "front", "lamp"]), [[p, q, plus(q, along(room.rng), thin)]])


def far_and_large(room):
    """The whole room scaled and moved as far as rooms may go, and beyond."""
    room.shell()
    for i in range(3):
        room.add(f"crate {i}", "wall", crate(room.rng))
    scale, far = 10 ** room.rng.uniform(-7, 10), 10 ** room.rng.uniform(-3, 6)
    way = along(room.rng, scale * far)
    room.say(f"times {scale:.3g}, moved by {far:.3g} sizes")
    room.move_all(lambda v: tuple(scale * a + b for a, b in zip(v, way)))


def large_and_small(room):
    """Things from a millionth of a millimetre to a thousand kilometres in one room."""
    room.shell()
    size = 1e-9
    while size < 1e6:
        p = room.point(1)
        room.add(f"crate {size:g}", "wall", box(p, [a + size * room.rng.uniform(0.5, 1) for a in p]))
        size *= room.rng.choice([3, 10, 100])
    if room.rng.random() < 0.5:
        room.add("ground", "wall", [[(-1e6, 0, -1e6), (-1e6, 0, 1e6), (1e6, 0, 1e6), (1e6, 0, -1e6)]])


def no_numbers(room):
    """Coordinates that are no numbers, infinite or next to it."""
    room.shell()
    faces = crate(room.rng)
    bad = room.rng.choice([math.nan, math.inf, -math.inf, 1e308, -1e308, 1e39, 3e38, 1e-310])
    k = room.rng.randrange(3)
    f = room.rng.choice(faces)
    i = room.rng.randrange(4)
    f[i] = tuple(bad if j == k else a for j, a in enumerate(f[i]))
    room.say(f"{bad} in a corner")
    room.add("crate", "wall", faces)


def open_shells(room):
    """Boxes that lack faces and do not meet at their edges, with hairlines or gaps between them."""
    room.shell()
    hull = room.surfaces[0][2]
    del hull[room.rng.randrange(len(hull))]
    for i in range(room.rng.randrange(1, 12)):
        gap = room.rng.choice([0, 1e-8, 1e-6, 1e-4, 1e-2])
        faces = [[plus(v, along(room.rng), gap) for v in f] for f in crate(room.rng) if room.rng.random() < 0.7]
        room.add(f"open {i}", room.rng.choice(["wall", "front"]), faces or [hull[0]])


def faces_through_one_point(room):
    """Thousands of faces in a crumpled cone, or tens to hundreds that all pierce each other in one point. (Of n such faces
    there are n^2 cuts, and time grows with them: thousands are no fault, but take minutes.)"""
    room.shell()
    c, how = room.point(1), room.rng.randrange(3)
    if how == 0:
        n = room.rng.randrange(1000, 4000)
        rim = [plus(c, (0.8 * math.cos(2 * math.pi * i / n), room.rng.uniform(-0.1, 0.3), 0.8 * math.sin(2 * math.pi * i / n)))
               for i in range(n)]
        room.add("cone", "wall", [[c, rim[i - 1], rim[i]] for i in range(n)])
        room.add("blade", "wall", [[plus(c, (0, -0.5, 0)), plus(c, (0.9, 0, 0.2)), plus(c, (0, 0.5, 0))]])
    elif how == 1:
        n = room.rng.randrange(50, 250)
        rim = [plus(c, along(room.rng, room.rng.uniform(0.05, 0.9))) for _ in range(n)]
        room.add("fan", "wall", [[c, rim[i - 1], rim[i]] for i in range(n)])
    else:
        turns = [(along(room.rng, 0.8), along(room.rng, 0.8)) for _ in range(room.rng.randrange(10, 60))]
        room.add("knot", "front", [[plus(plus(c, u, a), v, b) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
                                   for u, v in turns])


def mixed_windings(room):
    """Boxes of many faces, some of which show their backs, inside a hull that does so as well."""
    room.shell()
    turn = lambda faces, odds: [f[::-1] if room.rng.random() < odds else f for f in faces]
    odds = room.rng.choice([0.1, 0.5, 1.0])
    room.surfaces = [(n, "front" if m == "wall" else m, turn(faces, odds)) for n, m, faces in room.surfaces]
    for i in range(room.rng.randrange(1, 10)):
        faces = [[f[0], f[k], f[k + 1]] for f in crate(room.rng) for k in (1, 2)]
        room.add(f"crate {i}", room.rng.choice(["front", "front", "wall", "lamp"]), turn(faces, odds))


def piercing_shapes(room):
    """Spheres and cylinders that pierce each other, the hull and the lamp."""
    room.shell()
    for i in range(room.rng.randrange(2, 12)):
        p, r = room.point(0), room.rng.choice([0.01, 0.3, 1.0]) * room.rng.uniform(0.5, 1)
        shape = ("sphere", p, r) if room.rng.random() < 0.5 else ("cylinder", p, plus(p, along(room.rng, 3 * r + 0.1)), r)
        room.round.append((f"round {i}", room.rng.choice(["wall", "wall", "front", "lamp"]), shape))


def bent_polygons(room):
    """Polygons of many corners that lie in no plane, cross themselves, or are folded flat."""
    room.shell()
    for i in range(room.rng.randrange(1, 10)):
        n, c, bend = room.rng.randrange(4, 200), room.point(1), room.rng.choice([1e-9, 1e-6, 1e-3, 0.3])
        turn = room.rng.choice([1, 1, 2, 3])
        f = [plus(c, (0.8 * room.rng.uniform(0.3, 1) * math.cos(2 * math.pi * turn * k / n), bend * room.rng.uniform(-1, 1),
                      0.8 * room.rng.uniform(0.3, 1) * math.sin(2 * math.pi * turn * k / n))) for k in range(n)]
        room.add(f"bent {i}", room.rng.choice(["wall", "lamp"]), [f, [f[0], f[1], f[2], f[1]]])


def shared_edges(room):
    """Books: many faces at one edge, and T-junctions where corners lie on edges of others, almost or exactly."""
    room.shell()
    for i in range(room.rng.randrange(1, 5)):
        a = room.point(1)
        b = plus(a, along(room.rng, 0.9))
        pages = [[a, b, plus(b, d), plus(a, d)] for d in (along(room.rng, 0.6) for _ in range(room.rng.randrange(3, 60)))]
        room.add(f"book {i}", room.rng.choice(["wall", "front"]), pages)
    strips, x = [], 0.5
    for k in range(room.rng.randrange(2, 40)):
        n, off = room.rng.randrange(1, 7), room.rng.choice([0, 1e-9, 1e-6, 1e-4])
        for j in range(n):
            strips.append([(x, 1 + off, 1 + j * 2 / n), (x, 1, 1 + (j + 1) * 2 / n), (x + 0.05, 1, 1 + (j + 1) * 2 / n),
                           (x + 0.05, 1, 1 + j * 2 / n)])
        x += 0.05
    room.add("strips", "wall", strips)


KINDS = [degenerate_faces, triangle_soup, self_intersecting_shells, coincident_faces, overlaps_in_one_plane, needles,
         far_and_large, large_and_small, no_numbers, open_shells, faces_through_one_point, mixed_windings, piercing_shapes,
         bent_polygons, shared_edges]


# ---------------------------------------------------------------- formats

def as_polygons(room):
    return room.surfaces + [(name, material, round_faces(shape)) for name, material, shape in room.round]


def number(x):
    """As the formats of text have it; NaN and infinity too, which they do not know."""
    return repr(float(x))


def write_obj(room):
    materials = "".join(f"newmtl {name}\nKd {rho} {rho} {rho}\nKe {e} {e} {e}\n" for name, rho in REFLECTANCE.items()
                        for e in [RADIANCE if name == "lamp" else 0])
    lines, count = ["mtllib room.mtl"], 0
    for name, material, faces in as_polygons(room):
        lines += [f"o {name.replace(' ', '_')}", f"usemtl {material}"]
        for f in faces:
            lines += ["v " + " ".join(map(number, v)) for v in f]
            lines.append("f " + " ".join(str(count + i + 1) for i in range(len(f))))
            count += len(f)
    return {"room.obj": "\n".join(lines).encode() + b"\n", "room.mtl": materials.encode()}


def write_json(room):
    materials = {name: {"reflectance": rho, **({"sides": "front"} if name != "wall" else {}),
                        **({"radiance": RADIANCE} if name == "lamp" else {})} for name, rho in REFLECTANCE.items()}
    objects = []
    for name, material, faces in room.surfaces:
        vertices = [v for f in faces for v in f]
        starts = itertools.accumulate((len(f) for f in faces), initial=0)
        objects.append({"name": name, "material": material,
                        "mesh": {"vertices": vertices, "faces": [list(range(s, s + len(f))) for s, f in zip(starts, faces)]}})
    for name, material, shape in room.round:
        form = {"sphere": {"center": shape[1], "radius": shape[2]}} if shape[0] == "sphere" else \
               {"cylinder": {"base": shape[1], "top": shape[2], "radius": shape[3]}}
        objects.append({"name": name, "material": material, **form})
    text = json.dumps({"format": "reemit-room", "version": 1, "materials": materials, "objects": objects}, indent=1)
    return {"room.json": text.encode()}


def write_mgf(room):
    lines = []
    for name, rho in REFLECTANCE.items():
        lines += [f"m {name} =", f"\tsides {2 if name == 'wall' else 1}", "\tc", f"\trd {rho}"]
        lines += [f"\ted {math.pi * RADIANCE}"] if name == "lamp" else []
    for name, material, faces in room.surfaces:
        lines += [f"o {name.replace(' ', '_')}", f"m {material}"]
        for f in faces:
            for i, v in enumerate(f):
                lines += [f"v v{i} =", "\tp " + " ".join(map(number, v))]
            lines.append("f " + " ".join(f"v{i}" for i in range(len(f))))
        lines.append("o")
    for name, material, shape in room.round:
        lines += [f"o {name.replace(' ', '_')}", f"m {material}"]
        for i, v in enumerate(p for p in shape[1:] if isinstance(p, tuple)):
            lines += [f"v v{i} =", "\tp " + " ".join(map(number, v))]
        if shape[0] == "sphere":
            lines.append(f"sph v0 {number(shape[2])}")
        else:
            lines.append(f"cyl v0 {number(shape[3])} v1")
        lines.append("o")
    return {"room.mgf": "\n".join(lines).encode() + b"\n"}


def write_gltf(room):
    order = list(REFLECTANCE)
    materials = [{"name": name, "doubleSided": name == "wall", "emissiveFactor": [float(name == "lamp")] * 3,
                  "pbrMetallicRoughness": {"baseColorFactor": [rho, rho, rho, 1], "metallicFactor": 0}}
                 for name, rho in REFLECTANCE.items()]
    views, accessors, meshes, nodes, binary = [], [], [], [], b""
    for name, material, faces in as_polygons(room):
        corners = [v for f in faces for i in range(1, len(f) - 1) for v in (f[0], f[i], f[i + 1])]
        data = b"".join(struct.pack("<3f", *map(single, v)) for v in corners)
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
        accessors.append({"bufferView": len(views) - 1, "componentType": 5126, "count": len(corners), "type": "VEC3"})
        meshes.append({"primitives": [{"attributes": {"POSITION": len(accessors) - 1}, "material": order.index(material)}]})
        nodes.append({"name": name, "mesh": len(meshes) - 1})
        binary += data
    uri = "data:application/octet-stream;base64," + base64.b64encode(binary).decode()
    document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes,
                "meshes": meshes, "materials": materials, "accessors": accessors, "bufferViews": views,
                "buffers": [{"uri": uri, "byteLength": len(binary)}]}
    return {"room.gltf": json.dumps(document).encode()}


def single(x):
    """What single precision makes of x; too large becomes infinite."""
    try:
        return struct.unpack("<f", struct.pack("<f", x))[0]
    except OverflowError:
        return math.copysign(math.inf, x)


FORMATS = [write_obj, write_json, write_mgf, write_gltf]


class Case:
    """Room `number` of a seed as files; the first is given to the program."""

    def __init__(self, number, seed):
        self.number, room = number, Room(random.Random(f"{seed} {number}"))
        make = KINDS[number % len(KINDS)]
        make(room)
        self.parts = FORMATS[number % len(FORMATS)](room)
        self.main = next(iter(self.parts))
        self.words = [make.__name__.replace("_", " "), *room.words]

    def names(self):
        return list(self.parts)

    def write(self, folder):
        for name, data in self.parts.items():
            (folder / name).write_bytes(data)


# ---------------------------------------------------------------- running

def try_room(checker, case, folder, place):
    """Complaints about one room. Every fourth is looked at by info too, which does less than solve."""
    refusals = sum(checker.placeless.values())
    commands = [(["solve", case.main, "-o", "out.h5", "--json", "--packets", "20000", "--zones", "500"], "out.h5", (0, 2))]
    if case.number % 4 == 0:
        commands.append((["info", case.main, "--json"], None, (0, 2)))
    complaints = try_case(checker, case, commands, folder, place, judge_books)
    if sum(checker.placeless.values()) > refusals:
        complaints += ["refusal", "refused without a place"]
    return complaints


def judge_books(arguments, printed):
    if arguments[0] != "solve":
        return []
    try:
        balanced = json.loads(printed)["balanced"]
    except (ValueError, KeyError, TypeError):
        balanced = None
    return [] if balanced is True else [f"balanced: {balanced}"]


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--seed", type=int, default=1, help="of the random numbers (1)")
    parser.add_argument("--count", type=int, default=200, help="rooms (200)")
    parser.add_argument("--only", type=int, help="only the room with this number")
    parser.add_argument("--keep", type=pathlib.Path, help="where files that offend are put (a new temporary folder)")
    parser.add_argument("--limit", type=float, default=10, help="seconds that a run may take (10)")
    parser.add_argument("--verbose", action="store_true", help="a line for every room")
    options = parser.parse_args(arguments)
    checker = Checker(options.program.resolve(), options.limit)
    keep = options.keep or pathlib.Path(tempfile.gettempdir()) / f"broken_rooms_{os.getpid()}"
    offending = []
    numbers = range(options.count) if options.only is None else [options.only]
    with tempfile.TemporaryDirectory(prefix="broken_rooms_") as scratch:
        for number in numbers:
            case = Case(number, options.seed)
            started, before = time.monotonic(), dict(checker.codes)
            complaints = try_room(checker, case, pathlib.Path(scratch), keep / f"{number:05d}_{case.main}")
            if options.verbose:
                ends = [f"{' '.join(map(str, end))}" for end, n in checker.codes.items() if n != before.get(end)]
                print(f"{number} {case.main}: {'; '.join(case.words)} [{', '.join(ends)}, {time.monotonic() - started:.1f} s]",
                      flush=True)
            if complaints:
                offending.append((number, case.main, complaints))
                print(f"room {number}, {case.main}, {'; '.join(case.words)}:\n  " + "\n  ".join(complaints), flush=True)
    print(f"seed {options.seed}: {len(numbers)} rooms")
    return print_summary(checker, offending, len(numbers), keep)


# ---------------------------------------------------------------- self-test

SOLVES = """printf 'half %s' 'reemit seal 0123456789abcdef
' > out.h5; echo """
FAULTY = {  # What a program does when it is asked to solve, and a word of the complaint.
    "kill -SEGV $$": "signal 11",
    "exit 3": "exit code 3",
    "echo 'reemit: error: room.json is bad' >&2; exit 2": "without a place",
    SOLVES + "'{\"balanced\": false}'": "balanced: False",
    SOLVES + "nonsense": "balanced: None",
}
SOUND = ["echo 'reemit: error: room.json:7: bad' >&2; exit 2", SOLVES + "'{\"balanced\": true}'"]


def self_test():
    """Programs with one fault each are found out, sound ones are not, and rooms are the same every time."""
    failures = []
    for number in range(60):
        if Case(number, 1).parts != Case(number, 1).parts:
            failures.append(f"room {number} differs from itself")
    if len({(n % len(KINDS), n % len(FORMATS)) for n in range(60)}) != 60:
        failures.append("60 rooms do not hold every kind in every format")
    with tempfile.TemporaryDirectory(prefix="broken_rooms_") as scratch:
        folder = pathlib.Path(scratch)
        program = folder / "program"
        for solve, word in [*FAULTY.items(), *((s, None) for s in SOUND)]:
            program.write_text(f"#!/bin/sh\n{solve}\n")
            program.chmod(0o755)
            complaints = try_room(Checker(program, 5), Case(1, 1), folder, folder / "kept")
            if (word is None) != (not complaints) or (word and word not in "\n".join(complaints)):
                failures.append(f"{solve!r}: {complaints}")
    for failure in failures:
        print(failure)
    print(f"{len(FAULTY)} faulty programs, {len(failures)} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(self_test() if sys.argv[1:] == ["--self-test"] else main(sys.argv[1:]))
