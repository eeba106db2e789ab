#!/usr/bin/env python3
"""Writes sphereflake.json and sphereflake_one_lamp.json.

The sphereflake is the one of the Standard Procedural Databases by Eric Haines: a sphere carries nine of a third of its
radius, six around its equator and three above, each of which carries nine again. With four generations these are
1 + 9 + 81 + 729 + 6561 = 7381 spheres. Needs nothing but the standard library.
"""
import math
import pathlib

FOLDER = pathlib.Path(__file__).parent

GENERATIONS = 4
RADIUS = 0.25  # [m] of the first sphere; the flake stays within twice that.
FLUX = 4000  # [lm] of all luminaires together
# Every generation has the same area. The first two are dim, so that they show what falls on them.
SHARES = [0.02, 0.08, 0.30, 0.30, 0.30]
COLOURS = [[1.0, 0.75, 0.5], [1.0, 0.8, 0.55], [1.0, 0.87, 0.7], [1.0, 0.95, 0.88], [0.92, 0.97, 1.1]]

UPPER = math.degrees(math.asin(1 / math.sqrt(3)))  # from the pole; all neighbours are 60 degrees apart

CAMERAS = """\
    {"name": "flake", "eye": [1.1, 1.35, 1.9], "look_at": [0, 0.72, 0], "vertical_fov_deg": 32, "size": [800, 800]},
    {"name": "floor", "eye": [-2.4, 1.5, 2.4], "look_at": [0, 0.45, 0], "vertical_fov_deg": 40, "size": [960, 640]},
    {"name": "close", "eye": [0.55, 1.25, 0.62], "look_at": [0.05, 0.9, 0.05], "vertical_fov_deg": 40, "size": [800, 800]},
    {"name": "from above", "eye": [0.2, 2.9, 0.9], "look_at": [0, 0.5, 0], "vertical_fov_deg": 45, "size": [800, 800]}
"""


def number(value):
    return f"{value:.10g}"


def child(name, angle, count):
    """Children at this angle from the pole, all the way around."""
    first = 30 if count == 6 else 0
    steps = [
        f'{{"scale": {number(1 / 3)}}}',
        f'{{"translate": [0, {number(4 / 3)}, 0]}}',
        f'{{"rotate": {{"axis": [0, 0, 1], "angle_deg": {number(-angle)}}}}}',
    ]
    if first:
        steps.append(f'{{"rotate": {{"axis": [0, 1, 0], "angle_deg": {first}}}}}')
    around = f'{{"count": {count}, "rotate": {{"axis": [0, 1, 0], "angle_deg": {360 // count}}}}}'
    where = "beside" if count == 6 else "above"
    return f'{{"name": "{where}", "group": "{name}", "transform": [{", ".join(steps)}], "array": {around}}}'


def groups():
    """From the last generation to the first: a group may use those before it."""
    lines = []
    for generation in range(GENERATIONS, -1, -1):
        parts = [f'{{"name": "ball", "material": "generation {generation}", "sphere": {{"center": [0, 0, 0], "radius": 1}}}}']
        if generation < GENERATIONS:
            below = f"flake {generation + 1}"
            parts += [child(below, 90, 6), child(below, UPPER, 3)]
        lines.append(f'    "flake {generation}": [\n      ' + ",\n      ".join(parts) + "\n    ]")
    return ",\n".join(lines) + "\n"


def materials(flux_of):
    lines = ['    "floor": {"reflectance": 0.5}']
    for generation in range(GENERATIONS + 1):
        flux, colour = flux_of(generation)
        light = f', "total_flux_lm": {number(flux)}, "emission_color": {colour}' if flux > 0 else ""
        lines.append(f'    "generation {generation}": {{"reflectance": 0.5{light}}}')
    return ",\n".join(lines) + "\n"


def write(file, name, remark, flux_of):
    text = (
        f"// {remark}\n// Written by make_sphereflake.py. y is up. Open: there is a floor and nothing else.\n"
        "{\n"
        f'  "format": "reemit-room",\n  "version": 1,\n  "name": "{name}",\n  "bands": "rgb",\n'
        '  "materials": {\n' + materials(flux_of) + "  },\n"
        '  "groups": {\n' + groups() + "  },\n"
        '  "objects": [\n'
        '    {"name": "floor", "material": "floor", "quad": {"corner": [-3, 0, -3], "u": [0, 0, 6], "v": [6, 0, 0]}},\n'
        f'    {{"name": "flake", "group": "flake 0", "transform": [{{"scale": {RADIUS}}}, {{"translate": [0, 0.75, 0]}}]}}\n'
        "  ],\n"
        '  "cameras": [\n' + CAMERAS + "  ]\n}\n"
    )
    (FOLDER / file).write_text(text)


if __name__ == "__main__":
    write("sphereflake.json", "Sphereflake", "7381 spheres, every one a luminaire.",
          lambda generation: (FLUX * SHARES[generation], COLOURS[generation]))
    write("sphereflake_one_lamp.json", "Sphereflake with one lamp",
          "7381 spheres; the first and largest alone is a luminaire and has the power that sphereflake.json spreads over all.",
          lambda generation: (FLUX if generation == 0 else 0, [1.0, 0.92, 0.8]))
