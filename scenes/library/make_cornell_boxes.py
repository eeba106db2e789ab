#!/usr/bin/env python3
"""Writes cornell_box.json, cornell_box_empty.json and cornell_box_spectral.json from the published data.

Needs nothing but the standard library; docs/cornell_box.md says what the rooms are.
"""
import pathlib

import derive_cornell_rgb

FOLDER = pathlib.Path(__file__).parent

# Vertices in mm as published; every face is seen from its front.
WALLS = [
    ("floor", "white", [(552.8, 0, 0), (0, 0, 0), (0, 0, 559.2), (549.6, 0, 559.2)]),
    ("back wall", "white", [(549.6, 0, 559.2), (0, 0, 559.2), (0, 548.8, 559.2), (556, 548.8, 559.2)]),
    ("right wall", "green", [(0, 0, 559.2), (0, 0, 0), (0, 548.8, 0), (0, 548.8, 559.2)]),
    ("left wall", "red", [(552.8, 0, 0), (549.6, 0, 559.2), (556, 548.8, 559.2), (556, 548.8, 0)]),
]
CEILING = [(556, 548.8, 0), (556, 548.8, 559.2), (0, 548.8, 559.2), (0, 548.8, 0)]
LAMP = [(343, 548.8, 227), (343, 548.8, 332), (213, 548.8, 332), (213, 548.8, 227)]
BLOCKS = {
    "short block": [
        [(130, 165, 65), (82, 165, 225), (240, 165, 272), (290, 165, 114)],
        [(290, 0, 114), (290, 165, 114), (240, 165, 272), (240, 0, 272)],
        [(130, 0, 65), (130, 165, 65), (290, 165, 114), (290, 0, 114)],
        [(82, 0, 225), (82, 165, 225), (130, 165, 65), (130, 0, 65)],
        [(240, 0, 272), (240, 165, 272), (82, 165, 225), (82, 0, 225)],
    ],
    "tall block": [
        [(423, 330, 247), (265, 330, 296), (314, 330, 456), (472, 330, 406)],
        [(423, 0, 247), (423, 330, 247), (472, 330, 406), (472, 0, 406)],
        [(472, 0, 406), (472, 330, 406), (314, 330, 456), (314, 0, 456)],
        [(314, 0, 456), (314, 330, 456), (265, 330, 296), (265, 0, 296)],
        [(265, 0, 296), (265, 330, 296), (423, 330, 247), (423, 0, 247)],
    ],
}
CAMERAS = """\
    // As published: 35 mm lens, 25 mm square film, that is 2 atan(12.5/35).
    {"name": "published", "eye": [278, 273, -800], "look_at": [278, 273, 0], "vertical_fov_deg": 39.3076, "size": [512, 512]},
    {"name": "front", "eye": [278, 273, 20], "look_at": [278, 250, 559], "vertical_fov_deg": 75, "size": [512, 512]},
    {"name": "red wall", "eye": [40, 300, 60], "look_at": [552, 200, 330], "vertical_fov_deg": 65, "size": [512, 384]},
    {"name": "green wall", "eye": [510, 300, 60], "look_at": [0, 200, 330], "vertical_fov_deg": 65, "size": [512, 384]},
    {"name": "corner above", "eye": [30, 520, 30], "look_at": [380, 60, 400], "vertical_fov_deg": 70, "size": [512, 384]}
"""


def points(loop):
    return "[" + ", ".join("[%s]" % ", ".join(f"{c:g}" for c in p) for p in loop) + "]"


def wrapped(values, indent=8, width=108):
    """A long array of numbers over several lines."""
    lines, line = [], ""
    for i, value in enumerate(values):
        word = f"{value:g}" + ("," if i + 1 < len(values) else "")
        if len(line) + 1 + len(word) > width - indent:
            lines.append(line)
            line = word
        else:
            line = f"{line} {word}".strip()
    lines.append(line)
    return "[" + ("\n" + " " * indent).join(lines) + "]"


def rgb_materials():
    reflectance, radiance = derive_cornell_rgb.derive()
    lines = []
    for name, rgb in reflectance.items():
        lines.append(f'    "{name}": {{"reflectance": [' + ", ".join(f"{c:.4f}" for c in rgb) + "]}")
    lines.append('    "lamp": {"reflectance": 0.78, "radiance": [' + ", ".join(f"{c:.4f}" for c in radiance) + "]}")
    return ",\n".join(lines) + "\n"


def spectral_materials():
    data = derive_cornell_rgb.load()
    lines = []
    for name in ("white", "green", "red"):
        lines.append(
            f'    "{name}": {{"reflectance": {{\n'
            f'      "nm": {wrapped(data["reflectance"]["nm"])},\n'
            f'      "value": {wrapped(data["reflectance"][name])}}}}}'
        )
    lamp = data["lamp"]
    lines.append(
        f'    "lamp": {{"reflectance": 0.78, "luminance_cd_m2": {derive_cornell_rgb.LAMP_LUMINANCE:g},\n'
        f'      "emission_color": {{"nm": {wrapped(lamp["nm"])}, "value": {wrapped(lamp["value"])}}}}}'
    )
    return ",\n".join(lines) + "\n"


def objects(with_blocks):
    lines = [f'    {{"name": "{n}", "material": "{m}", "polygon": {{"vertices": {points(v)}}}}}' for n, m, v in WALLS]
    lines.append("    // The lamp fills a hole of its own size, so that no two faces share a plane.")
    lines[-1] += (
        f'\n    {{"name": "ceiling", "material": "white", "polygon": {{\n      "vertices": {points(CEILING)},\n'
        f'      "holes": [{points(LAMP)}]}}}}'
    )
    lines.append(f'    {{"name": "lamp", "material": "lamp", "polygon": {{"vertices": {points(LAMP)}}}}}')
    for name, faces in BLOCKS.items() if with_blocks else ():
        corners = list(dict.fromkeys(p for face in faces for p in face))
        loops = [[corners.index(p) for p in face] for face in faces]
        lines.append(
            f'    {{"name": "{name}", "material": "white", "mesh": {{\n      "vertices": {points(corners)},\n'
            f'      "faces": {loops}}}}}'
        )
    return ",\n".join(lines) + "\n"


def write(file, title, remark, bands, materials, with_blocks):
    text = (
        f"// {remark}\n// Written by make_cornell_boxes.py; docs/cornell_box.md has the derivation. The front is open.\n"
        "{\n"
        '  "format": "reemit-room",\n  "version": 1,\n'
        f'  "name": "{title}",\n  "unit": "mm",\n  "bands": {bands},\n'
        '  "materials": {\n' + materials + "  },\n"
        '  "objects": [\n' + objects(with_blocks) + "  ],\n"
        '  "cameras": [\n' + CAMERAS + "  ]\n}\n"
    )
    (FOLDER / file).write_text(text)


if __name__ == "__main__":
    BAND_CENTRES = [410 + 20 * i for i in range(15)]  # 15 bands of 20 nm that tile the measured 400 ... 700 nm
    write("cornell_box.json", "Cornell box", "The Cornell box with both blocks, RGB.", '"rgb"', rgb_materials(), True)
    write("cornell_box_empty.json", "Empty Cornell box", "The Cornell box without blocks, RGB.", '"rgb"',
          rgb_materials(), False)
    write("cornell_box_spectral.json", "Spectral Cornell box",
          "The Cornell box with both blocks in 15 spectral bands, straight from the measured spectra.",
          '{"wavelengths_nm": ' + wrapped(BAND_CENTRES) + "}", spectral_materials(), True)
