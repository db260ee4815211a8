"""Tables as CSV and sheets as SVG, drawn by gnuplot: what curves.py and run.py share."""
import csv
import json
import subprocess

COLOURS = ["#355f8d", "#e8a33d", "#22a884", "#c9647b", "#8d79b8", "#9aa352", "#4fa9b8", "#b5805a"]

HEAD = """set terminal svg size 860,480 dynamic font 'DejaVu Sans,13' background '#ffffff'
set border 3 lc rgb '#9aa3ad'
set tics nomirror out scale 0.6 textcolor rgb '#4a525d'
set grid ytics lc rgb '#e3e7ec' lt 1
set key outside right top vertical Left reverse samplen 1.5 spacing 1.3 textcolor rgb '#1d232b'
set title font ',15' textcolor rgb '#1d232b' offset 0,-0.4
set xlabel textcolor rgb '#4a525d'
set ylabel textcolor rgb '#4a525d'
set style fill solid 0.9 noborder
"""


def write_table(path, names, rows):
    with open(path, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(names)
        writer.writerows([round(x, 6) if isinstance(x, float) else x for x in row] for row in rows)


def quoted(text):
    return "'" + str(text).replace("'", "''") + "'"


def draw(path, title, xlabel, ylabel, series, settings=()):
    """series: (name, points, style); points are (x, y), the style is gnuplot's, for example 'linespoints pt 7'."""
    script = [HEAD, f"set output {quoted(path)}", f"set title {quoted(title)} noenhanced",
              f"set xlabel {quoted(xlabel)} noenhanced", f"set ylabel {quoted(ylabel)} noenhanced", *settings]
    plots = []
    for i, (name, points, style) in enumerate(series):
        script.append(f"$data{i} << END\n" + "\n".join(f"{x} {y}" for x, y in points) + "\nEND")
        plots.append(f"$data{i} using 1:2 with {style} lc rgb '{COLOURS[i % len(COLOURS)]}' title {quoted(name)} noenhanced")
    script.append("plot " + ", ".join(plots))
    subprocess.run(["gnuplot"], input="\n".join(script) + "\n", text=True, check=True)


def read_log(path):
    """The value's name (weight or bound) and (seconds, value) of each line that --log wrote."""
    entries = [json.loads(line) for line in open(path)]
    if not entries:
        raise SystemExit(f"{path}: expected a line of --log at least, found none")
    name = "bound" if "bound" in entries[0] else "weight"
    return name, [(entry["seconds"], entry[name]) for entry in entries]


def draw_curves(path, title, runs):
    """runs: (name, file of --log). Bounds are drawn as dotted lines, weights as steps that go on to the last time of all; of the
    bounds what lies as near to their best as the weights do."""
    logs = [(name, *read_log(log)) for name, log in runs]
    end = max(points[-1][0] for _, _, points in logs)
    series = []
    for name, kind, points in logs:
        style = "lines lw 2 dt 3" if kind == "bound" else "steps lw 2"
        series.append((f"{name} (bound)" if kind == "bound" else name, points + [(end, points[-1][1])], style))
    draw(path, title, "seconds", "weight", series, ["set format y '%.4s%c'", *height_of(logs)])


def height_of(logs):
    weights = [value for _, kind, points in logs for _, value in points if kind == "weight"]
    bounds = [points[-1][1] for _, kind, points in logs if kind == "bound"]
    if not weights or not bounds:
        return []
    margin = 0.08 * (max(bounds) - min(weights))
    return [f"set yrange [{min(weights) - margin}:{max(bounds) + margin}]"]
