#!/usr/bin/env python3
"""Makes rooms that no test was written for, solves them and looks for light that two ways of finding it disagree about.

Usage: random_rooms.py PROGRAM [--seed N] [--count N] [--packets N] [--keep FOLDER] [--planted SHARE]

A room is a box or an L with three to nine things (boxes, cylinders, cones, balls, sheets, rods, disks, shelves, tubes; matt,
mirrors, gloss, metal, opal, panes and balls of glass) and one to four luminaires of any shape. The same number gives the same room
on any machine. Of every room

- the direct light that packets brought must be what shadow rays find (reemit audit --direct);
- the books must balance, and nothing may come to backs;
- the light that small zones got by gathering must be what packets had brought to them, within 5 standard errors or 3 %; of
  all rooms together within 4 standard errors or 1 %. --planted 0.02 makes what was gathered 2 % more, which must be noticed.

Exit code 0: all of this held; 1: it did not, and the rooms are named. With --keep the rooms stay, for
bench_hit_paths FOLDER/*.json. Needs h5py and numpy.
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

EVEN_WITHOUT_NOISE = 0.005  # what small zones of one room may be off by


class Maker:
    """Draws one room."""

    def __init__(self, number):
        self.draw = random.Random(number)
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
        text = {"format": "reemit-room", "version": 1, "bands": "rgb", "materials": self.materials, "objects": self.objects}
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
        kind = draw.choice(["box", "box", "cylinder", "ball", "sheet", "rods", "disk", "shelf", "tube", "glass ball", "pane"])
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
        elif kind == "glass ball":
            self.add(name, "solid", sphere={"center": [x, between(0.3, 0.7) * up, z], "radius": 0.4 * s})
        else:
            self.add(name, draw.choice(["pane", "opal"]),
                     quad={"corner": [x, 0.01, z], "u": [between(0.3, 0.8), 0, between(-0.4, 0.4)], "v": [0, between(0.5, 1.5), 0]})

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


def examine(program, number, folder, options):
    """What is wrong with the solution of one room, and the deviation of its small zones with its error, or None."""
    room = folder / f"random_{number}.json"
    room.write_text(json.dumps(Maker(number).room(), indent=1))
    solution = folder / f"random_{number}.h5"
    solution.unlink(missing_ok=True)
    run = subprocess.run([program, "solve", room.name, "-o", solution.name, "--packets", str(options.packets), "--quiet"],
                         cwd=folder, capture_output=True, text=True)
    if run.returncode != 0:
        return [f"solve ended with {run.returncode}: {run.stderr.strip()}"], None
    run = subprocess.run([program, "audit", solution.name, "--direct", "--json"], cwd=folder, capture_output=True, text=True)
    if run.returncode not in (0, 1):
        return [f"audit ended with {run.returncode}: {run.stderr.strip()}"], None
    audit = json.loads(run.stdout)
    faults = []
    if not audit["balanced"]:
        faults.append("the books do not balance")
    if any(sum(surface["absorbed_on_backs_W"]) > 0 for surface in audit["surfaces"]):
        faults.append("light came to backs")
    direct = audit["direct"]
    for surface in direct["surfaces"]:
        if surface["differs"]:
            faults.append("direct light on '{name}': {by_packets_W:.4g} W by packets, {by_shadow_rays_W:.4g} by shadow rays".format(**surface))
    if direct["zones_different"]:
        faults.append(f"direct light of {direct['zones_different']} zones")
    small = small_zones(solution)
    if not options.keep:
        solution.unlink()
    if small is None or not small[0] > 0:
        return faults, None
    packets, packets_error, gathered, gathered_error = small
    deviation = gathered * (1 + options.planted) / packets - 1
    error = numpy.hypot(packets_error, gathered_error) / packets
    if abs(deviation) > max(5 * error, 0.03):
        faults.append(f"small zones: {100 * deviation:+.1f} +- {100 * error:.1f} % by gathering")
    return faults, (deviation, error)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--seed", type=int, default=1, help="number of the first room")
    parser.add_argument("--count", type=int, default=30)
    parser.add_argument("--packets", type=int, default=2_000_000)
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the rooms and their solutions")
    parser.add_argument("--planted", type=float, default=0, help="share by which small zones are made brighter")
    options = parser.parse_args()
    program = str(pathlib.Path(options.program).resolve())
    with tempfile.TemporaryDirectory() as scratch:
        folder = options.keep or pathlib.Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        bad = 0
        deviations = []
        for number in range(options.seed, options.seed + options.count):
            faults, deviation = examine(program, number, folder, options)
            if deviation is not None:
                deviations.append(deviation)
            bad += bool(faults)
            small = "none" if deviation is None else f"{100 * deviation[0]:+.2f} +- {100 * deviation[1]:.2f} %"
            print(f"room {number}: small zones {small}" + "".join(f"\n  {fault}" for fault in faults), flush=True)
    if deviations:
        # No room alone decides: what reads zones differs a little from what packets do.
        values = numpy.array(deviations)
        weight = 1 / (values[:, 1] ** 2 + EVEN_WITHOUT_NOISE ** 2)
        mean = (weight * values[:, 0]).sum() / weight.sum()
        error = weight.sum() ** -0.5
        print(f"small zones of all rooms: {100 * mean:+.2f} +- {100 * error:.2f} % by gathering")
        bad += abs(mean) > max(4 * error, 0.01)
    print(f"{options.count} rooms, {bad} complaints")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
