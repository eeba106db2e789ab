#!/usr/bin/env python3
"""Stills and vertex values of the same rooms by reemit and by Blender's Cycles: time at equal error.

Usage: compare_with_cycles.py PROGRAM [--room NAME ...] [--threads N] [--quick] [--keep FOLDER]

PROGRAM is build/release/reemit. Needs Blender with Cycles (Debian: blender) and, for Python, numpy, h5py and
OpenImageIO (python3-numpy, python3-h5py, python3-openimageio); says so and ends with exit code 77 where they are
missing. Prints two tables in Markdown.

Both programs get the same triangles, materials and camera; Cycles traces all bounces, unclamped. Reference of both: the
mean of two long runs of Cycles, with seeds of their own, which shares nothing with reemit; how far the two differ says
how noisy it is, and that part is taken out of all errors in squares. Error of a still: rms over pixels of dL / (L + 1 % of
the mean), worst band. Error of vertices: sqrt(sum A dE^2 / sum A E^2), A the area around a vertex, worst band. Time of reemit: wall
time of the commands `solve` and `render` or `export`, from start to exit. Time of Cycles: of the call that renders or
bakes alone.
"""
import argparse
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
LIBRARY = HERE.parent.parent / "scenes" / "library"
EXIT_SKIPPED = 77
FLOOR = 0.01

try:
    import h5py
    import numpy
    import OpenImageIO
except ImportError as error:
    print(f"compare_with_cycles.py: skipped, {error}", file=sys.stderr)
    sys.exit(EXIT_SKIPPED)

# Packets of the solve and what `render --error` asks for; the same for `export`.
STILL_EFFORTS = ((2**19, "12%"), (2**20, "6%"), (2**21, "3%"), (2**22, "2%"))
VERTEX_EFFORTS = ((2**18, ("--samples", "64", "--light-samples", "16")),
                  (2**19, ("--samples", "128", "--light-samples", "32")),
                  (2**20, ("--samples", "256", "--light-samples", "64")),
                  (2**21, ("--samples", "512", "--light-samples", "128")))
# Samples of Cycles per pixel or vertex; of each of the two references.
STILL_SAMPLES = (16, 64, 256)
STILL_REFERENCE = 1024
VERTEX_SAMPLES = (64, 256)
VERTEX_REFERENCE = 512
SIZE = 256  # [px], width and height of stills
ERRORS = (0.05, 0.03, 0.02, 0.01)
# Largest zone of the mesh whose vertices are wanted [m2].
ROOMS = {"cornell_box": 3.1e-5, "office": 0.02}


def run(command):
    """Wall time of a command [s]."""
    start = time.monotonic()
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(str(c) for c in command)}\nfailed with exit code {done.returncode}:\n{done.stdout}{done.stderr}")
    return time.monotonic() - start


class Reemit:
    def __init__(self, program, room, folder, threads):
        self.program, self.room, self.folder, self.threads = program, room, folder, threads

    def solve(self, packets, *options):
        """Solution file and seconds."""
        file = self.folder / f"{packets}.h5"
        return file, run([self.program, "solve", self.room, "--packets", packets, "--threads", self.threads, "-q",
                          *options, "-o", file])

    def camera(self):
        text = subprocess.run([self.program, "info", self.room, "--json"], capture_output=True, text=True, check=True)
        return json.loads(text.stdout)["cameras"][0]

    def still(self, solution, *options):
        file = self.folder / "still.exr"
        seconds = run([self.program, "render", solution, "--size", f"{SIZE}x{SIZE}", "--threads", self.threads, "-q",
                       *options, "-o", file])
        return read_picture(file), seconds

    def vertices(self, solution, *options):
        file = self.folder / "vertices.ply"
        seconds = run([self.program, "export", solution, "--threads", self.threads, "-q", *options, "-o", file])
        return read_ply(file), seconds


class Cycles:
    def __init__(self, folder, threads):
        self.folder, self.threads = folder, threads

    def write_room(self, **arrays):
        numpy.savez(self.folder / "room.npz", **arrays)

    def do(self, jobs):
        """Seconds of each job, by name."""
        (self.folder / "jobs.json").write_text(json.dumps({"threads": self.threads, "jobs": jobs}))
        (self.folder / "jobs_done.json").unlink(missing_ok=True)
        run(["blender", "--background", "--factory-startup", "--python-exit-code", "1", "--python-expr",
             "import numpy; numpy.bool = bool; numpy.object = object; numpy.int = int",
             "--python", HERE / "cycles_room.py", "--", self.folder])
        return json.loads((self.folder / "jobs_done.json").read_text())


def read_picture(file):
    """Radiance [height][width][3]."""
    image = OpenImageIO.ImageBuf(str(file))
    names = list(image.spec().channelnames)
    pixels = image.get_pixels(OpenImageIO.FLOAT)
    return numpy.stack([pixels[:, :, names.index(c)] for c in "RGB"], axis=2).astype(float)


def read_ply(file):
    """Vertices as a structured array and triangles [n][3]."""
    kinds = {"float": "<f4", "int": "<i4", "uchar": "u1"}
    fields, counts = [], {}
    with open(file, "rb") as stream:
        for line in iter(lambda: stream.readline().decode().split(), ["end_header"]):
            if line[0] == "element":
                counts[line[1]] = int(line[2])
            elif line[0] == "property" and line[1] != "list":
                fields.append((line[2], kinds[line[1]]))
        vertices = numpy.fromfile(stream, fields, counts["vertex"])
        faces = numpy.fromfile(stream, [("n", "u1"), ("v", "<i4", 3)], counts["face"])
    assert (faces["n"] == 3).all()
    return vertices, faces["v"]


def ring(centre, axis, radius, count):
    """Points of a circle, counter-clockwise about the axis."""
    axis = axis / numpy.linalg.norm(axis)
    across = numpy.cross(axis, numpy.eye(3)[numpy.argmin(abs(axis))])
    across /= numpy.linalg.norm(across)
    phi = 2 * numpy.pi * numpy.arange(count) / count
    return centre + radius * (numpy.outer(numpy.cos(phi), across) + numpy.outer(numpy.sin(phi), numpy.cross(axis, across)))


def flat_shape(row, count=96):
    """A curved shape of the solution file as triangles, wound towards its front."""
    kind, first, second, radius, other_radius, inside = int(row[0]), row[1:4], row[4:7], row[7], row[8], row[9]
    if kind == 0:
        polar = numpy.pi * numpy.arange(count // 2 + 1) / (count // 2)
        up = numpy.array([0, 0, 1.0])
        rings = [ring(first - radius * numpy.cos(a) * up, up, radius * numpy.sin(a), count) for a in polar]
    elif kind == 1:
        rings = [ring(first, second, radius, count), ring(first, second, other_radius, count)]
    else:
        rings = [ring(first, second - first, radius, count),
                 ring(second, second - first, radius if kind == 2 else other_radius, count)]
    low = numpy.arange(count) + count * numpy.arange(len(rings) - 1)[:, None]
    next_low = (numpy.arange(count) + 1) % count + count * numpy.arange(len(rings) - 1)[:, None]
    triangles = numpy.concatenate([numpy.stack([low, next_low, next_low + count], axis=2).reshape(-1, 3),
                                   numpy.stack([low, next_low + count, low + count], axis=2).reshape(-1, 3)])
    return numpy.concatenate(rings), triangles[:, ::-1] if inside else triangles


def read_room(solution):
    """Triangles and materials of the room as it was traced; curved shapes as many flat triangles."""
    with h5py.File(solution, "r") as file:
        material = file["surfaces/material"][:][file["mesh/triangle_surface"][:]]
        vertices, triangles = [file["mesh/vertices"][:]], file["mesh/triangles"][:]
        shape = file["mesh/triangle_shape"][:].astype(numpy.int64) if "mesh/triangle_shape" in file else None
        is_flat = numpy.ones(len(triangles), bool) if shape is None else shape == 2**32 - 1
        all_triangles, all_materials = [triangles[is_flat].astype(numpy.int64)], [material[is_flat]]
        for number in numpy.unique(shape[~is_flat]) if shape is not None else ():
            points, faces = flat_shape(file["mesh/shapes"][number])
            all_triangles.append(faces + sum(len(v) for v in vertices))
            vertices.append(points)
            all_materials.append(numpy.full(len(faces), material[shape == number][0]))
        return {"vertices": numpy.concatenate(vertices), "triangles": numpy.concatenate(all_triangles),
                "triangle_material": numpy.concatenate(all_materials), "albedo": file["materials/reflectance"][:],
                "radiance": file["materials/emitted_radiance"][:], "two_sided": file["materials/two_sided"][:]}


def vertex_areas(vertices, triangles):
    p = numpy.stack([vertices[c][triangles].astype(float) for c in "xyz"], axis=2)
    area = numpy.linalg.norm(numpy.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1) / 2
    weight = numpy.zeros(len(vertices))
    for corner in range(3):
        numpy.add.at(weight, triangles[:, corner], area / 3)
    return weight


class Errors:
    """Of values [items][bands] against the mean of two long runs, whose noise is taken out."""

    def __init__(self, first, second, share, weight):
        """share: of an item in the sum of all; weight(truth): of the squared deviations, [items][bands]."""
        self.truth = (first + second) / 2
        self.share = share
        self.weight = weight(self.truth)
        self.noise2 = self.squares(first - second) / 4

    def squares(self, deviation):
        return (self.weight * deviation**2).sum(axis=0)

    def own(self):
        return numpy.sqrt(self.noise2.max())

    def of(self, values):
        return numpy.sqrt(numpy.maximum(0, self.squares(values - self.truth) - self.noise2).max())

    def gain(self, values):
        """Sum of the values over that of the truth, less 1: what the programs disagree in as a whole."""
        return (self.share * values).sum() / (self.share * self.truth).sum() - 1


def still_weight(truth):
    return 1 / (truth + FLOOR * truth.mean(axis=0))**2 / len(truth)


def time_to(error, points):
    """Time at which a curve of (seconds, error) falls to an error: straight in log-log between points; beyond the last one as
    the root of the time, marked so; None where the first is better already."""
    points = sorted(points)
    for (t0, e0), (t1, e1) in zip(points, points[1:]):
        if e0 >= error >= e1:
            share = numpy.log(e0 / error) / numpy.log(e0 / e1) if e0 > e1 else 0
            return t0 * (t1 / t0)**share, False
    if points[0][1] < error:
        return None
    return points[-1][0] * (points[-1][1] / error)**2, True


def compare(room, what, ours, theirs):
    """Rows of a table: seconds of both at equal error."""
    rows = []
    for error in ERRORS:
        mine, other = time_to(error, ours), time_to(error, theirs)
        if not mine or not other or mine[1]:
            continue
        shown = f"*{other[0]:.3g}*" if other[1] else f"{other[0]:.3g}"
        rows.append(f"| {room} | {what} | {100 * error:g} % | {mine[0]:.2g} | {shown} | **{other[0] / mine[0]:.2g}** |")
    return rows


def measure_stills(name, reemit, cycles, quick):
    camera = reemit.camera()
    room, _ = reemit.solve(2**14)
    cycles.write_room(**read_room(room))
    jobs = []
    reference = STILL_REFERENCE // (8 if quick else 1)
    for samples, seed in [(reference, 101), (reference, 102)] + [(s, 1) for s in STILL_SAMPLES]:
        jobs.append({"name": f"{samples}_{seed}", "kind": "still", "samples": samples, "seed": seed, "size": [SIZE, SIZE],
                     "eye": camera["eye_m"], "look_at": camera["look_at_m"], "up": camera["up"],
                     "fov_deg": camera["vertical_fov_deg"]})
    seconds = cycles.do(jobs)
    pictures = {j["name"]: read_picture(cycles.folder / f"{j['name']}.exr").reshape(-1, 3) for j in jobs}
    errors = Errors(pictures[jobs[0]["name"]], pictures[jobs[1]["name"]], 1, still_weight)
    runs, theirs, ours = [], [], []
    for job in jobs[2:]:
        theirs.append((seconds[job["name"]], errors.of(pictures[job["name"]])))
        runs.append((f"Cycles, {job['samples']} samples", *theirs[-1], errors.gain(pictures[job["name"]])))
    for packets, error in STILL_EFFORTS:
        solution, solve_seconds = reemit.solve(packets)
        picture, render_seconds = reemit.still(solution, "--smooth", "on", "--error", error)
        values = picture.reshape(-1, 3)
        ours.append((solve_seconds + render_seconds, errors.of(values)))
        runs.append((f"reemit, {packets} packets, --error {error}", ours[-1][0], ours[-1][1], errors.gain(values)))
    return compare(name, "still", ours, theirs), [(name, "still", *r, errors.own()) for r in runs]


def measure_vertices(name, zone_area, reemit, cycles, quick):
    fine = ("--zone-area", zone_area)
    solution, _ = reemit.solve(2**14, *fine)
    (vertices, triangles), _ = reemit.vertices(solution, "--values", "zones")
    room = read_room(solution)
    emits = room["radiance"].max(axis=1) > 0
    is_point = ~emits[vertices["material"]]
    keep = is_point[triangles].all(axis=1)
    lamps = emits[room["triangle_material"]]
    cycles.write_room(
        **{**room, "triangles": room["triangles"][lamps], "triangle_material": room["triangle_material"][lamps]},
        point_vertices=numpy.stack([vertices[c] for c in "xyz"], axis=1), point_triangles=triangles[keep],
        point_albedo=room["albedo"][vertices["material"]])
    reference = VERTEX_REFERENCE // (8 if quick else 1)
    jobs = [{"name": f"{samples}_{seed}", "kind": "bake", "samples": samples, "seed": seed}
            for samples, seed in [(reference, 101), (reference, 102)] + [(s, 1) for s in VERTEX_SAMPLES]]
    seconds = cycles.do(jobs)
    baked = {j["name"]: numpy.pi * numpy.load(cycles.folder / f"{j['name']}.npy").astype(float) for j in jobs}
    area = numpy.where(is_point, vertex_areas(vertices, triangles[keep]), 0)[:, None]
    errors = Errors(baked[jobs[0]["name"]], baked[jobs[1]["name"]], area,
                    lambda truth: area / (area * truth**2).sum(axis=0))
    runs, theirs, ours = [], [], []
    for job in jobs[2:]:
        theirs.append((seconds[job["name"]], errors.of(baked[job["name"]])))
        runs.append((f"Cycles, {job['samples']} samples", *theirs[-1], errors.gain(baked[job["name"]])))
    for packets, options in VERTEX_EFFORTS:
        solution, solve_seconds = reemit.solve(packets, *fine)
        (found, _), export_seconds = reemit.vertices(solution, *options)
        values = numpy.stack([found[f"irradiance_{b}"] for b in "rgb"], axis=1).astype(float)
        ours.append((solve_seconds + export_seconds, errors.of(values)))
        runs.append((f"reemit, {packets} packets, {' '.join(options)}", *ours[-1], errors.gain(values)))
    return compare(name, f"{is_point.sum()} vertices", ours, theirs), [(name, "vertices", *r, errors.own()) for r in runs]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--room", action="append", choices=sorted(ROOMS), help="this room only; may be given again")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--quick", action="store_true", help="references with an eighth of the samples")
    parser.add_argument("--keep", type=pathlib.Path, help="keep pictures and values in this folder")
    parser.add_argument("--only", choices=("stills", "vertices"))
    args = parser.parse_args()
    if not shutil.which("blender"):
        print("compare_with_cycles.py: skipped, there is no blender", file=sys.stderr)
        sys.exit(EXIT_SKIPPED)
    rows, runs = [], []
    with tempfile.TemporaryDirectory() as scratch:
        for name in args.room or ROOMS:
            for what in ("stills", "vertices"):
                if args.only not in (None, what):
                    continue
                folder = (args.keep or pathlib.Path(scratch)) / f"{name}_{what}"
                folder.mkdir(parents=True, exist_ok=True)
                reemit = Reemit(args.program.resolve(), LIBRARY / f"{name}.json", folder, args.threads)
                cycles = Cycles(folder, args.threads)
                found = (measure_stills(name, reemit, cycles, args.quick) if what == "stills" else
                         measure_vertices(name, ROOMS[name], reemit, cycles, args.quick))
                rows += found[0]
                runs += found[1]
                print(f"{name}, {what}: done", file=sys.stderr)
    print("| room | what | rms error | reemit [s] | Cycles [s] | factor |\n|---|---|---|---|---|---|")
    print("\n".join(rows))
    print("\n| room | what | run | seconds | rms error | sum over that of the reference | error of the reference |\n"
          "|---|---|---|---|---|---|---|")
    for name, what, run_name, seconds, error, gain, own in runs:
        print(f"| {name} | {what} | {run_name} | {seconds:.3g} | {100 * error:.2f} % | {100 * gain:+.2f} % | {100 * own:.2f} % |")


main()
