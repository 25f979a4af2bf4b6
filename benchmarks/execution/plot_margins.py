#!/usr/bin/env python3
"""How many plans are carried out, by the execution margin that they were planned with, as an SVG.

    plot_margins.py ROUGH.json NOMINAL.json… OUT.svg

The files are those of simulation_campaign; its plans are named SCENARIO.FACTOR.SEED.g2o, FACTOR as
of `plan --execution-margin`. One line a scenario and a thick one for all, one panel a kind of run.
"""
import json
import sys
from collections import defaultdict

WIDTH, HEIGHT, LEFT, TOP = 250, 170, 46, 34
COLOURS = ["#4477aa", "#ee6677", "#228833", "#ccbb44", "#66ccee", "#aa3377"]


def shares(files):
    """kind -> scenario -> factor -> [carried out, runs]; the scenario "all" is their sum."""
    counts = defaultdict(lambda: defaultdict(lambda: defaultdict(lambda: [0, 0])))
    for file in files:
        with open(file) as stream:
            campaign = json.load(stream)
        for plan in campaign["plans"]:
            scenario, factor = plan["plan"].removesuffix(".g2o").rsplit(".", 1)[0].split(".", 1)
            for kind in campaign["pooled"]:
                for name in (scenario, "all"):
                    count = counts[kind][name][float(factor)]
                    count[0] += plan[kind]["carried_out"]
                    count[1] += plan[kind]["runs"]
    return counts


def panel(kind, of_scenarios, at_x):
    factors = sorted(of_scenarios["all"])
    x = lambda f: at_x + LEFT + WIDTH * (f - factors[0]) / max(factors[-1] - factors[0], 1e-9)
    y = lambda share: TOP + HEIGHT * (1.0 - share)
    parts = [f'<text x="{at_x + LEFT}" y="{TOP - 14}" font-weight="bold">{kind}</text>']
    for share in (0.0, 0.25, 0.5, 0.75, 1.0):
        parts.append(f'<line x1="{x(factors[0])}" x2="{x(factors[-1])}" y1="{y(share)}" y2="{y(share)}" stroke="#ddd"/>'
                     f'<text x="{at_x + LEFT - 6}" y="{y(share) + 4}" text-anchor="end">{share:.0%}</text>')
    for factor in factors:
        parts.append(f'<text x="{x(factor)}" y="{TOP + HEIGHT + 16}" text-anchor="middle">{factor:g}</text>')
    names = sorted(n for n in of_scenarios if n != "all") + ["all"]
    for i, name in enumerate(names):
        counts = of_scenarios[name]
        points = " ".join(f"{x(f):.1f},{y(counts[f][0] / counts[f][1]):.1f}" for f in sorted(counts))
        whole = name == "all"
        colour = "black" if whole else COLOURS[i % len(COLOURS)]
        parts.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="{3 if whole else 1.2}"/>')
    return "\n".join(parts), names


def main():
    *files, out = sys.argv[1:]
    counts = shares(files)
    kinds = [k for k in ("nominal", "all", "rough") if k in counts] + \
            [k for k in counts if k not in ("nominal", "all", "rough")]
    body, names = [], []
    for i, kind in enumerate(kinds):
        text, names = panel(kind, counts[kind], i * (WIDTH + LEFT + 14))
        body.append(text)
    width, height = len(kinds) * (WIDTH + LEFT + 14) + 10, TOP + HEIGHT + 66
    at = LEFT
    for i, name in enumerate(names):
        colour = "black" if name == "all" else COLOURS[i % len(COLOURS)]
        body.append(f'<line x1="{at:.0f}" x2="{at + 20:.0f}" y1="{height - 12}" y2="{height - 12}" stroke="{colour}" '
                    f'stroke-width="{3 if name == "all" else 1.2}"/><text x="{at + 25:.0f}" y="{height - 8}">{name}</text>')
        at += 45 + 7 * len(name)
    body.append(f'<text x="{width / 2}" y="{TOP + HEIGHT + 34}" text-anchor="middle">factor of the execution margin</text>')
    with open(out, "w") as stream:
        stream.write(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" '
                     f'font-family="sans-serif" font-size="12">\n<rect width="100%" height="100%" fill="white"/>\n'
                     + "\n".join(body) + "\n</svg>\n")


if __name__ == "__main__":
    main()
