#!/usr/bin/python3
"""curves.py SHEET.svg RUN.jsonl... - weights and certified bounds against time, several runs on one sheet.

A RUN is what --log of initsol, lns or certify wrote; NAME=RUN.jsonl names it on the sheet. Needs gnuplot.
"""
import os
import sys

import sheets


def main():
    if len(sys.argv) < 3:
        raise SystemExit(__doc__)
    runs = [(argument.split("=", 1)[0], argument.split("=", 1)[1]) if "=" in argument
            else (os.path.splitext(os.path.basename(argument))[0], argument) for argument in sys.argv[2:]]
    sheets.draw_curves(sys.argv[1], "Weight against time", runs)


main()
