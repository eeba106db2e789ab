#!/usr/bin/env python3
"""Writes the compressed rooms among the seeds, and the room that they are made from.

Usage: make_compressed_seeds.py FOLDER_OF_NODE_MODULES [OUTPUT_FOLDER]

The room (ball.glb: a white box, a lamp, a ball with normals and a texture) is made here; the encoders are those of
@gltf-transform/cli and gltfpack, installed by: npm install @gltf-transform/cli gltfpack. Their next versions may write other
bytes for the same room.
"""
import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

BALL_RINGS, BALL_SEGMENTS, BALL_RADIUS = 8, 12, 0.4


def png(side):
    """Squares of two colours."""
    rows = b"".join(b"\0" + b"".join(bytes([200, 40, 30] if (x // 4 + y // 4) % 2 else [60, 90, 180]) for x in range(side))
                    for y in range(side))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", side, side, 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


class Room:
    def __init__(self):
        self.binary = bytearray()
        self.json = {"asset": {"version": "2.0", "generator": "seed"}, "scene": 0, "scenes": [{"nodes": []}], "nodes": [], "meshes": [],
                     "materials": [], "accessors": [], "bufferViews": []}

    def view(self, data, **more):
        self.binary += b"\0" * (-len(self.binary) % 4)
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data), **more})
        self.binary += data
        return len(self.json["bufferViews"]) - 1

    def floats(self, rows):
        flat = [x for row in rows for x in row]
        accessor = {"bufferView": self.view(struct.pack(f"<{len(flat)}f", *flat), target=34962), "componentType": 5126,
                    "count": len(rows), "type": f"VEC{len(rows[0])}"}
        accessor.update(min=[min(column) for column in zip(*rows)], max=[max(column) for column in zip(*rows)])
        self.json["accessors"].append(accessor)
        return len(self.json["accessors"]) - 1

    def add(self, name, material, positions, normals, coordinates, faces):
        corners = [corner for face in faces for corner in face]
        view = self.view(struct.pack(f"<{len(corners)}H", *corners), target=34963)
        self.json["accessors"].append({"bufferView": view, "componentType": 5123, "count": len(corners), "type": "SCALAR"})
        indices = len(self.json["accessors"]) - 1
        attributes = {"POSITION": self.floats(positions), "NORMAL": self.floats(normals), "TEXCOORD_0": self.floats(coordinates)}
        self.json["meshes"].append({"primitives": [{"attributes": attributes, "indices": indices, "material": material}]})
        self.json["scenes"][0]["nodes"].append(len(self.json["nodes"]))
        self.json["nodes"].append({"name": name, "mesh": len(self.json["meshes"]) - 1})

    def glb(self):
        self.json["buffers"] = [{"byteLength": len(self.binary)}]
        text = json.dumps(self.json).encode()
        text += b" " * (-len(text) % 4)
        binary = bytes(self.binary) + b"\0" * (-len(self.binary) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def quad(corner, u, v):
    points = [corner, [c + a for c, a in zip(corner, u)], [c + a + b for c, a, b in zip(corner, u, v)], [c + b for c, b in zip(corner, v)]]
    normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    length = math.sqrt(sum(x * x for x in normal))
    return points, [[x / length for x in normal]] * 4


def box(room):
    positions, normals, coordinates, faces = [], [], [], []
    for corner, u, v in [([-1, -1, -1], [0, 0, 2], [2, 0, 0]), ([-1, 1, -1], [2, 0, 0], [0, 0, 2]), ([-1, -1, -1], [2, 0, 0], [0, 2, 0]),
                         ([-1, -1, 1], [0, 2, 0], [2, 0, 0]), ([-1, -1, -1], [0, 2, 0], [0, 0, 2]), ([1, -1, -1], [0, 0, 2], [0, 2, 0])]:
        first = len(positions)
        points, across = quad(corner, u, v)
        positions += points
        normals += across
        coordinates += [[0, 0], [1, 0], [1, 1], [0, 1]]
        faces += [[first, first + 1, first + 2], [first, first + 2, first + 3]]
    room.add("box", 0, positions, normals, coordinates, faces)


def ball(room):
    positions, normals, coordinates, faces = [], [], [], []
    for ring in range(BALL_RINGS + 1):
        for segment in range(BALL_SEGMENTS + 1):
            polar, azimuth = math.pi * ring / BALL_RINGS, 2 * math.pi * segment / BALL_SEGMENTS
            out = [math.sin(polar) * math.cos(azimuth), math.cos(polar), -math.sin(polar) * math.sin(azimuth)]
            normals.append(out)
            positions.append([BALL_RADIUS * x for x in out])
            coordinates.append([segment / BALL_SEGMENTS, ring / BALL_RINGS])
    row = BALL_SEGMENTS + 1
    for ring in range(BALL_RINGS):
        for segment in range(BALL_SEGMENTS):
            a = ring * row + segment
            if ring > 0:
                faces.append([a, a + row + 1, a + 1])
            if ring < BALL_RINGS - 1:
                faces.append([a, a + row, a + row + 1])
    room.add("ball", 2, positions, normals, coordinates, faces)


def make_room():
    room = Room()
    room.json["materials"] = [
        {"name": "white", "doubleSided": True, "pbrMetallicRoughness": {"baseColorFactor": [0.7, 0.7, 0.7, 1], "metallicFactor": 0}},
        {"name": "lamp", "pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.8, 0.8, 1], "metallicFactor": 0},
         "emissiveFactor": [1, 0.9, 0.7], "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 2000}}},
        {"name": "checks", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0}}]
    room.json["extensionsUsed"] = ["KHR_materials_emissive_strength"]
    room.json["textures"] = [{"source": 0}]
    box(room)
    room.add("lamp", 1, *quad([-0.3, 0.95, -0.3], [0.6, 0, 0], [0, 0, 0.6]), [[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1, 2], [0, 2, 3]])
    ball(room)
    room.json["images"] = [{"bufferView": room.view(png(16)), "mimeType": "image/png"}]
    return room.glb()


def main(modules, output):
    programs = pathlib.Path(modules) / ".bin"
    output = pathlib.Path(output)
    with tempfile.TemporaryDirectory() as folder:
        plain = pathlib.Path(folder) / "ball.glb"
        plain.write_bytes(make_room())

        def run(program, *arguments):
            subprocess.run([programs / program, *arguments], check=True, stdout=subprocess.DEVNULL)

        run("gltf-transform", "draco", plain, output / "ball_draco.glb")
        run("gltf-transform", "draco", plain, output / "ball_draco_sequential.glb", "--method", "sequential")
        run("gltf-transform", "meshopt", plain, output / "ball_meshopt.glb")
        run("gltf-transform", "webp", plain, output / "ball_webp.glb", "--lossless", "true")
        run("gltfpack", "-i", plain, "-o", output / "ball_packed.gltf", "-cc", "-kn", "-km", "-vpf")
        (output / "ball.glb").write_bytes(plain.read_bytes())


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2] if len(sys.argv) == 3 else pathlib.Path(__file__).parent / "seeds")
