"""Runs reemit on a file and judges how it ends; mutate_files.py and broken_rooms.py share it.

What must hold of every run:
- it ends with a documented exit code (docs/command_line.md), by itself, without a signal and without a report of a
  sanitizer, within the limit;
- it leaves no *.partial behind; an output that was there stays unless the run succeeds, then it is whole;
- a refusal (exit code 2) starts with "reemit: error: " and names one of the files.
"""
import json
import os
import pathlib
import re
import shutil
import stat
import subprocess
import tempfile
import time

SEAL = b"reemit seal "
SEAL_BYTES = len(SEAL) + 17


def seal_of(data):
    value = 0xcbf29ce484222325
    for byte in data:
        value = (value ^ byte) * 0x100000001b3 & 0xffffffffffffffff
    return SEAL + b"%016x\n" % value


class Checker:
    def __init__(self, program, limit):
        self.program, self.limit = program, limit
        self.environment = dict(os.environ)
        own = {"ASAN_OPTIONS": "detect_leaks=0:allocator_may_return_null=1:exitcode=99",
               "UBSAN_OPTIONS": "halt_on_error=1:print_stacktrace=1:exitcode=99"}
        for variable, value in own.items():
            self.environment.setdefault(variable, value)
        self.slowest = (0.0, "")
        self.codes = {}
        self.placeless = {}

    def run(self, arguments, folder, names, output=None, allowed=(0, 2, 3)):
        """Runs one command in `folder`; returns exit code, what it printed, and complaints. `output` exists before."""
        old = (folder / output).read_bytes() if output else b""
        before = sorted(os.listdir(folder))
        started = time.monotonic()
        complaints = []
        with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
            process = subprocess.Popen([self.program, *arguments], cwd=folder, env=self.environment, stdin=subprocess.DEVNULL,
                                       stdout=out, stderr=err)
            try:
                code = process.wait(timeout=self.limit)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
                code = None
            out.seek(0)
            err.seek(0)
            printed, said = out.read().decode("utf-8", "replace"), err.read().decode("utf-8", "replace")
        seconds = time.monotonic() - started
        if seconds > self.slowest[0]:
            self.slowest = (seconds, " ".join(arguments[:2]))
        key = (arguments[0], "hang" if code is None else code)
        self.codes[key] = self.codes.get(key, 0) + 1
        if code is None:
            complaints.append(f"does not end within {self.limit} s")
        elif code < 0:
            complaints.append(f"ended by signal {-code}")
        elif code not in allowed:
            complaints.append(f"exit code {code}")
        if re.search(r"Sanitizer|runtime error:", said):
            complaints.append("report of a sanitizer")
        left = [n for n in sorted(os.listdir(folder)) if n not in before]
        if code is not None and left:
            complaints.append(f"left behind: {left}")
        if output and code is not None:
            now = (folder / output).read_bytes() if (folder / output).is_file() else None
            if now is None:
                complaints.append(f"{output} is lost")
            elif code != 0 and now != old:
                complaints.append(f"{output} was replaced by a run that failed")
            elif code == 0 and (now == old or (output.endswith(".h5") and now[-SEAL_BYTES:-17] != SEAL)):
                complaints.append(f"{output} is not whole")
        if code == 2:
            complaints += self.judge_refusal(printed, said, names, "--json" in arguments)
        elif code == 3 and "memory" not in said:
            complaints.append("exit code 3 without a word about memory")
        if complaints:
            complaints.append((said or printed)[-1500:])
        return code, printed, complaints

    def judge_refusal(self, printed, said, names, as_json):
        error = [line for line in said.splitlines() if line.startswith("reemit: error: ")]
        if not error:
            return ["refused without 'reemit: error: '"]
        complaints = []
        if as_json and printed:
            try:
                json.loads(printed)
            except ValueError:
                complaints.append("what --json printed is not JSON")
        elif printed:
            complaints.append("refused, but something was printed")
        text = "\n".join(said.splitlines()[said.splitlines().index(error[0]):])
        if not any(pathlib.PurePath(name).name in text for name in names):
            complaints.append("the refusal names no file")
        elif not re.search(r"\.\w+(:\d+|#/)|(surface|face|material|light|camera|luminaire|dataset|attribute|group) ['\"/\w]|is damaged|there is no face", text):
            kind = re.sub(r"/\S*/|\d+", "", error[0])
            self.placeless[kind] = self.placeless.get(kind, 0) + 1
        return complaints


def new_folder(folder):
    """An empty folder of that name."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    return folder


def try_case(checker, case, commands, folder, place, judge=None):
    """Runs `commands`, (arguments, output that is there before, exit codes that are right) each, on one case: words
    about it, names() of its files, write(folder). `judge` gets what each run that succeeded printed, and complains too.
    Returns all complaints; if there are any, the files are kept in `place`."""
    here = new_folder(folder / "case")
    case.write(here)
    complaints = []
    for arguments, output, allowed in commands:
        if output:
            old = b"what was here before"
            (here / output).write_bytes(old + seal_of(old) if output.endswith(".h5") else old)
        code, printed, found = checker.run(arguments, here, case.names(), output, allowed)
        if judge and code == 0:
            found += judge(arguments, printed)
        if found:
            complaints += [" ".join(arguments)] + found
    if complaints:
        shutil.rmtree(place, ignore_errors=True)
        place.parent.mkdir(parents=True, exist_ok=True)
        shutil.copytree(here, place, symlinks=True,
                        ignore=lambda d, names: [n for n in names if stat.S_ISFIFO(os.lstat(os.path.join(d, n)).st_mode)])
        (place / "complaint.txt").write_text("\n".join(case.words + complaints) + "\n")
    return complaints


def print_summary(checker, offending, count, keep):
    """How all runs ended, and `offending` files: (number, name, complaints). Returns the exit code."""
    print("ends:", ", ".join(f"{command} {code}: {n}" for (command, code), n in sorted(checker.codes.items(), key=str)))
    print(f"slowest: {checker.slowest[0]:.1f} s, {checker.slowest[1]}")
    for number, name, complaints in offending:
        print(f"offending: case {number} of {name}: {complaints[1]}")
    if offending:
        print(f"{len(offending)} of {count} files offend; they are in {keep}, and --only NUMBER repeats one")
    return 1 if offending else 0
