#!/usr/bin/python3
"""run.py PAGE FOLDER [--write] - runs the commands of a page like docs/tutorial.md in a folder.

Commands are the lines that begin with `$ ` in blocks marked `console`; a block marked `python NAME` is written to the file NAME first
in its turn. Tools are taken from the PATH, HEXPIPE is the project's folder. Ends with 1 when a command fails, or says other words than
the page does (numbers and blanks may differ). --write puts the real output into the page and the pictures beside it.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys

BLOCK = re.compile(r"^```(console|python \S+)\n(.*?)^```\n", re.M | re.S)
ROOT = pathlib.Path(__file__).resolve().parents[2]


def run(command, folder):
    environment = {**os.environ, "HEXPIPE": str(ROOT)}
    done = subprocess.run(["bash", "-o", "pipefail", "-c", command], cwd=folder, env=environment, text=True,
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if done.returncode != 0:
        sys.exit(f"$ {command}\n{done.stdout}exit code {done.returncode}")
    return done.stdout


def words(text):
    """The text without its numbers, which change with the machine and the version."""
    return re.sub(r"[\s#]+", " ", re.sub(r"-?\d[\d.]*(e[-+]?\d+)?", "#", text)).strip()


def run_block(text, folder):
    """The block with the output that its commands have now."""
    made, said = [], []
    for part in re.split(r"^(?=\$ )", text, flags=re.M):
        if not part.startswith("$ "):
            continue
        command, _, expected = part.partition("\n")
        output = run(command[2:], folder)
        if words(output) != words(expected):
            said.append(f"{command}\nexpected:\n{expected}found:\n{output}")
        made.append(f"{command}\n{output}")
    return "".join(made), said


def main():
    page, folder = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    writes = sys.argv[3:] == ["--write"]
    differences = []

    def replace(block):
        kind, text = block.groups()
        if kind != "console":
            (folder / kind.split()[1]).write_text(text)
            return block[0]
        made, said = run_block(text, folder)
        differences.extend(said)
        return f"```console\n{made}```\n"

    text = BLOCK.sub(replace, page.read_text())
    for picture in re.findall(rf"\]\({page.stem}/(\S+\.png)\)", text):
        if not (folder / picture).exists():
            sys.exit(f"{page}: no command makes {picture}")
        if writes:
            shutil.copy(folder / picture, page.parent / page.stem / picture)
    if writes:
        page.write_text(text)
    elif differences:
        sys.exit("\n".join(differences))


if __name__ == "__main__":
    main()
