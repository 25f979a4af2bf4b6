#!/usr/bin/env python3
"""Holds the program's own check against the independent one, a row for each scenario.

    python3 compare.py LOCOGRAPH FOLDER [SCENARIO…] [--seed 3] [--every 10]

Plans each scenario into FOLDER/SCENARIO.g2o, judges it with `check --json`, checks it here, and
prints where they disagree. Not every seed finds a plan: the next ones are tried, four in all. Of
parallel walls the stances are planned, as motions between them are not found since balls roll, by
25 seeds with a tenth of the transitions each: those that find a way do so soon. Exit code 1: they
disagree somewhere, or no plan was found.

Plans of format 2 made by programs that joined vertices by straight lines are not judged as curves:
of those only what holds at vertices is compared.
"""

import argparse
import json
import os
import subprocess
import sys
import time

sys.dont_write_bytecode = True

from check_plan import Checker

AT_VERTICES = {"stance", "contact_claims", "base_orientation", "contact_position",
               "contact_orientation", "contact_relabelled", "contact_on_surface", "scenario_start",
               "scenario_goals", "time_order", "joint_limits"}
TRIES = 4
STANCES_ONLY = ("parallel_walls",)
TRIES_OF_STANCES, MOST_TRANSITIONS = 25, "2000"
# The same numbers, worked out twice: these differ by no more than 1 % and this.
EXACT = {"contact_position": 1e-9, "contact_orientation": 1e-8}
ON_THE_CURVE = {"joint_limits": 1e-6, "velocity_limits": 1e-6, "acceleration_limits": 1e-6,
                "end_at_rest": 1e-9}
# Sampled elsewhere or bounded by the judge: no larger here by more than 5 % and this.
SAMPLED = {"contact_between": 1e-5, "contact_motion": 1e-5, "contact_turn": 1e-4,
           "lateral_slip": 1e-4, "longitudinal_slip": 1e-4, "base_velocity": 1e-3}
MARGIN, SAME_MARGIN, SAME_RATIO = 1e-3, 1e-5, 1e-4


def run(command):
    begin = time.time()
    done = subprocess.run(command, capture_output=True, text=True)
    return done, time.time() - begin


class Row:
    """One scenario: what both say, and what of it differs."""

    def __init__(self, name):
        self.name, self.differs, self.cells, self.notes = name, [], {}, []

    def compare(self, judged, checker):
        report, by_name = checker.report, {v["constraint"]: v for v in judged["violations"]}
        curve = checker.plan.format != 2
        if not curve:
            self.notes.append("format 2: vertices only")
        for name, own in report.constraints.items():
            theirs = by_name.get(name)
            if own.worst is None or theirs is None or not (curve or name in AT_VERTICES):
                continue
            if not theirs["judged"]:
                self.differs.append(f"{name} is not judged")
                continue
            no = theirs["violated"]
            if name == "static_balance":     # where only torques fail, the judge says so of those
                no = no or by_name["torque_limits"]["violated"]
            self._verdict(name, own, theirs, no)
            worst = theirs["worst"]
            if worst is not None and own.worst != float("inf"):
                self._worst(name, own.worst, worst, curve)
        for name in report.constraints.keys() - by_name.keys():
            if report.constraints[name].violated and (curve or name in AT_VERTICES):
                self.differs.append(f"{name} is violated here ({report.worst(name):.3g})"
                                    + (", judged feasible" if judged["feasible"] else ""))
        if judged["configurations"] != len(checker.plan.q):
            self.differs.append("another number of configurations")
        if curve:
            self._balance(judged, checker, by_name)
        others = [v["constraint"] for v in judged["violations"] if v["violated"]]
        if others:
            self.notes.append("judge: " + ", ".join(others))

    def _verdict(self, name, own, theirs, no):
        if own.violated == no:
            return
        near = abs(theirs["worst"] - own.limit) <= 0.05 * abs(own.limit)
        if name in SAMPLED and near:
            return
        self.differs.append(f"{name}: {'violated' if own.violated else 'holds'} here ({own.worst:.4g} at "
                            f"vertex {own.at_vertex}), judge {theirs['worst']:.4g}")

    def _worst(self, name, own, theirs, curve):
        if name in EXACT or (name in ON_THE_CURVE and curve):
            room = EXACT.get(name, ON_THE_CURVE.get(name))
            if abs(own - theirs) > 0.01 * abs(theirs) + room:
                self.differs.append(f"{name}: {own:.6g} here, judge {theirs:.6g}")
        elif name in SAMPLED and own > 1.05 * theirs + SAMPLED[name]:
            self.differs.append(f"{name}: {own:.6g} here, judge only {theirs:.6g}")

    def _balance(self, judged, checker, by_name):
        least, own = judged["min_balance_margin"], checker.report.worst("static_balance")
        if least is None or own is None or by_name["torque_limits"]["violated"]:
            return
        if least >= 0.0 and own < least - MARGIN:
            self.differs.append(f"margin {own:.5f} here, judge's least {least:.5f}")
        if checker.trusted:
            self.notes.append("on trust: " + ", ".join(sorted(checker.trusted)))
            return
        place = by_name["static_balance"]["time"]
        # Where nothing balances, the judge tells the margin without torque limits.
        there = [s.margin if s.without_torques is None else s.without_torques
                 for s in checker.spots if s.wanted and _is_at(checker, s, place)]
        if there and abs(min(there) - least) > SAME_MARGIN:
            self.differs.append(f"margin {min(there):.6f} at {place:.4f} s, judge {least:.6f}")
        self.cells["at its place"] = min(there) if there else None
        ratio, place = judged["max_torque_ratio"], by_name["torque_limits"]["time"]
        there = [s.torque_ratio for s in checker.spots
                 if s.torque_ratio is not None and _is_at(checker, s, place)]
        if ratio is not None and there and abs(max(there) - ratio) > SAME_RATIO:
            self.differs.append(f"torque ratio {max(there):.5f} at {place:.4f} s, judge {ratio:.5f}")


def _is_at(checker, spot, moment):
    return abs(checker.curve.time_at(min(spot.step, checker.curve.steps - 1),
                                     spot.fraction + max(0, spot.step - checker.curve.steps + 1))
               - moment) < 1e-6


def compare(binary, name, asked):
    row = Row(name)
    file = os.path.join(asked.folder, f"{name}.g2o")
    seconds = 0.0
    options, tries = [], TRIES
    if name in STANCES_ONLY:
        options, tries = ["--stances-only", "--max-transitions", MOST_TRANSITIONS], TRIES_OF_STANCES
    for seed in range(asked.seed, asked.seed + tries):
        done, more = run([binary, "plan", name, "-o", file, "--seed", str(seed), "--quiet"] + options)
        seconds += more
        if done.returncode == 0:
            break
    planned = f"{seconds:.0f} s"
    if done.returncode != 0:
        row.differs.append(f"not planned: {(done.stdout + done.stderr).strip()[-200:]}")
        return row, planned, None, None
    done, judging = run([binary, "check", file, "--json", "--quiet"])
    if done.returncode not in (0, 1) or not done.stdout.strip():
        row.differs.append(f"not judged: {done.stderr.strip()[-200:]}")
        return row, planned, None, None
    judged = json.loads(done.stdout)
    begin = time.time()
    checker = Checker(file, asked.data)
    also = [v["time"] for v in judged["violations"]
            if v["constraint"] in ("static_balance", "torque_limits") and v["judged"]]
    checker.run(asked.every, also)
    row.compare(judged, checker)
    row.cells["seconds"] = (judging, time.time() - begin)
    return row, planned, judged, checker


def pair(own, theirs):
    text = lambda x: "-" if x is None else f"{x:.3g}"
    return f"{text(own)} / {text(theirs)}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("locograph")
    parser.add_argument("folder")
    parser.add_argument("scenarios", nargs="*")
    parser.add_argument("--seed", type=int, default=3)
    parser.add_argument("--every", type=int, default=10)
    parser.add_argument("--data", help="where robots and scenarios that come along are")
    asked = parser.parse_args()
    os.makedirs(asked.folder, exist_ok=True)
    names = asked.scenarios or run([asked.locograph, "list", "scenarios"])[0].stdout.split()
    agreed = 0
    print("| scenario | planned | vertices | holds here / judge | contact [µm] | between [µm]"
          " | in total [µm] | velocity | margin | at the judge's place | agree |")
    print("|---|---|---|---|---|---|---|---|---|---|---|")
    for name in names:
        row, planned, judged, checker = compare(asked.locograph, name, asked)
        agreed += not row.differs
        cells = [name, planned]
        if judged:
            worst = {v["constraint"]: v["worst"] for v in judged["violations"]}
            own = checker.report.worst
            micro = lambda n: pair(*(None if x is None else 1e6 * x for x in (own(n), worst.get(n))))
            cells += [str(len(checker.plan.q)), f"{checker.report.feasible} / {judged['feasible']}",
                      micro("contact_position"), micro("contact_between"), micro("contact_motion"),
                      pair(own("velocity_limits"), worst.get("velocity_limits")),
                      pair(own("static_balance"), judged["min_balance_margin"]),
                      pair(row.cells.get("at its place"), judged["min_balance_margin"])]
        print("| " + " | ".join(cells + ["no" if row.differs else "yes"]) + " |")
        for line in row.differs:
            print(f"  differs: {name}: {line}")
        for line in row.notes:
            print(f"  note: {name}: {line}")
        sys.stdout.flush()
    print(f"{agreed} of {len(names)} agree")
    return 0 if agreed == len(names) else 1


if __name__ == "__main__":
    sys.exit(main())
