#!/usr/bin/python3
"""inject.py [--library FILE] [--per-kind N] [--disk N] [--kills N] [--pipes N] [--stalls N] [TOOL...]

Runs the tools with one fault each, by the library fail_calls.cpp: every call of the system that a run makes fails once,
the disk is full at every byte of the output, the tool is killed at every call and at random moments (INT, TERM, HUP,
KILL), whoever reads its output goes away, its input stalls and one SIGTERM has to end it. --per-kind, --disk, --pipes
and --stalls are numbers of cases, spread over all (0: every one); --kills is the number of kills.

After each case the old output is there, or the new one as a run without fault writes it; there is no other file beside
it; the exit code is 0 with the new output and 1 with the old one, then with one line on standard error that names the
tool; a search that is stopped leaves a solution that is independent, maximal and no lighter than its input. Prints a
line for each case that breaks this, then a table.
"""
import argparse
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
BIN = pathlib.Path(os.environ.get("HEXPIPE_BIN", ROOT / "build/bin"))
OLD = b"the old output\n"
STAGES = {  # options, ending of the product
    "tetmesh": (["--size", "0.7"], "mesh"),
    "findhex": (["--cells", "hex,prism,pyramid"], "cand"),
    "buildgraph": ([], "graph"),
    "initsol": (["--iterations", "50"], "sol"),
    "lns": (["--iterations", "5"], "sol"),
    "certify": (["--iterations", "5"], "sol"),
    "assemble": ([], "vtu"),
    "merge-parts": ([], "tar.zst"),
    "mesh-part": (["--parts", "2"], ""),  # a directory
    "viewmesh": ([], "html"),
    "lns-mpi": (["--iterations", "5"], "sol"),
}
# Options for runs that are long enough to be stopped in the middle.
LONG_RUNS = {
    "tetmesh": ["--size", "0.2"],
    "findhex": ["--cells", "hex,prism,pyramid"],
    "buildgraph": ["--weight", "volume"],
    "initsol": ["--time-limit", "0.3"],
    "lns": ["--time-limit", "0.3"],
    "certify": ["--iterations", "3000"],
    "assemble": ["--smooth", "20"],
    "merge-parts": [],
    "mesh-part": ["--parts", "2"],
    "viewmesh": [],
    "lns-mpi": ["--time-limit", "0.3"],
}
LIBARCHIVE_WITHOUT_MEMORY = ("Fatal Internal Error in libarchive: Out of memory", "Fatal Internal Error in libarchive: No memory")
SEARCHES = ("initsol", "lns", "certify", "lns-mpi")
# MPI decides what happens when its own calls fail, and waits for a second signal; this is not tested.
WITH_MPI = ("lns-mpi",)
KINDS = ["open", "read", "write", "close", "link", "rename", "fork", "thread", "pipe", "memory"]


class Report:
    def __init__(self):
        self.counts, self.broken = {}, 0

    def case(self, tool, kind, what, complaint):
        self.counts[(tool, kind)] = self.counts.get((tool, kind), 0) + 1
        if complaint:
            self.broken += 1
            print(f"{tool} {what}: {complaint}", flush=True)

    def table(self, tools):
        kinds = sorted({kind for _, kind in self.counts}, key=lambda k: (k not in KINDS, KINDS.index(k) if k in KINDS else k))
        print("cases".ljust(12) + "".join(k.rjust(9) for k in kinds))
        for tool in tools:
            print(tool.ljust(12) + "".join(str(self.counts.get((tool, k), 0)).rjust(9) for k in kinds))
        print("total".ljust(12) + "".join(str(sum(self.counts.get((t, k), 0) for t in tools)).rjust(9) for k in kinds))
        print(f"{sum(self.counts.values())} cases, {self.broken} broken")


def spread(total, wanted):
    """`wanted` numbers of 1..total, evenly and with both ends; all of them for 0."""
    if wanted == 0 or wanted >= total:
        return range(1, total + 1)
    return sorted({1 + round(i * (total - 1) / max(wanted - 1, 1)) for i in range(wanted)})


class Bench:
    """One tool with its input, in a directory of its own."""

    def __init__(self, tool, options, source, library, directory):
        self.tool, self.source, self.library, self.directory = tool, source, library, directory
        self.makes_directory = STAGES[tool][1] == ""
        self.bundle, self.product = ("out", "out") if self.makes_directory else ("out.tar", "out." + STAGES[tool][1])
        self.options = [BIN / tool, *options, "-q", "--threads", "2"]
        self.command = self.options + [source]
        self.expected = {}  # by name of the output: the bytes of its files by their names
        for name in (self.bundle, self.product):
            self.run(name, "")
            self.expected[name] = self.take_files()

    def take_files(self):
        """What lies in the directory, which is empty afterwards."""
        files = {}
        for path in sorted(self.directory.rglob("*"), reverse=True):
            if path.is_dir():
                path.rmdir()
            else:
                files[str(path.relative_to(self.directory))] = path.read_bytes()
                path.unlink()
        return files

    def put_old_files(self, name):
        for path in self.expected[name]:
            (self.directory / path).parent.mkdir(exist_ok=True)
            (self.directory / path).write_bytes(OLD)

    def environment(self, fault):
        return {**os.environ, "LD_PRELOAD": str(self.library), "HEXPIPE_FAULT": fault}

    def start(self, name, fault, **streams):
        streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **streams}
        return subprocess.Popen(self.command + ["-o", self.directory / name] if name else self.command,
                                env=self.environment(fault), stdin=subprocess.DEVNULL, **streams)

    def run(self, name, fault):
        process = self.start(name, fault)
        try:
            _, errors = process.communicate(timeout=60)
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
            return "hangs", b""
        return process.returncode, errors

    def counts(self):
        self.run(self.bundle, f"count:{self.directory}/count")
        lines = self.take_files()["count"].decode().splitlines()
        return {kind: int(number) for kind, number in (line.split() for line in lines)}

    def complaint(self, name, code, errors, signals=(), judge=None):
        """What is wrong after a run into the file `name`, which held OLD; None when all is well.

        It may have ended by one of these signals; `judge` says what is wrong with an output that is not the usual one.
        """
        killed = -code in signals
        files, expected = self.take_files(), self.expected[name]
        others = sorted(files.keys() - expected.keys())
        if code == -signal.SIGKILL and len(others) == 1:
            # Between a link and a rename the new file stands beside the old one, whole: no system can do it in one step.
            if files[others[0]] in expected.values():
                del files[others.pop()]
        if files.keys() != expected.keys():
            return f"files left: {sorted(files)}"
        old = [path for path, found in files.items() if found == OLD]
        for path in files.keys() - old:
            if files[path] != expected[path]:
                wrong = judge(files[path]) if judge else f"another output of {len(files[path])} bytes"
                if wrong:
                    return f"exit code {code}, {wrong}"
        if old:
            if killed:
                return None
            if code != 1:
                return f"exit code {code} with the old output: {errors[-300:]!r}"
            lines = errors.decode(errors="replace").splitlines()
            # libarchive and METIS speak for themselves when they have no memory.
            if any("***Memory allocation failed for" in line for line in lines):
                del lines[:-1]
            if len(lines) != 1 or not lines[0].startswith((self.tool + ": ", *LIBARCHIVE_WITHOUT_MEMORY)):
                return f"expected one line of standard error, found {errors[-300:]!r}"
            return None
        # Memory may be missing when all is done.
        if b"not enough memory" in errors and code == 1:
            return None
        return None if code == 0 or killed else f"exit code {code} with the new output: {errors!r}"

    def case(self, name, fault, signals=()):
        self.put_old_files(name)
        code, errors = self.run(name, fault)
        return "hangs" if code == "hangs" else self.complaint(name, code, errors, signals)


def fail_every_call(bench, report, per_kind):
    counts = bench.counts()
    for kind in KINDS:
        for number in spread(counts[kind], per_kind) if counts[kind] else []:
            fault = f"{kind}:{number}"
            report.case(bench.tool, kind, fault, bench.case(bench.bundle, fault))
    for number in spread(counts["kill"], per_kind):
        report.case(bench.tool, "kill", f"kill:{number}", bench.case(bench.bundle, f"kill:{number}", [signal.SIGKILL]))
    report.case(bench.tool, "short", "short:1", bench.case(bench.bundle, "short:1"))


def fill_the_disk(bench, report, wanted):
    name = bench.product
    size = max(map(len, bench.expected[name].values()))
    for room in spread(size, wanted):
        complaint = bench.case(name, f"disk:{room - 1}")
        report.case(bench.tool, "disk", f"disk:{room - 1}", complaint)


def weight_of(*paths):
    """By the checker, which also says whether the solution is one."""
    checked = subprocess.run(["/usr/bin/python3", ROOT / "tests/checkers/solution_check.py", *paths], stdout=subprocess.PIPE)
    return int(checked.stdout.split()[-1]) if checked.returncode == 0 else None


def judge_of_search(bench):
    """None for tools whose output is always the same."""
    if bench.tool not in SEARCHES:
        return None
    least = 0 if bench.tool == "initsol" else weight_of(bench.source)

    def judge(output):
        copy = bench.directory.parent / "judged.tar"
        copy.write_bytes(output)
        weight = weight_of(copy)
        if weight is None:
            return "no valid solution"
        return None if weight >= least else f"a solution of weight {weight} out of one of {least}"

    return judge


def kill_at_random(bench, report, kills, seed):
    random_numbers = random.Random(f"{seed} {bench.tool}")
    begun = time.monotonic()
    bench.run(bench.bundle, "")
    longest = time.monotonic() - begun
    bench.take_files()
    judge = judge_of_search(bench)
    for i in range(kills):
        number = random_numbers.choice([signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGKILL])
        bench.put_old_files(bench.bundle)
        process = bench.start(bench.bundle, "")
        time.sleep(random_numbers.uniform(0, longest))
        process.send_signal(number)
        _, errors = process.communicate(timeout=60)
        complaint = bench.complaint(bench.bundle, process.returncode, errors, [number], judge)
        report.case(bench.tool, "signal", f"signal {number} (case {i} of seed {seed})", complaint)


def stall(bench, report, wanted):
    """The input comes to a halt; one SIGTERM ends the tool within a moment, and the old output stays."""
    source = bench.source.read_bytes()
    for given in spread(len(source), wanted):
        bench.put_old_files(bench.bundle)
        process = subprocess.Popen(bench.options + ["-", "-o", bench.directory / bench.bundle], stdin=subprocess.PIPE,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        # In pieces: what is more than the pipe holds is there only once the tool reads.
        process.stdin.write(source[: given - 1])
        process.stdin.flush()
        time.sleep(0.05)
        process.send_signal(signal.SIGTERM)
        try:
            code = process.wait(timeout=20)
        except subprocess.TimeoutExpired:
            process.kill()
            code = "still running"
        process.stdin.close()
        errors = process.stderr.read()
        process.stdout.close()
        process.stderr.close()
        process.wait()
        complaint = "hangs" if code == "still running" else bench.complaint(bench.bundle, code, errors, [signal.SIGTERM])
        report.case(bench.tool, "stall", f"input stalls after {given - 1} bytes", complaint)


def leave_the_pipe(bench, report, wanted):
    """The reader of standard output takes some bytes and goes; standard input is no matter here."""
    if bench.makes_directory:
        return
    size = len(bench.expected[bench.bundle][bench.bundle])
    for taken in spread(size, wanted):
        ends = os.pipe()
        process = bench.start(None, "", stdout=ends[1])
        os.close(ends[1])
        if taken > 1:
            os.read(ends[0], taken - 1)
        os.close(ends[0])
        _, errors = process.communicate(timeout=60)
        fine = process.returncode == 0 or (process.returncode == 1 and b"stdout: cannot write" in errors)
        report.case(bench.tool, "pipe-end", f"reader left after {taken - 1} bytes",
                    None if fine else f"exit code {process.returncode}, {errors!r}")


def stage_inputs(directory, size):
    """The input of each tool, as a file; the mesh is a lattice of that many cubes along each axis."""
    directory.mkdir()
    inputs = {"tetmesh": ROOT / "tests/data/cube.stl"}
    mesh = directory / "lattice.mesh"
    lattice = ROOT / "tests/data/lattices/lattice.py"
    made = subprocess.run(["/usr/bin/python3", lattice, "kuhn", str(size)], check=True, stdout=subprocess.PIPE)
    mesh.write_bytes(made.stdout)
    inputs["findhex"] = inputs["mesh-part"] = mesh
    order = ["findhex", "buildgraph", "initsol", "lns", "assemble"]
    for tool, following in zip(order, order[1:]):
        inputs[following] = directory / (following + ".in.tar")
        options = STAGES[tool][0]
        subprocess.run([BIN / tool, *options, "-q", inputs[tool], "-o", inputs[following]], check=True)
    inputs["certify"] = inputs["viewmesh"] = inputs["assemble"]
    inputs["lns-mpi"] = inputs["lns"]
    inputs["merge-parts"] = directory / "merge-parts.in.tar"
    subprocess.run([BIN / "findhex", *STAGES["findhex"][0], "--part", "1/1", "-q", mesh, "-o", inputs["merge-parts"]], check=True)
    return inputs


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--library", default=BIN.parent / "lib/libfail_calls.so")
    parser.add_argument("--per-kind", type=int, default=0)
    parser.add_argument("--disk", type=int, default=0)
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--pipes", type=int, default=20)
    parser.add_argument("--stalls", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("tools", nargs="*")
    options = parser.parse_args()
    tools = options.tools or [tool for tool in STAGES if (BIN / tool).exists()]
    report = Report()
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        small, large = stage_inputs(scratch / "small", 1), stage_inputs(scratch / "large", 3)
        library = pathlib.Path(options.library).resolve()
        for tool in tools:
            directory = scratch / tool
            directory.mkdir()
            bench = Bench(tool, STAGES[tool][0], small[tool], library, directory)
            if tool not in WITH_MPI:
                fail_every_call(bench, report, options.per_kind)
            fill_the_disk(bench, report, options.disk)
            leave_the_pipe(bench, report, options.pipes)
            if tool not in WITH_MPI:
                stall(bench, report, options.stalls)
            kill_at_random(Bench(tool, LONG_RUNS[tool], large[tool], library, directory), report, options.kills, options.seed)
    report.table(tools)
    sys.exit(report.broken > 0)


main()
