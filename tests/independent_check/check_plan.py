#!/usr/bin/env python3
"""Checks a plan against its scenario with nothing but the files: contacts, limits, rest, balance.

    python3 check_plan.py PLAN.g2o [--json] [--every 10]
                                   [--torque-limits enforce|report] [--data FOLDER]

Prints each constraint, its worst value, the limit and where it is. Exit code 1: something is
violated, 2: a file cannot be used. Collisions are not looked at.
"""

import argparse
import bisect
import json
import os
import sys

sys.dont_write_bytecode = True

import numpy as np

from balance import Holder
from contacts import Traces, false_claims
from curve import Curve
from dynamics import required
from held import check_contacts, check_relabelled, stances_at
from kinematics import Links
from motion_limits import check_configurations, check_motion, check_times
from plan_file import Plan
from report import Report
from scenario_file import Data, Scenario, find_scenario
from support import bar_under_ball
from task_ends import check_ends
from urdf import Robot

SOURCES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")


class Checker:
    """A plan, its scenario and robot, and the report on them."""

    def __init__(self, file, data=None, torque_limits=None):
        data = Data(data or os.environ.get("LOCOGRAPH_DATA") or SOURCES)
        self.plan, self.report = Plan(file), Report()
        plan = self.plan
        if plan.scenario is None:
            raise ValueError(f"{file}: the plan names no scenario")
        self.scenario = Scenario(find_scenario(plan.scenario, plan.folder, data), data)
        scenario = self.scenario
        self.robot = Robot(scenario.urdf, scenario.srdf, scenario.active, scenario.state)
        if plan.robot_words[0 if plan.robot_words[0] == "floating" else 2] != "floating":
            raise ValueError(f"{file}: the base is fixed")
        plan.split(len(self.robot.active))
        with np.errstate(divide="ignore", invalid="ignore"):
            self.curve = Curve(plan)
        enforce = scenario.enforce_torques if torque_limits is None else torque_limits == "enforce"
        self.holder = Holder(self.robot, scenario, scenario.effectors, enforce)
        self.trusted = set()
        # Where times do not increase there is no curve: vertices are looked at all the same.
        self.moves = not plan.stances_only and bool((np.diff(plan.time) > 0.0).all())

    def run(self, every=10, also=()):
        """also: times at which balance is looked at, too."""
        plan, report = self.plan, self.report
        touched = {c.name for stance in plan.stances.values() for c in stance}
        effectors = {n: e for n, e in self.scenario.effectors.items() if n in touched}
        self._claims()
        check_configurations(report, plan, self.robot)
        traces = Traces(self.robot, self.curve, effectors, moves=self.moves)
        for contact in (c for stance in plan.stances.values() for c in stance if c.name in effectors):
            contact.round = bar_under_ball(contact, effectors[contact.name], self.scenario)
        check_contacts(report, plan, self.curve if self.moves else None, traces, self.scenario, effectors)
        check_relabelled(report, plan)
        if not plan.stances_only:
            check_times(report, plan)
        if self.moves and self.curve.steps:
            check_motion(report, plan, self.robot, self.scenario, self.curve)
        check_ends(report, plan, self.scenario)
        self.spots = self._balance(every, also)
        if self.trusted:
            report.tell("on trust: the world has nothing known there", ", ".join(sorted(self.trusted)))
        return report

    def _claims(self):
        plan = self.plan
        missing = [i for i in range(max(1, len(plan.q) - 1)) if plan.stance[i] not in plan.stances]
        self.report.add("stance", float(len(missing)), 0, "count",
                        plan.ids[missing[0]] if missing else plan.ids[0], 0.0)
        for number in set(plan.stance) - {None}:
            for contact in plan.stances[number]:
                wrong = false_claims(contact, self.scenario.effectors.get(contact.name))
                self.report.add("contact_claims", float(bool(wrong)), 0, "count", plan.ids[0], 0.0, wrong)

    def _vertices(self, every):
        """To look at: every so many, the ends, and where the stance changes."""
        plan, count = self.plan, len(self.plan.q)
        vertices = set(range(0, count, every)) | {0, count - 1}
        return vertices | {i for i in range(1, count) if plan.stance[i] != plan.stance[i - 1]}

    def _place(self, time):
        """The step and fraction of a time."""
        step = min(max(bisect.bisect_right(self.plan.time.tolist(), time) - 1, 0), self.curve.steps - 1)
        return step, (time - self.plan.time[step]) / self.curve.duration[step]

    def _balance(self, every, also):
        """What was found: Spots with their margins."""
        vertices, found, between = self._vertices(every), [], []
        wanted = set()
        for time in also if self.moves and self.curve.steps else ():
            step, fraction = self._place(time)
            if 1e-6 < fraction < 1.0 - 1e-6:
                between.append(Spot(step, fraction, step, "on the way from it", True))
            else:
                wanted.add(step + round(fraction))
        still = vertices | wanted if not self.moves else {0, len(self.plan.q) - 1}
        self._at_rest(sorted(still), wanted, found)
        if self.moves and self.curve.steps:
            self._in_motion(sorted(vertices | wanted), wanted, between, found)
        for spot in found:
            self.report.add("static_balance", spot.margin, 0.0, "1", self.plan.ids[spot.vertex],
                            self.plan.time[spot.vertex], f"{spot.what}, {spot.when}", least=True, slack=1e-6)
        return found

    def _at_rest(self, vertices, wanted, found):
        links = Links(self.robot, self.plan.q[vertices])
        demand = required(links)
        for t, vertex in enumerate(vertices):
            for number in stances_at(self.plan, vertex):
                spot = Spot(vertex, 0.0, vertex, "at rest", vertex in wanted)
                found.append(self._judge(spot, links, t, demand[t], number))

    def _in_motion(self, vertices, wanted, between, found):
        spots = [Spot(v - 1, 1.0, v, "before it", v in wanted) for v in vertices if v > 0]
        spots += [Spot(v, 0.0, v, "after it", v in wanted) for v in vertices if v < self.curve.steps]
        spots += between
        links = Links(self.robot, *self.curve.at([s.step for s in spots], [s.fraction for s in spots]))
        demand = required(links)
        for t, spot in enumerate(spots):
            found.append(self._judge(spot, links, t, demand[t], self.plan.stance[spot.step]))

    def _judge(self, spot, links, t, demand, number):
        contacts = [c for c in self.plan.stances.get(number, []) if c.name in self.scenario.effectors]
        answer = self.holder.margin(links, t, demand, contacts, torques=spot.wanted)
        spot.margin, spot.what, spot.torque_ratio = answer.margin, answer.limiting, answer.torque_ratio
        spot.without_torques = answer.without_torques
        for contact, support in zip(contacts, answer.supports):
            if not support.known and self.scenario.scans:
                self.trusted.add(contact.name)
                continue
            off = support.outside if support.known else np.inf
            self.report.add("contact_on_surface", off, 1e-4, "m", self.plan.ids[spot.vertex],
                            self.plan.time[spot.vertex], contact.name)
        return spot


class Spot:
    """A place along the plan at which balance is looked at; wanted: because it was asked for."""

    def __init__(self, step, fraction, vertex, when, wanted):
        self.step, self.fraction, self.vertex, self.when, self.wanted = step, fraction, vertex, when, wanted
        self.margin = self.what = self.torque_ratio = self.without_torques = None


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("plan")
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--every", type=int, default=10, help="balance at each so-many-th vertex")
    parser.add_argument("--torque-limits", choices=("enforce", "report"))
    parser.add_argument("--data", help="where robots and scenarios that come along are")
    asked = parser.parse_args()
    try:
        checker = Checker(asked.plan, asked.data, asked.torque_limits)
    except (ValueError, OSError) as problem:
        print(f"check_plan: {problem}", file=sys.stderr)
        return 2
    report = checker.run(max(1, asked.every))
    print(json.dumps(report.as_dict(), indent=2) if asked.json else report.text())
    return 0 if report.feasible else 1


if __name__ == "__main__":
    sys.exit(main())
