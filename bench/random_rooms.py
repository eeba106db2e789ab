#!/usr/bin/env python3
"""Makes rooms that no test was written for, solves them and looks for light that two ways of finding it disagree about.

Usage: random_rooms.py PROGRAM [--seed N] [--count N] [--packets N] [--keep FOLDER] [--planted SHARE]

A room is a box or an L with three to nine things (boxes, cylinders, cones, balls, sheets, rods, disks, shelves, tubes; matt,
mirrors, gloss, metal, opal, panes and balls of glass), up to three more that are half there, have only a front or two
different sides, one to four luminaires of any shape, at times a measured one or a lamp in an opal globe or shade, and at times a
window or a hole with a sky behind it. The same number gives the same room on any machine. Of every room

- the direct light that packets brought must be what shadow rays find (reemit audit --direct);
- the books must balance, and nothing may come to backs but to those of things that have only a front;
- the light that small zones got by gathering must be what packets had brought to them, within 5 standard errors or 3 %; of
  all rooms together within 4 standard errors or 1 %;
- the light on every side of every surface, but for the inside of glass, must be what random walks (solve --method walk) bring,
  within 7 standard errors or 2 %: with 15 degrees of freedom at most four of a million differ by more; of all rooms together within
  4 standard errors or 0.5 %;
- with --stills, the indirect light of a gathered still must be that of a path-traced one, in each of its 4 x 3 parts within 7
  standard errors or 8 % of the light in the brightest, the whole within 5 or 3 %; of all rooms together within 4 standard errors or 1 %.

--planted 0.02 makes what was gathered and what walks brought 2 % more, which must be noticed each time.
Exit code 0: all of this held; 1: it did not, and the rooms are named. With --keep the rooms stay, for
bench_hit_paths FOLDER/*.json. Needs h5py and numpy, --stills also OpenImageIO.
"""
import argparse
import json
import pathlib
import random
import subprocess
import sys
import tempfile

import h5py
import numpy

EVEN_WITHOUT_NOISE = 0.005  # what small zones or the still of one room may be off by
GLASS_BODY = "glass ball"  # how bodies of glass begin
ODD_SHEET = "odd sheet"  # how things begin that may have a back that only absorbs
MEASURED_LUMINAIRE = pathlib.Path(__file__).resolve().parent.parent / "docs/examples/downlight.ies"


class Maker:
    """Draws one room."""

    def __init__(self, number):
        self.draw = random.Random(number)
        self.more = random.Random(f"more of {number}")  # leaves what `draw` gives as it is
        self.size = (self.between(2, 7), self.between(2.2, 3.5), self.between(2, 6))  # x, up, z [m]
        self.objects, self.lights = [], []
        self.materials = {}

    def between(self, low, high):
        return self.draw.uniform(low, high)

    def colour(self, low, high):
        if self.draw.random() < 0.7:
            return [self.between(low, high) for _ in range(3)]
        return self.between(low, high)

    def room(self):
        self.add_materials()
        self.add_shell()
        for i in range(self.draw.randint(3, 9)):
            self.add_thing(i)
        for i in range(self.draw.randint(1, 4)):
            self.add_luminaire(i)
        self.draw = self.more
        for i in range(self.draw.randint(0, 3)):
            self.add_odd_sheet(i)
        if self.draw.random() < 0.3:
            self.add_measured_luminaire()
        text = {"format": "reemit-room", "version": 1, "bands": "rgb", "materials": self.materials, "objects": self.objects}
        self.add_opal_lamp(random.Random(f"opal lamp of {len(self.objects)} things, {self.size}"))
        if self.draw.random() < 0.4:
            sky = self.open_window()
            if sky:
                text["sky"] = sky
        if self.lights:
            text["lights"] = self.lights
        return text

    def add_materials(self):
        draw = self.draw
        self.materials.update({
            "wall": {"reflectance": self.colour(0.4, 0.85)}, "floor": {"reflectance": self.colour(0.1, 0.6)},
            "cloth": {"reflectance": self.colour(0.1, 0.85)}, "wood": {"reflectance": self.colour(0.1, 0.85)},
            "mirror": {"mirror": self.between(0.6, 0.95)},
            "satin": {"reflectance": self.between(0.05, 0.3), "mirror": self.between(0.2, 0.6),
                      "roughness": self.between(0.1, 0.5), "lobe": draw.choice(["ggx", "ward", "phong"])},
            "metal": {"metal": draw.choice(["gold", "copper", "aluminium"]), "roughness": draw.choice([0, self.between(0.1, 0.4)])},
            "pane": {"glass": {"ior": 1.5, "transmittance": self.between(0.8, 0.98)}},
            "opal": {"reflectance": self.between(0.1, 0.3), "diffuse_transmittance": self.between(0.2, 0.6)},
            "solid": {"glass": {"ior": self.between(1.3, 1.7), "solid": True}}})

    def add(self, name, material, **content):
        self.objects.append({"name": name, "material": material, **content})

    def add_shell(self):
        x, up, z = self.size
        if self.draw.random() < 0.5:
            self.add("shell", "wall", materials={"y-": "floor"}, box={"min": [0, 0, 0], "max": [x, up, z], "inward": True})
            return
        inner_x, inner_z = self.between(0.4, 0.7) * x, self.between(0.4, 0.7) * z
        outline = [(0, 0), (x, 0), (x, inner_z), (inner_x, inner_z), (inner_x, z), (0, z)]
        self.add("floor", "floor", polygon={"vertices": [[a, 0, b] for a, b in reversed(outline)]})
        self.add("ceiling", "wall", polygon={"vertices": [[a, up, b] for a, b in outline]})
        for i, (a, b) in enumerate(outline):
            c, d = outline[(i + 1) % len(outline)]
            self.add(f"wall {i}", "wall", polygon={"vertices": [[a, 0, b], [c, 0, d], [c, up, d], [a, up, b]]})
        # Things and luminaires go into one of the arms.
        self.size = (inner_x, up, z) if self.draw.random() < 0.5 else (x, up, inner_z)

    def add_thing(self, i):
        draw, between = self.draw, self.between
        up = self.size[1]
        x, z, s = between(0.15, 0.85) * self.size[0], between(0.15, 0.85) * self.size[2], between(0.1, 0.5)
        matt = draw.choice(["cloth", "wood", "floor", "wall"])
        any_kind = draw.choice([matt] * 3 + ["mirror", "satin", "metal"])
        kind = draw.choice(["box", "box", "cylinder", "ball", "sheet", "rods", "disk", "shelf", "tube", GLASS_BODY, "pane"])
        name = f"{kind} {i}"
        if kind == "box":
            sides = {"min": [-s, 0, -s * between(0.1, 1)], "max": [s, between(0.1, 1.2), s * between(0.1, 1)]}
            stands = draw.random() < 0.6
            if stands:
                sides["open"] = ["y-"]
            axis = [0, 1, 0] if stands else [between(-1, 1), between(0.1, 1), between(-1, 1)]
            self.add(name, any_kind, box=sides, transform=[
                {"rotate": {"axis": axis, "angle_deg": between(0, 360)}},
                {"translate": [x, 0 if stands else between(0.2, 0.6) * up, z]}])
        elif kind == "cylinder":
            self.add(name, any_kind, cylinder={
                "base": [x, 0, z], "top": [x + between(-0.2, 0.2), between(0.3, 1.5), z], "radius": 0.5 * s,
                "top_radius": 0.5 * s * draw.choice([0, 0.5, 1, 1.4]), "caps": draw.choice(["both", "none"])})
        elif kind == "ball":
            self.add(name, any_kind, sphere={"center": [x, draw.choice([0.6 * s, between(0.3, 0.7) * up]), z], "radius": 0.6 * s})
        elif kind == "sheet":
            self.add(name, draw.choice([any_kind, "opal"]), quad={
                "corner": [x, between(0.1, 0.5) * up, z], "u": [between(-0.8, 0.8), between(-0.2, 0.2), between(-0.8, 0.8)],
                "v": [between(-0.2, 0.2), between(0.2, 0.9), between(-0.2, 0.2)]})
        elif kind == "rods":
            self.add(name, draw.choice([matt, "metal"]),
                     cylinder={"base": [x, 0, z], "top": [x, up, z], "radius": between(0.003, 0.03), "caps": "none"},
                     array={"count": draw.randint(2, 7), "step": [between(0.02, 0.12), 0, between(0, 0.05)]})
        elif kind == "disk":
            ring = {"inner_radius": s * between(0.2, 0.8)} if draw.random() < 0.5 else {}
            self.add(name, any_kind, disk={"center": [x, between(0.2, 0.8) * up, z],
                                           "normal": [between(-1, 1), between(0.2, 1), between(-1, 1)], "radius": s, **ring})
        elif kind == "shelf":
            self.add(name, matt, quad={"corner": [0, between(0.3, 0.8) * up, between(0.2, 0.4) * self.size[2]],
                                       "u": [between(0.2, 0.5), 0, 0], "v": [0, 0, -0.08 * self.size[2]]},
                     array={"count": draw.randint(1, 5), "step": [0, between(0.02, 0.2), 0]})
        elif kind == "tube":
            height = between(0.3, 0.8) * up
            self.add(name, matt, cylinder={"base": [draw.choice([-0.02, 0.2]), height, z],
                                           "top": [between(0.5, 0.9) * self.size[0], between(0.3, 0.8) * up, z],
                                           "radius": between(0.01, 0.08)})
        elif kind == GLASS_BODY:
            self.add(name, "solid", sphere={"center": [x, between(0.3, 0.7) * up, z], "radius": 0.4 * s})
        else:
            self.add(name, draw.choice(["pane", "opal"]),
                     quad={"corner": [x, 0.01, z], "u": [between(0.3, 0.8), 0, between(-0.4, 0.4)], "v": [0, between(0.5, 1.5), 0]})

    def add_odd_sheet(self, i):
        between = self.between
        self.materials.update({
            "half there": {"reflectance": self.colour(0.2, 0.8), "opacity": between(0.2, 0.8)},
            "front only": {"reflectance": self.colour(0.2, 0.8), "sides": "front"},
            "two colours": {"reflectance": self.colour(0.2, 0.8), "back_reflectance": self.colour(0.2, 0.8)}})
        x, up, z = (between(0.15, 0.7) * length for length in self.size)
        self.add(f"{ODD_SHEET} {i}", self.draw.choice(["half there", "front only", "two colours"]), quad={
            "corner": [x, 0.8 * up, z], "u": [between(-0.8, 0.8), between(-0.2, 0.2), between(-0.8, 0.8)],
            "v": [between(-0.2, 0.2), between(0.2, 0.9), between(-0.2, 0.2)]})

    def add_measured_luminaire(self):
        x, up, z = self.size
        self.lights.append({"type": "ies", "name": "measured", "file": str(MEASURED_LUMINAIRE), "mount": "ceiling",
                            "position": [self.between(0.2, 0.8) * x, up, self.between(0.2, 0.8) * z]})

    def add_opal_lamp(self, draw):
        """A bulb in a globe or a shade, which are bright on both sides."""
        if draw.random() < 0.6:
            return
        share = draw.uniform(0.3, 0.45)
        self.materials["shade"] = {"reflectance": share, "diffuse_transmittance": share}
        self.materials["bulb"] = {"reflectance": 0.5, "radiance": 100 * 30 ** draw.random()}
        x, y, z = (draw.uniform(0.3, 0.7) * length for length in self.size)
        radius = draw.uniform(0.08, 0.2)
        self.add("bulb", "bulb", sphere={"center": [x, y, z], "radius": 0.25 * radius})
        if draw.random() < 0.5:
            self.add("globe", "shade", sphere={"center": [x, y, z], "radius": radius})
        else:
            self.add("shade", "shade", cylinder={"base": [x, y - radius, z], "top": [x, y + radius, z], "radius": radius, "caps": "none"})

    def open_window(self):
        """Puts a window into one wall of a box and returns the sky behind it; None if the room is no box."""
        shell = self.objects[0]
        if "box" not in shell:
            return None
        between = self.between
        x, up, _ = shell["box"]["max"]
        shell["box"]["open"] = ["z-"]
        left, right = sorted(between(0.1, 0.9) * x for _ in range(2))
        low, high = sorted(between(0.1, 0.9) * up for _ in range(2))
        self.add("window wall", "wall", polygon={"vertices": [[0, 0, 0], [x, 0, 0], [x, up, 0], [0, up, 0]],
                                                 "holes": [[[left, low, 0], [left, high, 0], [right, high, 0], [right, low, 0]]]})
        if self.draw.random() < 0.7:
            self.add("window", self.draw.choice(["pane", "pane", "opal"]),
                     quad={"corner": [left, low, 0], "u": [right - left, 0, 0], "v": [0, high - low, 0]})
        sky = {"type": self.draw.choice(["uniform", "overcast"]), "illuminance_lx": between(500, 3000)}
        if self.draw.random() < 0.5:
            sky["sun"] = {"altitude_deg": between(15, 50), "azimuth_deg": between(-30, 30), "illuminance_lx": 3000}
        return sky

    def add_luminaire(self, i):
        draw, between = self.draw, self.between
        up = self.size[1]
        x, z, s = between(0.2, 0.8) * self.size[0], between(0.2, 0.8) * self.size[2], between(0.03, 0.4)
        kind = draw.choice(["panel", "panel", "two sides", "ball", "tube", "ring", "disk", "strip", "sconce", "point", "spot"])
        name, material = f"{kind} {i}", f"lamp {i}"
        emission = {"reflectance": between(0, 0.5), "radiance": self.colour(2, 20)}
        if kind in ("point", "spot"):
            light = {"type": kind, "name": name, "position": [x, between(0.5, 0.9) * up, z]}
            if kind == "point":
                light["power"] = self.colour(20, 100)
            else:
                light.update(direction=[between(-0.5, 0.5), -1, between(-0.5, 0.5)], inner_angle_deg=5,
                             outer_angle_deg=between(15, 60), intensity=self.colour(10, 60))
            self.lights.append(light)
            return
        shapes = {
            "panel": {"quad": {"corner": [x, up - draw.choice([0.002, 0.05, 0.4]), z], "u": [s, 0, 0], "v": [0, 0, s * between(0.2, 1.5)]}},
            "two sides": {"quad": {"corner": [x, between(0.5, 0.8) * up, z], "u": [s, 0, 0], "v": [0, 0.3 * s, s]}},
            "ball": {"sphere": {"center": [x, between(0.5, 0.85) * up, z], "radius": 0.4 * s}},
            "tube": {"cylinder": {"base": [x, between(0.6, 0.9) * up, z], "top": [x + between(0.1, 0.5), between(0.6, 0.9) * up, z],
                                  "radius": between(0.01, 0.04)}},
            "ring": {"disk": {"center": [x, up - 0.1, z], "normal": [0, -1, 0], "radius": s, "inner_radius": 0.6 * s}},
            "disk": {"disk": {"center": [x, up - draw.choice([0.002, 0.1]), z], "normal": [0, -1, 0], "radius": 0.5 * s}},
            "strip": {"quad": {"corner": [x, up - 0.01, z], "u": [between(0.5, 1), 0, 0], "v": [0, 0, between(0.004, 0.03)]}},
            "sconce": {"quad": {"corner": [0.001, between(0.4, 0.8) * up, between(0.2, 0.6) * self.size[2]], "u": [0, s, 0], "v": [0, 0, s]}}}
        if kind == "two sides" or (kind == "ball" and draw.random() < 0.3):
            emission["emission_sides"] = "both"
        elif kind not in ("ball", "tube") and draw.random() < 0.3:
            emission["emission_exponent"] = draw.choice([1, 4, 20])
        self.materials[material] = emission
        self.add(name, material, **shapes[kind])


def small_zones(solution):
    """Power on the gathered zones, all bands: by packets and gathered, each with its standard error [W]; None if there are none."""
    with h5py.File(solution) as file:
        if "gathered" not in file or len(file["gathered/zone"]) == 0:
            return None
        zones = file["gathered/zone"][:]
        area = file["zones/area"][:][zones][None, :, None]
        weight = file["sums/group_weight"][:][:, None, None]
        by_packets = (file["gathered/group_total"][:] / weight * area).sum(axis=(1, 2))
        gathered = (file["sums/group_total"][:][:, zones] / weight * area).sum(axis=(1, 2))
    error = [numpy.std(x, ddof=1) / len(x) ** 0.5 for x in (by_packets, gathered)]
    return by_packets.mean(), error[0], gathered.mean(), error[1]


def run_json(program, folder, *arguments, good_codes=(0,)):
    """What a command prints with --json; raises RuntimeError if it ends with another code than these."""
    run = subprocess.run([program, *arguments, "--json"], cwd=folder, capture_output=True, text=True)
    if run.returncode not in good_codes:
        raise RuntimeError(f"{arguments[0]} ended with {run.returncode}: {run.stderr.strip()}")
    return json.loads(run.stdout)


def solve(program, folder, room, solution, *options):
    (folder / solution).unlink(missing_ok=True)
    run_json(program, folder, "solve", room, "-o", solution, *options)


def light_on_surfaces(program, folder, solution):
    """By name and side: area [m2], irradiances by band [W/m2] and their standard errors."""
    return {(surface["name"], surface["side"]): (surface["area_m2"], numpy.array(surface["irradiance_W_m2"]),
                                                 numpy.array(surface["irradiance_stderr_W_m2"]))
            for surface in run_json(program, folder, "info", solution)["surfaces"]}


def compare_with_walks(shot, walked, planted):
    """What differs by side, and the deviation of all light together with its error."""
    faults = []
    flux, difference, squares = 0, 0, 0
    for key, (area, light, error) in shot.items():
        if key[0].startswith(GLASS_BODY) and key[1] == "back":
            continue  # some paths go round in glass ten thousand times
        _, other, other_error = walked[key]
        other = other * (1 + planted)
        both = numpy.hypot(error, other_error)
        far = abs(light - other) > numpy.maximum(7 * both, 0.02 * numpy.maximum(light, other))
        if far.any():
            faults.append(f"light on the {key[1]} of '{key[0]}': {light} W/m2, by walks {other}")
        flux += area * light.sum()
        difference += area * (other - light).sum()
        squares += (area * both).sum() ** 2
    return faults, (difference / flux, squares ** 0.5 / flux) if flux > 0 else None


def indirect_light(picture):
    """Of the 4 x 3 parts of a still: mean of the indirect light of all bands and its standard error [W/(m2 sr)]."""
    import OpenImageIO
    image = OpenImageIO.ImageBuf(str(picture))
    names = list(image.spec().channelnames)
    values = image.get_pixels(OpenImageIO.FLOAT)
    rows, columns = values.shape[:2]
    parts = []
    for layer in ("indirect.", "stderr."):
        of_bands = values[:, :, [names.index(layer + band) for band in "RGB"]].sum(axis=2)
        if layer == "stderr.":
            of_bands = of_bands ** 2
        parts.append(of_bands.reshape(3, rows // 3, 4, columns // 4).mean(axis=(1, 3)))
    return parts[0], (parts[1] / (rows // 3 * (columns // 4))) ** 0.5


def hides_light_from_paths(room):
    """Whether lights without area or the sun are seen over mirrors or glass, which path tracing does not find."""
    bends = {"mirror", "satin", "metal", "solid"} & {thing["material"] for thing in room["objects"]}
    return bool(bends) and ("lights" in room or "sun" in room.get("sky", {}))


def compare_stills(program, folder, solution, planted):
    """Which parts of a gathered still differ from the path-traced one, and the deviation of the whole with its error."""
    stills = []
    for integrator, samples in (("gather", "128"), ("path", "512")):
        picture = f"{solution}.{integrator}.exr"
        run_json(program, folder, "render", solution, "--integrator", integrator, "--spp", samples, "--smooth", "off", "--size", "64x48",
                 "-o", picture)
        stills.append(indirect_light(folder / picture))
        (folder / picture).unlink()
    (gathered, gathered_error), (traced, traced_error) = stills
    gathered = gathered * (1 + planted)
    error = numpy.hypot(gathered_error, traced_error)
    far = abs(gathered - traced) > numpy.maximum(7 * error, 0.08 * traced.max())
    faults = [f"still, part {tuple(part)}: {gathered[tuple(part)]:.4g} gathered, {traced[tuple(part)]:.4g} +- {error[tuple(part)]:.2g} traced"
              for part in numpy.argwhere(far)]
    whole = traced.sum()
    if not whole > 0:
        return faults, None
    deviation, error = gathered.sum() / whole - 1, (error ** 2).sum() ** 0.5 / whole
    if abs(deviation) > max(5 * error, 0.03):
        faults.append(f"still: {100 * deviation:+.1f} +- {100 * error:.1f} % by gathering")
    return faults, (deviation, error)


def examine(program, number, folder, options):
    """What is wrong with the solution of one room, and the deviations of its small zones, of walks and of a still with their errors, or None."""
    room = f"random_{number}.json"
    made = Maker(number).room()
    (folder / room).write_text(json.dumps(made, indent=1))
    solution, walks = f"random_{number}.h5", f"random_{number}_walks.h5"
    packets = ("--packets", str(options.packets))
    faults = []
    try:
        solve(program, folder, room, solution, *packets)
        solve(program, folder, room, walks, *packets, "--method", "walk", "--seed", "2")
        audit = run_json(program, folder, "audit", solution, "--direct", good_codes=(0, 1))
        walked, deviation_of_walks = compare_with_walks(light_on_surfaces(program, folder, solution),
                                                        light_on_surfaces(program, folder, walks), options.planted)
        of_still, deviation_of_still = ([], None)
        if options.stills and not hides_light_from_paths(made):
            of_still, deviation_of_still = compare_stills(program, folder, solution, options.planted)
    except RuntimeError as fault:
        return [str(fault)], None, None, None
    faults += walked + of_still
    if not audit["balanced"]:
        faults.append("the books do not balance")
    if any(sum(surface["absorbed_on_backs_W"]) > 0 and not surface["name"].startswith(ODD_SHEET) for surface in audit["surfaces"]):
        faults.append("light came to backs")
    direct = audit["direct"]
    for surface in direct["surfaces"]:
        if surface["differs"]:
            faults.append("direct light on '{name}': {by_packets_W:.4g} W by packets, {by_shadow_rays_W:.4g} by shadow rays".format(**surface))
    if direct["zones_different"]:
        faults.append(f"direct light of {direct['zones_different']} zones")
    small = small_zones(folder / solution)
    if not options.keep:
        (folder / solution).unlink()
        (folder / walks).unlink()
    if small is None or not small[0] > 0:
        return faults, None, deviation_of_walks, deviation_of_still
    packets, packets_error, gathered, gathered_error = small
    deviation = gathered * (1 + options.planted) / packets - 1
    error = numpy.hypot(packets_error, gathered_error) / packets
    if abs(deviation) > max(5 * error, 0.03):
        faults.append(f"small zones: {100 * deviation:+.1f} +- {100 * error:.1f} % by gathering")
    return faults, (deviation, error), deviation_of_walks, deviation_of_still


def mean_of_rooms(deviations, without_noise):
    """No room alone decides. Mean of these deviations and its error, where each may be off by `without_noise` for other reasons."""
    values = numpy.array(deviations)
    weight = 1 / (values[:, 1] ** 2 + without_noise ** 2)
    return (weight * values[:, 0]).sum() / weight.sum(), weight.sum() ** -0.5


def in_words(deviation):
    return "none" if deviation is None else f"{100 * deviation[0]:+.2f} +- {100 * deviation[1]:.2f} %"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--seed", type=int, default=1, help="number of the first room")
    parser.add_argument("--count", type=int, default=30)
    parser.add_argument("--packets", type=int, default=2_000_000)
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the rooms and their solutions")
    parser.add_argument("--stills", action="store_true", help="compare a gathered and a path-traced still of each as well")
    parser.add_argument("--planted", type=float, default=0, help="share by which what is compared is made brighter")
    options = parser.parse_args()
    program = str(pathlib.Path(options.program).resolve())
    with tempfile.TemporaryDirectory() as scratch:
        folder = options.keep or pathlib.Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        bad = 0
        of_small_zones, of_walks, of_stills = [], [], []
        for number in range(options.seed, options.seed + options.count):
            faults, small, walks, still = examine(program, number, folder, options)
            of_small_zones += [small] if small else []
            of_walks += [walks] if walks else []
            of_stills += [still] if still else []
            bad += bool(faults)
            print(f"room {number}: small zones {in_words(small)}, walks {in_words(walks)}, still {in_words(still)}" + "".join(f"\n  {fault}" for fault in faults),
                  flush=True)
    # What reads zones differs a little from what packets do; walks and packets do not differ.
    for what, deviations, without_noise, allowed in (("small zones", of_small_zones, EVEN_WITHOUT_NOISE, 0.01),
                                                     ("walks", of_walks, 0, 0.005),
                                                     ("stills", of_stills, EVEN_WITHOUT_NOISE, 0.01)):
        if not deviations:
            continue
        mean, error = mean_of_rooms(deviations, without_noise)
        print(f"{what} of all rooms: {in_words((mean, error))}")
        bad += abs(mean) > max(4 * error, allowed)
    print(f"{options.count} rooms, {bad} complaints")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
