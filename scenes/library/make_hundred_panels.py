#!/usr/bin/env python3
"""Writes hundred_panels.json: a yard at night with 100 rectangular luminaires, after Figure 9 of Shirley, Wang and
Zimmerman (1996). Their powers span five orders of magnitude, and from any place most of them are far away, behind a
wall or turned away. Needs nothing but the standard library.
"""
import json
import math
import pathlib
import random

FOLDER = pathlib.Path(__file__).parent

WIDTH, DEPTH = 40.0, 30.0  # [m] of the yard, x and z
# Free-standing walls (x and z from, to) that make four courts with passages between them.
WALL_HEIGHT = 4.0
WALLS = [((13.85, 0.6), (14.15, 22.0)), ((25.85, 8.0), (26.15, 29.4)), ((26.75, 14.85), (39.4, 15.15))]
EYES = [(16.5, 1.7, 26.5), (3.0, 1.7, 3.0), (37.0, 1.7, 27.0), (20.0, 6.5, 3.0)]
TARGETS = [(21.0, 1.2, 8.0), (11.0, 1.0, 22.0), (28.5, 1.2, 18.0), (20.0, 0.0, 20.0)]
CAMERA_NAMES = ["middle court", "west court", "south-east court", "from above"]

COLOURS = {
    "warm": [1.0, 0.85, 0.64], "cold": [0.86, 0.96, 1.14], "red": [1.0, 0.22, 0.12], "green": [0.25, 1.0, 0.45],
    "blue": [0.25, 0.45, 1.0],
}
# [cd/m2] of the panels in turn: weak ones are common, strong ones rare. The strong ones are white.
LUMINANCES = [30, 300, 30, 3000, 300, 30, 300, 3000, 30, 300, 3000, 20000]

rng = random.Random(1996)
taken = []  # (x, y, z, radius) of what stands already


def free(x, y, z, radius):
    return all(math.dist((x, y, z), t[:3]) > radius + t[3] for t in taken) and all(
        math.dist((x, y, z), eye) > radius + 2.5 for eye in EYES)


def clear_of_walls(x, z, radius):
    return all(not (a[0] - radius < x < b[0] + radius and a[1] - radius < z < b[1] + radius) for a, b in WALLS)


def rounded(values):
    return [round(v, 4) + 0.0 for v in values]


def box(name, low, high, **fields):
    return {"name": name, **fields, "box": {"min": rounded(low), "max": rounded(high)}}


def blocks():
    result = []
    while len(result) < 10:
        half = [rng.uniform(0.3, 1.2), rng.uniform(0.3, 1.5), rng.uniform(0.3, 1.2)]
        x, z = rng.uniform(2, WIDTH - 2), rng.uniform(2, DEPTH - 2)
        radius = math.hypot(*half)
        if not (free(x, half[1], z, radius) and clear_of_walls(x, z, radius)):
            continue
        taken.append((x, half[1], z, radius))
        block = box(f"block {len(result) + 1}", (-half[0], 0, -half[2]), (half[0], 2 * half[1], half[2]), material="block",
                    transform=[{"rotate": {"axis": [0, 1, 0], "angle_deg": round(rng.uniform(0, 90), 2)}},
                               {"translate": rounded((x, 0, z))}])
        block["box"]["open"] = ["y-"]
        result.append(block)
    return result


def panel_material(index):
    luminance = LUMINANCES[index % len(LUMINANCES)]
    colours = ["warm", "cold"] if luminance >= 3000 else list(COLOURS)
    return f"{rng.choice(colours)} {luminance}"


def panel(name, width, height, turn, place):
    """A flat box whose face towards +z is to emit before it is turned."""
    return box(name, (-width / 2, -height / 2, -0.03), (width / 2, height / 2, 0), material="housing", materials={},
               transform=turn + [{"translate": rounded(place)}])


def overhead(name):
    width, height = rng.uniform(0.2, 2.2), rng.uniform(0.2, 1.2)
    x, y, z = rng.uniform(1, WIDTH - 1), rng.uniform(4.5, 8), rng.uniform(1, DEPTH - 1)
    turn = [{"rotate": {"axis": [1, 0, 0], "angle_deg": 90}},
            {"rotate": {"axis": [0, 1, 0], "angle_deg": round(rng.uniform(0, 180), 2)}}]
    return (x, y, z, math.hypot(width, height) / 2), panel(name, width, height, turn, (x, y, z))


def sign(name):
    """On either side of a wall, 5 cm in front of it."""
    a, b = rng.choice(WALLS)
    width, height = rng.uniform(0.1, 1.6), rng.uniform(0.1, 0.9)
    along_z = b[1] - a[1] > b[0] - a[0]
    side = rng.choice([-1, 1])
    y = rng.uniform(0.8, WALL_HEIGHT - 0.6)
    if along_z:
        x = (b[0] if side > 0 else a[0]) + side * 0.08
        z, angle = rng.uniform(a[1] + 1, b[1] - 1), 90 * side
    else:
        x = rng.uniform(a[0] + 1, b[0] - 1)
        z, angle = (b[1] if side > 0 else a[1]) + side * 0.08, 0 if side > 0 else 180
    turn = [{"rotate": {"axis": [0, 1, 0], "angle_deg": angle}}]
    return (x, y, z, math.hypot(width, height) / 2), panel(name, width, height, turn, (x, y, z))


def low(name):
    width, height = rng.uniform(0.08, 0.5), rng.uniform(0.08, 0.3)
    x, y, z = rng.uniform(1, WIDTH - 1), rng.uniform(0.3, 1.2), rng.uniform(1, DEPTH - 1)
    turn = [{"rotate": {"axis": [0, 1, 0], "angle_deg": round(rng.uniform(0, 360), 2)}}]
    return (x, y, z, math.hypot(width, height) / 2), panel(name, width, height, turn, (x, y, z))


def panels():
    result = []
    for kind, count in ((overhead, 40), (sign, 40), (low, 20)):
        made = 0
        while made < count:
            place, made_panel = kind(f"{kind.__name__} {made + 1}")
            x, y, z, radius = place
            if not free(x, y, z, radius) or (kind is low and not clear_of_walls(x, z, radius + 0.05)):
                continue
            taken.append(place)
            made_panel["materials"]["z+"] = panel_material(len(result))
            result.append(made_panel)
            made += 1
    return result


def rows(items):
    return ",\n".join("    " + json.dumps(item) for item in items)


def main():
    materials = {"ground": {"reflectance": [0.30, 0.29, 0.27]}, "wall": {"reflectance": [0.62, 0.58, 0.52]},
                 "block": {"reflectance": [0.45, 0.46, 0.50]}, "housing": {"reflectance": 0.2}}
    objects = [{"name": "ground", "material": "ground",
                "quad": {"corner": [0, 0, 0], "u": [0, 0, DEPTH], "v": [WIDTH, 0, 0]}}]
    for i, (a, b) in enumerate(WALLS):
        wall = box(f"wall {i + 1}", (a[0], 0, a[1]), (b[0], WALL_HEIGHT, b[1]), material="wall")
        wall["box"]["open"] = ["y-"]
        objects.append(wall)
    objects += blocks() + panels()
    used = {o["materials"]["z+"] for o in objects if "materials" in o}
    for colour, spectrum in COLOURS.items():
        for luminance in sorted(set(LUMINANCES)):
            if f"{colour} {luminance}" in used:
                materials[f"{colour} {luminance}"] = {
                    "reflectance": 0.5, "luminance_cd_m2": luminance, "emission_color": spectrum}
    cameras = [{"name": n, "eye": e, "look_at": t, "vertical_fov_deg": 55, "size": [960, 640]}
               for n, e, t in zip(CAMERA_NAMES, EYES, TARGETS)]
    text = (
        "// A yard of 40 x 30 m at night with 100 rectangular luminaires of very different power, most of them far away,\n"
        "// behind a wall or turned away from any one place. Written by make_hundred_panels.py. y is up. Open to the sky.\n"
        '{\n  "format": "reemit-room",\n  "version": 1,\n  "name": "A hundred panels",\n  "bands": "rgb",\n'
        '  "materials": {\n'
        + ",\n".join(f"    {json.dumps(name)}: {json.dumps(m)}" for name, m in materials.items())
        + '\n  },\n  "objects": [\n' + rows(objects) + '\n  ],\n  "cameras": [\n' + rows(cameras) + "\n  ]\n}\n"
    )
    (FOLDER / "hundred_panels.json").write_text(text)


if __name__ == "__main__":
    main()
