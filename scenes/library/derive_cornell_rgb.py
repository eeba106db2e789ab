#!/usr/bin/env python3
"""Derives linear Rec.709 reflectances and the lamp colour of the Cornell box from its measured spectra.

docs/cornell_box.md has the formulas. Run it to print the numbers; make_cornell_boxes.py writes them into the rooms.
Needs nothing but the standard library.
"""
import bisect
import json
import pathlib

DATA = pathlib.Path(__file__).parent / "data" / "cornell_measured.json"
LAMP_LUMINANCE = 10000.0  # cd/m2, our choice: the published emission has no absolute scale
EFFICACY = 179.0  # lm/W of an RGB room
LUMINANCE_WEIGHTS = [0.2126, 1.0 - 0.2126 - 0.0722, 0.0722]


def interpolate(nm, value, at):
    """Linear between samples; 0 outside."""
    if at < nm[0] or at > nm[-1]:
        return 0.0
    i = min(bisect.bisect_right(nm, at), len(nm) - 1)
    t = (at - nm[i - 1]) / (nm[i] - nm[i - 1])
    return value[i - 1] + t * (value[i] - value[i - 1])


def integrate(*curves):
    """Integral of a product of curves, each linear between its samples, over their common range.

    Gauss-Legendre with three points between neighbouring samples of any curve is exact up to degree five.
    """
    knots = sorted({x for nm, _ in curves for x in nm})
    knots = [x for x in knots if all(nm[0] <= x <= nm[-1] for nm, _ in curves)]
    points = [(-0.6**0.5, 5 / 18), (0.0, 8 / 18), (0.6**0.5, 5 / 18)]
    total = 0.0
    for a, b in zip(knots, knots[1:]):
        for offset, weight in points:
            x = (a + b) / 2 + offset * (b - a) / 2
            product = 1.0
            for nm, value in curves:
                product *= interpolate(nm, value, x)
            total += weight * (b - a) * product
    return total


def multiply(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(len(b[0]))] for i in range(3)]


def apply(a, v):
    return [sum(a[i][k] * v[k] for k in range(3)) for i in range(3)]


def invert(m):
    (a, b, c), (d, e, f), (g, h, i) = m
    det = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
    return [
        [(e * i - f * h) / det, (c * h - b * i) / det, (b * f - c * e) / det],
        [(f * g - d * i) / det, (a * i - c * g) / det, (c * d - a * f) / det],
        [(d * h - e * g) / det, (b * g - a * h) / det, (a * e - b * d) / det],
    ]


def xyz_to_rec709():
    """From XYZ relative to equal-energy white: Bradford adaptation to D65, Rec.709 primaries, then the luminance
    that the adaptation loses is added as grey, so that the weights of Rec.709 give exactly Y."""
    def chromaticity(x, y):
        return [x / y, 1.0, (1 - x - y) / y]

    white = chromaticity(0.3127, 0.3290)
    columns = [chromaticity(0.64, 0.33), chromaticity(0.30, 0.60), chromaticity(0.15, 0.06)]
    primaries = [[columns[j][i] for j in range(3)] for i in range(3)]
    amounts = apply(invert(primaries), white)
    to_xyz = [[primaries[i][j] * amounts[j] for j in range(3)] for i in range(3)]
    cones = [[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]]
    source, target = apply(cones, [1.0, 1.0, 1.0]), apply(cones, white)
    gain = [[target[i] / source[i] if i == j else 0.0 for j in range(3)] for i in range(3)]
    adapted = multiply(invert(to_xyz), multiply(invert(cones), multiply(gain, cones)))
    luminance = [sum(LUMINANCE_WEIGHTS[i] * adapted[i][j] for i in range(3)) for j in range(3)]
    lost = [(1.0 if j == 1 else 0.0) - luminance[j] for j in range(3)]
    return [[adapted[i][j] + lost[j] for j in range(3)] for i in range(3)]


def load():
    return json.loads(DATA.read_text())


def colour(data, *curves):
    """Rec.709 colour of the lamp's light after the given reflectances, up to a scale."""
    lamp = (data["lamp"]["nm"], data["lamp"]["value"])
    cie = data["cie_1931"]
    xyz = [integrate(lamp, (cie["nm"], cie[axis]), *curves) for axis in "xyz"]
    return apply(xyz_to_rec709(), xyz)


def derive():
    """Reflectance per channel of each material, and the lamp's radiance in W/(sr m2)."""
    data = load()
    bare = colour(data)
    reflectance = {}
    for name in ("white", "green", "red"):
        reflected = colour(data, (data["reflectance"]["nm"], data["reflectance"][name]))
        reflectance[name] = [reflected[i] / bare[i] for i in range(3)]
    luminance = EFFICACY * sum(w * c for w, c in zip(LUMINANCE_WEIGHTS, bare))
    radiance = [c * LAMP_LUMINANCE / luminance for c in bare]
    return reflectance, radiance


if __name__ == "__main__":
    materials, lamp_radiance = derive()
    for material, rgb in materials.items():
        print(f"{material:6s} reflectance  " + "  ".join(f"{c:.4f}" for c in rgb))
    print("lamp   radiance     " + "  ".join(f"{c:.4f}" for c in lamp_radiance) + "  W/(sr m2)")
