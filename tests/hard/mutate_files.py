#!/usr/bin/env python3
"""Feeds damaged copies of rooms and solutions to reemit and checks how it ends.

Usage: mutate_files.py PROGRAM [--seed N] [--count N] [--only N] [--keep FOLDER] [--limit SECONDS] [--as-given]
                       [--reseal] [--verbose] FILES...
       mutate_files.py --self-test

FILES are rooms (.json .mgf .obj .gltf .glb), parts of rooms that are put into a small one (.ies .ldt .ply .mtl),
solutions (.h5), and folders of these. Files that a file mentions are copied with it, and damaged like it. Each .gltf
is tried as .glb too. Without an .h5 among FILES, the first room that can be solved is solved, and its solution joins them.
The same seed, count and files give the same damage; --only N repeats one case.

What must hold of every run stands in judge_runs.py, which looks at it.
--verbose lists refusals that name no place in the file (line, JSON pointer, or what carries a name).
Exit code 0: all of this held; 1: it did not; the files are kept aside, with a command that repeats it.
"""
import argparse
import copy
import json
import os
import pathlib
import random
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True  # the module beside this file leaves nothing in the source tree
from judge_runs import SEAL_BYTES, Checker, new_folder, print_summary, seal_of, try_case

try:
    import h5py
except ImportError:
    h5py = None  # solutions are then damaged byte by byte only

ROOMS = {".json", ".mgf", ".obj", ".gltf", ".glb"}
PARTS = {".ies", ".ldt", ".ply", ".mtl"}
BINARY = {".glb", ".bin", ".h5", ".hdf5", ".png", ".jpg", ".tga"}
NUMBERS = ["nan", "inf", "-inf", "1e308", "-1e308", "1e999", "1e-320", "-0", "0", "-1", "1", "2", "7", "1e10", "1.1e10", "1e19",
           "1e-12", "0.9999999999", "4294967295", "4294967296", "2147483648", "-2147483649", "99999999999999999999",
           "18446744073709551616", "0x10", "1,5", "1e", "--1", ".", "1.5.2", "+3", "100000", "1e5"]
WORDS = ["", "a", "null", "true", "NaN", "=", "-", "#", "\\", "\"", "[", "]", "{", "}", ",", "/", "//", "/*", "\u00e9", "\u4e2d",
         "..", "../..", "/dev/zero", "/etc/passwd", "%s%n", "a" * 5000]
VALUES = [None, True, "", "a", [], {}, [[]], [{}], -1, 0, 1, 2, 0.5, 1e308, -1e308, 1e-320, 1e19, 1e10, 4294967296, 2147483648,
          -2147483649, 99999, [0, 0, 0], [1, 2], [1e308, 1e308, -1e308], "../../etc/passwd", "a" * 5000]


# ---------------------------------------------------------------- files and what they mention

def mentioned(file):
    """Files beside `file` whose names stand in it."""
    try:
        text = file.read_bytes().decode("latin-1")
    except OSError:
        return []
    found = []
    if file.suffix.lower() in BINARY and file.suffix.lower() != ".glb":
        return []
    for word in set(re.findall(r"[^\s\"',:;<>|()\[\]{}=]+\.\w+", text)):
        path = file.parent / word.replace("\\", "/")
        try:
            inside = path.resolve().is_relative_to(file.parent.resolve())
            if inside and path.is_file() and path != file:
                found.append(path)
        except (OSError, ValueError):
            pass
    return sorted(found)


class Seed:
    """A room or solution, as bytes by name relative to its folder; the first one is given to the program."""

    def __init__(self, main, parts):
        self.main, self.parts = main, parts

    @staticmethod
    def of(file):
        file = file.resolve()
        if file.suffix.lower() in PARTS:
            return Seed.around(file)
        open_files, parts = [file], {}
        while open_files and len(parts) < 40:
            next_file = open_files.pop(0)
            name = str(next_file.relative_to(file.parent))
            if name not in parts:
                parts[name] = next_file.read_bytes()
                open_files += mentioned(next_file)
        beside = file.parent / "camera.txt"
        if file.suffix.lower() == ".obj" and beside.is_file():
            parts["camera.txt"] = beside.read_bytes()
        return Seed(file.name, parts)

    @staticmethod
    def around(file):
        """A small room that holds `file`."""
        name, kind = file.name, file.suffix.lower()
        room = {"format": "reemit-room", "version": 1, "bands": "rgb",
                "materials": {"white": {"reflectance": 0.5}, "lamp": {"radiance": 5}},
                "objects": [{"material": "white", "box": {"min": [-2, 0, -2], "max": [2, 3, 2], "inward": True}},
                            {"material": "lamp", "quad": {"corner": [0, 2.9, 0], "u": [0.3, 0, 0], "v": [0, 0, 0.3]}}]}
        if kind in (".ies", ".ldt"):
            room["lights"] = [{"type": "ies", "file": name, "position": [0, 2.5, 0]}]
        elif kind == ".ply":
            room["objects"].append({"material": "white", "file": {"path": name}})
        else:
            names = re.findall(r"^\s*newmtl\s+(\S+)", file.read_bytes().decode("latin-1"), re.MULTILINE)
            obj = f"mtllib {name}\nv 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 0 1 0\nv 1 1 0\nv 1 1 1\nv 0 1 1\n"
            for i, material in enumerate(names[:6] or ["x"]):
                obj += f"usemtl {material}\nf {['1 4 3 2', '5 6 7 8', '1 2 6 5', '2 3 7 6', '3 4 8 7', '4 1 5 8'][i]}\n"
            return Seed("around.obj", {"around.obj": obj.encode(), name: file.read_bytes()})
        return Seed("around.json", {"around.json": json.dumps(room, indent=1).encode(), name: file.read_bytes()})

    def as_glb(self):
        """The .gltf file with its first buffer inside; None if it has none beside it."""
        document = json.loads(self.parts[self.main])
        buffers = document.get("buffers", [])
        if not buffers or buffers[0].get("uri") not in self.parts:
            return None
        parts = dict(self.parts)
        binary = parts.pop(buffers[0].pop("uri"))
        del parts[self.main]
        main = pathlib.Path(self.main).stem + ".glb"
        return Seed(main, {main: glb_of(json.dumps(document).encode(), binary), **parts})


def glb_of(text, binary):
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def split_glb(data):
    if len(data) < 20 or data[:4] != b"glTF":
        return None
    length = struct.unpack_from("<I", data, 12)[0]
    return data[20:20 + length], data[28 + length:]


# ---------------------------------------------------------------- damage

class Damage:
    """One case: changes the parts of a seed and says in words what it did."""

    def __init__(self, seed, number, numbered_seed, reseal):
        self.random = random.Random(f"{numbered_seed}:{number}:{seed.main}")
        self.seed, self.reseal = seed, reseal
        self.parts = dict(seed.parts)
        self.odd = {}  # name: a folder, a pipe, a device in place of the file
        self.words = []

    def apply(self):
        for _ in range(self.random.choice([1, 1, 1, 2, 3])):
            names = sorted(self.parts)
            name = self.seed.main if self.random.random() < 0.55 else self.random.choice(names)
            how = self.random.random()
            if how < 0.03:
                self.replace(name)
            elif name.lower().endswith((".h5", ".hdf5")):
                self.change_solution(name)
            elif name.lower().endswith(".glb") and how < 0.7 and split_glb(self.parts[name]):
                text, binary = split_glb(self.parts[name])
                if self.random.random() < 0.6:
                    text = self.changed_json(text)
                else:
                    binary = self.changed_bytes(binary)
                self.parts[name] = glb_of(text, binary)
            elif pathlib.Path(name).suffix.lower() in BINARY:
                self.parts[name] = self.changed_bytes(self.parts[name])
            elif name.lower().endswith((".json", ".gltf")) and how < 0.6:
                self.parts[name] = self.changed_json(self.parts[name])
            elif how < 0.72:
                self.parts[name] = self.changed_tokens(self.parts[name])
            elif how < 0.82:
                self.parts[name] = self.changed_lines(self.parts[name])
            elif how < 0.92:
                self.parts[name] = self.recoded(self.parts[name])
            else:
                self.parts[name] = self.changed_bytes(self.parts[name])
            self.words[-1] = f"{name}: {self.words[-1]}"

    def names(self):
        return list(self.parts)

    def write(self, folder):
        for name, data in self.parts.items():
            file = folder / name
            file.parent.mkdir(parents=True, exist_ok=True)
            kind = self.odd.get(name)
            if kind is None:
                file.write_bytes(data)
            elif kind == "folder":
                file.mkdir()
            elif kind == "pipe":
                os.mkfifo(file)
            elif kind == "device":
                file.symlink_to("/dev/zero")
            elif kind == "loop":
                file.symlink_to(file.name)

    def say(self, words):
        self.words.append(words)

    def replace(self, name):
        kind = self.random.choice(["empty", "missing", "folder", "pipe", "device", "other", "loop"])
        self.say(f"replaced: {kind}")
        if kind == "empty":
            self.parts[name] = b""
        elif kind == "other":
            self.parts[name] = self.parts[self.random.choice(sorted(self.parts))]
        else:
            self.odd[name] = kind

    def changed_bytes(self, data):
        kind = self.random.choice(["flip", "set", "word", "cut", "insert", "erase", "repeat", "append", "noise"])
        self.say(f"bytes {kind}")
        data = bytearray(data)
        if not data:
            return b"\0"
        at = self.random.randrange(len(data))
        if kind == "flip":
            for _ in range(self.random.choice([1, 1, 4, 16])):
                data[self.random.randrange(len(data))] ^= 1 << self.random.randrange(8)
        elif kind == "set":
            data[at] = self.random.choice([0, 10, 13, 32, 255, self.random.randrange(256)])
        elif kind == "word":
            at -= at % 4
            data[at:at + 4] = self.random.choice([b"\xff\xff\xff\xff", b"\xff\xff\xff\x7f", b"\0\0\xc0\x7f", b"\0\0\x80\x7f",
                                                  b"\0\0\0\0", b"\xff\xff\x7f\x7f", b"\1\0\0\0", b"\0\0\0\x80"])
        elif kind == "cut":
            del data[at:]
        elif kind == "insert":
            data[at:at] = self.random.randbytes(self.random.choice([1, 2, 4, 40]))
        elif kind == "erase":
            del data[at:at + self.random.choice([1, 2, 4, 40])]
        elif kind == "repeat":
            data[at:at] = data[at:at + self.random.choice([8, 100])] * self.random.choice([2, 50, 1000])
        elif kind == "append":
            data += self.random.randbytes(self.random.choice([1, 4, 4000]))
        else:
            data[at:at + 64] = self.random.randbytes(64)
        return bytes(data)

    def odd_number(self, old, crude=True):
        """Another number: an extreme one, or one that puts things nearly or exactly upon each other."""
        try:
            value = float(old)
        except ValueError:
            value = 1.0
        if crude and self.random.random() < 0.5:
            return self.random.choice(NUMBERS)
        change = self.random.choice([lambda v: -v, lambda v: v * (1 + 1e-12), lambda v: v + 1e-9, lambda v: v - 1e-6, lambda v: v * 10,
                                     lambda v: v / 10, lambda v: v + 1, lambda v: v * 1e4, lambda v: v * 1e-4, lambda v: round(v)])
        return repr(change(value))

    def changed_tokens(self, data):
        text = data.decode("latin-1")
        tokens = re.findall(r"[-+]?\.?\d[\w.+-]*|\w+|\s+|.", text, re.DOTALL)
        places = [i for i, token in enumerate(tokens) if not token.isspace()]
        if not places:
            return data + b"x"
        at, other = self.random.choice(places), self.random.choice(places)
        numbers = [i for i in places if re.match(r"[-+]?\.?\d", tokens[i])]
        kind = self.random.choice(["number"] * 6 + ["swap", "swap", "twice", "remove", "word", "copy", "many"])
        if kind == "number" and numbers:
            at = self.random.choice(numbers)
            new = self.odd_number(tokens[at])
            self.say(f"token {at} {tokens[at][:20]!r} -> {new!r}")
            tokens[at] = new
            return "".join(tokens).encode("latin-1")
        self.say(f"token {kind} {tokens[at][:20]!r}")
        if kind == "swap":
            tokens[at], tokens[other] = tokens[other], tokens[at]
        elif kind == "twice":
            tokens[at] += " " + tokens[at]
        elif kind == "remove":
            tokens[at] = ""
        elif kind == "copy":
            tokens[at] = tokens[other]
        elif kind == "many":
            tokens[at] = (tokens[at] + " ") * self.random.choice([10, 1000, 50000])
        else:
            tokens[at] = self.random.choice(WORDS)
        return "".join(tokens).encode("utf-8" if any(ord(c) > 255 for c in tokens[at]) else "latin-1")

    def changed_lines(self, data):
        lines = data.splitlines(keepends=True) or [b"\n"]
        kind = self.random.choice(["twice", "remove", "swap", "many", "include", "cut", "reverse", "block"])
        self.say(f"line {kind}")
        at, other = self.random.randrange(len(lines)), self.random.randrange(len(lines))
        if kind == "twice":
            lines.insert(other, lines[at])
        elif kind == "remove":
            del lines[at]
        elif kind == "swap":
            lines[at], lines[other] = lines[other], lines[at]
        elif kind == "many":
            lines[at:at + 1] = [lines[at]] * self.random.choice([10, 500, 5000])
        elif kind == "include":
            name = self.random.choice(sorted(self.seed.parts)).encode()
            lines.insert(at, self.random.choice([b"i %s\n", b"i %s -a 100 -t 1 0 0\n", b"mtllib %s\n", b"ies %s -a 50 -t .1 0 0\n",
                                                 b"xf -a 1000 -t 1 0 0 -a 1000 -rz 3 # %s\n", b"o %s\n", b"xf -s 0 # %s\n",
                                                 b"xf -rx 90 # %s\n", b"usemtl %s\n", b"TILT=%s\n"]) % name)
            if self.random.random() < 0.3:
                lines[at:at + 1] = [lines[at]] * 3000
        elif kind == "cut":
            del lines[at:]
        elif kind == "reverse":
            lines[min(at, other):max(at, other)] = reversed(lines[min(at, other):max(at, other)])
        else:
            lines[at:at] = lines[other:other + 12]
        return b"".join(lines)

    def recoded(self, data):
        kind = self.random.choice(["bom", "utf-16", "crlf", "cr", "nul", "latin-1", "bad utf-8", "no end", "ctrl-z", "tabs", "nested"])
        self.say(f"coded {kind}")
        at = self.random.randrange(len(data) + 1)
        if kind == "bom":
            return b"\xef\xbb\xbf" + data
        if kind == "utf-16":
            return data.decode("latin-1").encode("utf-16")
        if kind == "crlf":
            return data.replace(b"\n", b"\r\n")
        if kind == "cr":
            return data.replace(b"\n", b"\r")
        if kind == "no end":
            return data.rstrip()
        if kind == "ctrl-z":
            return data + b"\x1a"
        if kind == "tabs":
            return data.replace(b" ", b"\t \v")
        if kind == "nested":
            return data[:at] + self.random.choice([b"[", b"{\"a\":", b"(", b"\nxf -t 0 0 1\n", b"\no x\n"]) * \
                self.random.choice([60, 70, 3000, 200000]) + data[at:]
        return data[:at] + {"nul": b"\0", "latin-1": b"\xe9", "bad utf-8": b"\xc3\x28\xff\xfe\xed\xa0\x80"}[kind] + data[at:]

    def changed_json(self, data):
        try:
            document = json.loads(re.sub(r"^\s*//.*$", "", data.decode(), flags=re.MULTILINE))
        except (ValueError, UnicodeDecodeError):
            return self.changed_tokens(data)
        places = []

        def walk(value, path):
            items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else []
            for key, item in items:
                places.append((value, key, f"{path}/{key}"))
                walk(item, f"{path}/{key}")
        walk(document, "")
        if not places:
            return b"[]"
        holder, key, path = self.random.choice(places)
        numeric = [p for p in places if isinstance(p[0][p[1]], (int, float)) and not isinstance(p[0][p[1]], bool)]
        kind = self.random.choice(["number"] * 5 + ["value"] * 3 + ["remove", "copy", "copy", "swap", "longer", "shorter", "name"])
        if kind == "number" and numeric:
            holder, key, path = self.random.choice(numeric)
            numbers = [v for v in VALUES if isinstance(v, (int, float))] + [float("nan"), float("inf")]
            new = self.random.choice(numbers) if self.random.random() < 0.5 else float(self.odd_number(str(holder[key]), False))
            new = int(new) if isinstance(holder[key], int) and abs(new) < 1e15 and new == int(new) else new
            self.say(f"{path} {holder[key]} -> {new}")
            holder[key] = new
        elif kind == "remove":
            self.say(f"{path} removed")
            del holder[key]
        elif kind in ("copy", "swap"):
            other = self.random.choice(places)
            self.say(f"{path} {kind} {other[2]}")
            mine, its = copy.deepcopy(holder[key]), copy.deepcopy(other[0][other[1]])
            holder[key] = its
            if kind == "swap" and not other[2].startswith(path) and not path.startswith(other[2]):
                other[0][other[1]] = mine
        elif kind in ("longer", "shorter") and isinstance(holder, list):
            times = self.random.choice([2, 10, 2000])
            self.say(f"{path} {kind} {times}")
            if kind == "longer":
                holder[key:key] = [copy.deepcopy(holder[key])] * times
            else:
                del holder[key:]
        elif kind == "name" and isinstance(holder, dict):
            new = self.random.choice(["", "a", "name", "type", "extensions", "\u4e2d", key + "x"])
            self.say(f"{path} renamed {new!r}")
            holder[new] = holder.pop(key)
        else:
            new = copy.deepcopy(self.random.choice(VALUES))
            self.say(f"{path} -> {str(new)[:40]}")
            holder[key] = new
        return json.dumps(document, indent=1).encode()

    def change_solution(self, name):
        """Values, under a seal that fits; or bytes, whose seal fits only if that was asked for."""
        data = self.parts[name]
        if h5py and self.random.random() < 0.6:
            body = self.changed_values(data[:-SEAL_BYTES])
            self.parts[name] = body + seal_of(body)
            return
        body = self.changed_bytes(data[:-SEAL_BYTES] if self.random.random() < 0.9 else data)
        sealed = self.reseal and self.random.random() < 0.8
        self.words[-1] += ", sealed" if sealed else ""
        self.parts[name] = body + (seal_of(body) if sealed else data[-SEAL_BYTES:])


    def changed_values(self, body):
        """One dataset or attribute of an HDF5 file is changed, removed, or given another shape or type."""
        with tempfile.TemporaryDirectory() as scratch:
            file = pathlib.Path(scratch) / "solution.h5"
            file.write_bytes(body)
            try:
                self.change_open_file(file)
            except (OSError, RuntimeError, KeyError, ValueError, TypeError) as error:
                # It was damaged before, or HDF5 does not take the value.
                self.say(f"left as it was: {str(error)[:60]}")
                return body
            return file.read_bytes()

    def change_open_file(self, file):
        with h5py.File(file, "r+") as h5:
            places, groups = [], [h5]

            def note(path, item):
                if isinstance(item, h5py.Dataset):
                    places.append((item.parent, path, item))
                else:
                    groups.append(item)
            h5.visititems(note)
            attributes = [(group, name) for group in groups for name in group.attrs]
            if self.random.random() < 0.35:
                self.change_attribute(*self.random.choice(attributes))
            else:
                self.change_dataset(*self.random.choice(places))

    def odd_value(self, kind):
        if kind in "iu":
            return self.random.choice([0, 1, 2, 255] if kind == "u" else [0, 1, -1, 2**31 - 1, 7])
        return self.random.choice([0.0, -1.0, 1e308, -1e308, 1e-320, float("nan"), float("inf"), 1e19])

    def change_attribute(self, group, name):
        old = group.attrs[name]
        kind = self.random.choice(["value", "value", "value", "remove", "array", "text", "number"])
        self.say(f"attribute {group.name}@{name} {kind}")
        if kind == "remove":
            del group.attrs[name]
        elif kind == "array":
            group.attrs[name] = [1.0, 2.0]
        elif kind == "text" or isinstance(old, (bytes, str)) and kind == "value":
            group.attrs[name] = self.random.choice([b"", b"a", b"\xff\xfe", b"a" * 60000, b"/etc/passwd"])
        elif kind == "number" or not hasattr(old, "dtype"):
            group.attrs[name] = 3.5
        else:
            group.attrs.modify(name, self.odd_value(old.dtype.kind) if old.dtype.kind in "iuf" else b"x")

    def change_dataset(self, group, path, dataset):
        kind = self.random.choice(["value"] * 6 + ["all", "remove", "shorter", "longer", "empty", "type", "rank"])
        self.say(f"dataset {path} {kind}")
        name, values, numeric = path.split("/")[-1], dataset[()], dataset.dtype.kind in "iuf"
        if kind in ("value", "all") and numeric and values.size:
            new = self.odd_value(dataset.dtype.kind)
            if dataset.dtype.kind in "iu" and self.random.random() < 0.5:
                new = 2 ** (8 * dataset.dtype.itemsize - (dataset.dtype.kind == "i")) - 1
            new = min(new, 2 ** (8 * dataset.dtype.itemsize) - 1) if dataset.dtype.kind == "u" else new
            if kind == "all":
                values[...] = new
            else:
                values.flat[self.random.randrange(values.size)] = new
            dataset[...] = values
            return
        del group[name]
        if kind == "remove":
            return
        shape = values.shape if hasattr(values, "shape") else ()
        if kind == "shorter" and shape:
            values = values[:-1]
        elif kind == "longer" and shape and shape[0]:
            values = values.repeat(2, axis=0)
        elif kind == "empty" and shape:
            values = values[:0]
        elif kind == "rank":
            values = values.reshape(values.shape + (1,)) if shape else values
        elif numeric:
            values = values.astype("f4" if dataset.dtype.kind in "iu" else "i8")
        else:
            values = b"text"
        group.create_dataset(name, data=values)


# ---------------------------------------------------------------- running

def commands_for(main, turn):
    """What one case runs, all in `turn` of its seed: (arguments, output that is there before, exit codes that are right)."""
    if main.lower().endswith((".h5", ".hdf5")):
        return [[(["info", main, "--json"], None, (0, 2, 3)), (["audit", main], None, (0, 1, 2, 3))],
                [(["export", main, "-o", "out.csv", "--values", "zones"], "out.csv", (0, 2, 3))],
                [(["render", main, "-o", "out.png", "--size", "8x6", "--spp", "1"], "out.png", (0, 2, 3))],
                [(["export", main, "-o", "out.glb", "--samples", "4", "--light-samples", "1"], "out.glb", (0, 2, 3))],
                ][turn % 4]
    solve = (["solve", main, "-o", "out.h5", "--packets", "2000", "--time", "2s"], "out.h5", (0, 2, 3))
    return [(["info", main, "--json"], None, (0, 2, 3))] if turn % 4 == 0 else [solve]


def solved(checker, seed, folder):
    """A solution of the room as a seed, the room beside it, or None."""
    case = new_folder(folder / "solved")
    Damage(seed, 0, 0, False).write(case)
    run = subprocess.run([checker.program, "solve", seed.main, "-o", "solution.h5", "--packets", "20000", "--time", "5s",
                          "--zone-area", "0.2"],
                         cwd=case, env=checker.environment, capture_output=True, check=False)
    if run.returncode != 0:
        return None
    parts = {"solution.h5": (case / "solution.h5").read_bytes()}
    return Seed("solution.h5", {**parts, **seed.parts})


def seeds_of(files):
    found = []
    for given in files:
        inside = sorted(p for p in given.rglob("*") if p.is_file()) if given.is_dir() else [given]
        found += [f for f in inside if f.suffix.lower() in ROOMS | PARTS | {".h5", ".hdf5"}]
    seeds = []
    for file in found:
        seed = Seed.of(file)
        seeds.append(seed)
        if file.suffix.lower() == ".gltf":
            try:
                glb = seed.as_glb()
            except (ValueError, KeyError, AttributeError, TypeError):
                glb = None
            seeds += [glb] if glb else []
    return seeds


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("files", type=pathlib.Path, nargs="+")
    parser.add_argument("--seed", type=int, default=1, help="of the random numbers (1)")
    parser.add_argument("--count", type=int, default=200, help="damaged files, in turn of all FILES (200)")
    parser.add_argument("--only", type=int, help="only the case with this number")
    parser.add_argument("--keep", type=pathlib.Path, help="where files that offend are put (a new temporary folder)")
    parser.add_argument("--limit", type=float, default=10, help="seconds that a run may take (10)")
    parser.add_argument("--as-given", action="store_true", help="each file once, without damage")
    parser.add_argument("--reseal", action="store_true",
                        help="give damaged solutions a seal that fits: tests the readers behind it, HDF5 among them")
    parser.add_argument("--verbose", action="store_true", help="say what was done and list refusals that name no place")
    options = parser.parse_args(arguments)
    checker = Checker(options.program.resolve(), options.limit)
    seeds = seeds_of(options.files)
    if not seeds:
        parser.error("there is no room among FILES")
    keep = options.keep or pathlib.Path(tempfile.gettempdir()) / f"mutated_files_{os.getpid()}"
    offending = []
    kinds, damaged = {}, {}
    with tempfile.TemporaryDirectory(prefix="mutate_files_") as scratch:
        folder = pathlib.Path(scratch)
        if not options.as_given and not any(s.main.endswith(".h5") for s in seeds):
            solution = next(filter(None, (solved(checker, s, folder) for s in seeds[:5])), None)
            seeds += [solution] if solution else []
        count = len(seeds) if options.as_given else options.count
        for number in range(count) if options.only is None else [options.only]:
            seed = seeds[number % len(seeds)]
            damage = Damage(seed, number, options.seed, options.reseal)
            if not options.as_given:
                damage.apply()
            kind = pathlib.PurePath(seed.main).suffix
            kinds[kind] = kinds.get(kind, 0) + 1
            for suffix in {pathlib.PurePath(words.split(": ")[0]).suffix for words in damage.words}:
                damaged[suffix] = damaged.get(suffix, 0) + 1
            turn = number // len(seeds)
            commands = [c for t in ((0, 1, 2, 3) if options.as_given else (turn,)) for c in commands_for(seed.main, t)]
            if options.as_given and kind not in (".h5", ".hdf5"):
                commands = commands[:2]
            started = time.monotonic()
            complaints = try_case(checker, damage, commands, folder, keep / f"{number:05d}_{seed.main}")
            if options.verbose:
                print(f"{number} {seed.main}: {'; '.join(damage.words)} [{time.monotonic() - started:.1f} s]", flush=True)
            if complaints:
                offending.append((number, seed.main, complaints))
                print(f"case {number}, {seed.main}, {'; '.join(damage.words)}:\n  " + "\n  ".join(complaints), flush=True)
    print(f"seed {options.seed}: {sum(kinds.values())} files:", ", ".join(f"{n} {k}" for k, n in sorted(kinds.items())))
    print("damaged in them:", ", ".join(f"{n} {k}" for k, n in sorted(damaged.items())))
    if options.verbose:
        print("refusals that name no place:")
        for kind, n in sorted(checker.placeless.items()):
            print(f"  {n} x {kind}")
    return print_summary(checker, offending, sum(kinds.values()), keep)


# ---------------------------------------------------------------- self-test

FAULTY = {  # What a program must not do, as a shell script, and a word of the complaint.
    "kill -SEGV $$": "signal 11",
    "exit 1": "exit code 1",
    "echo 'ERROR: AddressSanitizer: heap-buffer-overflow' >&2; exit 99": "sanitizer",
    "echo 'a.cpp:1:2: runtime error: signed integer overflow' >&2; echo 'reemit: error: room.obj' >&2; exit 2": "sanitizer",
    "sleep 60": "does not end",
    "echo half > out.h5.7.partial; echo 'reemit: error: room.obj:1' >&2; exit 2": "left behind",
    "rm -f out.h5; echo 'reemit: error: room.obj:1' >&2; exit 2": "is lost",
    "echo > out.h5; echo 'reemit: error: room.obj:1' >&2; exit 2": "replaced by a run that failed",
    "echo 'half a solution' > out.h5": "not whole",
    "echo 'reemit: error: something is wrong' >&2; exit 2": "names no file",
    "echo 'room.obj is bad' >&2; exit 2": "without 'reemit: error: '",
}
SOUND = "echo 'reemit: error: room.obj:1: bad' >&2; exit 2"


def self_test():
    """Programs with one fault each are found out, and one without is not."""
    failures = []
    with tempfile.TemporaryDirectory(prefix="mutate_files_") as scratch:
        folder = pathlib.Path(scratch)
        (folder / "room.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        seed = Seed.of(folder / "room.obj")
        same = [Damage(seed, 3, 5, False) for _ in range(2)]
        for damage in same:
            damage.apply()
        if same[0].parts != same[1].parts or same[0].words != same[1].words:
            failures.append("the same seed gives different damage")
        if seal_of(b"a") != b"reemit seal af63dc4c8601ec8c\n":
            failures.append("the seal is not that of docs/solution_file.md")
        for script, word in [*FAULTY.items(), (SOUND, None)]:
            program = folder / "program"
            program.write_text(f"#!/bin/sh\n{script}\n")
            program.chmod(0o755)
            damage = Damage(seed, 1, 1, False)
            complaints = try_case(Checker(program, 0.5), damage, commands_for(seed.main, 1), folder, folder / "kept")
            if (word is None) != (not complaints) or (word and word not in "\n".join(complaints)):
                failures.append(f"{script!r}: {complaints}")
            if word and not (folder / "kept" / "complaint.txt").exists():
                failures.append(f"{script!r}: nothing was kept")
            shutil.rmtree(folder / "kept", ignore_errors=True)
    for failure in failures:
        print(failure)
    print(f"{len(FAULTY)} faulty programs, {len(failures)} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(self_test() if sys.argv[1:] == ["--self-test"] else main(sys.argv[1:]))
