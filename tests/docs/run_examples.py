"""Runs every command of a documentation page, in the order of the page, in a copy of its examples folder.

Usage: run_examples.py PAGE EXAMPLES_FOLDER PROGRAM
Blocks marked sh and python are run; the first that fails ends the test with its output.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile


def main() -> int:
    page, examples, program = (pathlib.Path(argument).resolve() for argument in sys.argv[1:4])
    blocks = re.findall(r"^```(sh|python)\n(.*?)^```$", page.read_text(), re.MULTILINE | re.DOTALL)
    languages = {language for language, _ in blocks}
    if languages != {"sh", "python"}:
        print(f"{page} must have blocks of both languages, has {languages}")
        return 1
    environment = dict(os.environ, PATH=f"{program.parent}{os.pathsep}{os.environ['PATH']}")
    interpreter = {"sh": ["bash", "-euo", "pipefail", "-c"], "python": [sys.executable, "-c"]}
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch) / "examples"
        shutil.copytree(examples, folder)
        for language, text in blocks:
            run = subprocess.run([*interpreter[language], text], cwd=folder, env=environment, text=True,
                                 stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=300)
            if run.returncode != 0 or not run.stdout.strip():
                print(f"this block of {page} ended with {run.returncode}:\n{text}\n{run.stdout}")
                return 1
            print(run.stdout)
    print(f"{len(blocks)} blocks ran")
    return 0


sys.exit(main())
