"""Installs reemit into an empty folder, moves it, builds the example of the library against it, and checks its numbers.

Usage: build_example.py CMAKE GENERATOR BUILD_FOLDER SOURCE_FOLDER
The folder is removed at the end, whatever happens.
"""
import json
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

# What an installed header may include beside others of ours and the standard library: what reemit::reemit brings along.
LIBRARIES = {"Eigen", "OpenMesh", "fmt", "tbb"}
INSTALLED = ["bin/reemit", "share/man/man1/reemit.1", "share/bash-completion/completions/reemit",
             "share/doc/reemit/LICENSE", "include/reemit/version.h"]

# Needs the module that reads images, which lies beside the libraries.
IMAGE_SIZE = """#include <cstdio>
#include <reemit/scenes/io/images/image_library.h>

int main(int, char** argv) {
  const reemit::OpenedImage image = reemit::image_library().open(argv[1]);
  if (image.reader) std::printf("%d x %d\\n", image.reader->layout().width, image.reader->layout().height);
}
"""


class Failure(Exception):
    """A check that did not hold, in words."""


def run(*command) -> str:
    done = subprocess.run([str(word) for word in command], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          timeout=600)
    if done.returncode != 0:
        raise Failure(f"{' '.join(map(str, command))}\nended with {done.returncode}:\n{done.stdout}")
    return done.stdout


def check_headers(folder: pathlib.Path) -> None:
    headers = sorted(folder.rglob("*.h"))
    if len(headers) < 100:
        raise Failure(f"{folder} has {len(headers)} headers only")
    for header in headers:
        if header.relative_to(folder).parts[0] in ("tests", "bench"):
            raise Failure(f"{header} is for development only")
        for mark, name in re.findall(r'^\s*#\s*include\s*([<"])([^>"]+)', header.read_text(), re.MULTILINE):
            if mark == '"' and not (folder / name).exists() and not (folder.parent / name).exists():
                raise Failure(f"{header} includes {name}, which is not installed")
            if mark == "<" and "/" in name and name.split("/")[0] not in LIBRARIES | {"sys"}:
                raise Failure(f"{header} includes <{name}>, which users of the library need not have; "
                              "leave the header out in cmake/install.cmake or link the library PUBLIC")
            if mark == "<" and "/" not in name and name.endswith((".h", ".hpp")) and name != "unistd.h":
                raise Failure(f"{header} includes <{name}>, which is neither of the standard library nor installed")


def check_paths(prefix: pathlib.Path, folders: list) -> None:
    files = list(prefix.rglob("*.cmake"))
    if len(files) < 4:
        raise Failure(f"the package for CMake consists of {files}")
    for file in files:
        for folder in folders:
            if str(folder) in file.read_text():
                raise Failure(f"{file} names {folder}, so that it cannot go to another machine")


def extend_project(project: pathlib.Path, prefix: pathlib.Path) -> None:
    """Adds what users may do and the example does not: all headers in one file, and the instructions of this machine,
    for which Eigen would allocate otherwise than our libraries free."""
    headers = sorted(header.relative_to(prefix / "include") for header in (prefix / "include").rglob("*.h"))
    (project / "headers.cpp").write_text("".join(f"#include <{header}>\n" for header in headers))
    with (project / "CMakeLists.txt").open("a") as file:
        file.write("add_library(headers OBJECT headers.cpp)\n"
                   "target_link_libraries(headers PRIVATE reemit::reemit)\n"
                   "add_executable(irradiance_native main.cpp)\n"
                   "target_link_libraries(irradiance_native PRIVATE reemit::reemit)\n"
                   "target_compile_options(irradiance_native PRIVATE -march=native)\n"
                   "add_executable(image_size image_size.cpp)\n"
                   "target_link_libraries(image_size PRIVATE reemit::reemit)\n")
    (project / "image_size.cpp").write_text(IMAGE_SIZE)


def printed_values(program: pathlib.Path, room: pathlib.Path) -> dict:
    lines = [line.split("\t") for line in run(program, room).splitlines()]
    return {(name, side, band): float(value.removesuffix(" W/m2")) for name, side, band, value in lines}


def stored_values(reemit: pathlib.Path, room: pathlib.Path, solution: pathlib.Path) -> dict:
    run(reemit, "solve", room, "-o", solution, "--error", "5%", "--quiet")
    info = json.loads(run(reemit, "info", solution, "--json", "--quiet"))
    return {(surface["name"], surface["side"], band): value
            for surface in info["surfaces"] if surface["counts"]
            for band, value in zip(info["bands"], surface["irradiance_W_m2"])}


def check_values(what: str, values: dict, expected: dict, tolerance: float) -> None:
    if values.keys() != expected.keys():
        raise Failure(f"{what}: {sorted(values)} instead of {sorted(expected)}")
    for key, value in expected.items():
        if not math.isclose(values[key], value, rel_tol=tolerance):
            raise Failure(f"{what}: irradiance of {key} is {values[key]}, expected {value}")
    print(f"{what}: {len(values)} values agree to {tolerance:g}")


def check(cmake: str, generator: str, build: pathlib.Path, source: pathlib.Path, scratch: pathlib.Path) -> None:
    run(cmake, "--install", build, "--prefix", scratch / "first")
    prefix = (scratch / "first").rename(scratch / "moved")
    for file in INSTALLED:
        if not (prefix / file).is_file():
            raise Failure(f"{file} is not installed")
    check_headers(prefix / "include/reemit")
    check_paths(prefix, [build, source, scratch / "first"])

    project = shutil.copytree(source / "docs/examples/library", scratch / "project")
    extend_project(project, prefix)
    run(cmake, "-G", generator, "-S", project, "-B", scratch / "build", f"-DCMAKE_PREFIX_PATH={prefix}")
    run(cmake, "--build", scratch / "build")
    rooms = source / "scenes/library"
    # M = pi W/m2 and a reflectance of 1/2 everywhere: E = M / (1 - 1/2), whatever the shape.
    for program in ("irradiance", "irradiance_native"):
        check_values(f"furnace, {program}", printed_values(scratch / "build" / program, rooms / "furnace_box.json"),
                     {("box", "front", "grey"): 2 * math.pi}, 0.01)
    # The program and the example do the same, so they must find the same, but for the digits that are printed.
    room = rooms / "cornell_box.json"
    check_values("Cornell box", printed_values(scratch / "build/irradiance", room),
                 stored_values(prefix / "bin/reemit", room, scratch / "room.h5"), 1e-6)

    picture = scratch / "room.png"
    run(prefix / "bin/reemit", "render", scratch / "room.h5", "-o", picture, "--size", "40x30", "--spp", "1")
    size = run(scratch / "build/image_size", picture)
    if size != "40 x 30\n":
        raise Failure(f"{picture} has '{size}' pixels instead of 40 x 30")
    print("a picture is written by the installed program and read by one that uses the library")


def main() -> int:
    cmake, generator, build, source = sys.argv[1:]
    with tempfile.TemporaryDirectory(prefix="reemit-install-") as scratch:
        try:
            check(cmake, generator, pathlib.Path(build).resolve(), pathlib.Path(source).resolve(),
                  pathlib.Path(scratch).resolve())
        except Failure as failure:
            print(failure)
            return 1
    return 0


sys.exit(main())
