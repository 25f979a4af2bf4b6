#!/usr/bin/env python3
"""Plans that lie: a good plan is changed in one way after the other, and both checks have to see it.

    python3 test_lies.py LOCOGRAPH FOLDER          # the folder keeps the plan, for the next time
"""

import json
import os
import subprocess
import sys
import unittest

sys.dont_write_bytecode = True

import numpy as np

from check_plan import Checker

SCENARIO = "standing_up"
EVERY = 50           # vertices between looks at balance
BINARY = FOLDER = None


class Lines:
    """A plan as words of lines, and where its configurations are among them."""

    def __init__(self, file):
        with open(file, encoding="utf-8") as lines:
            self.rows = [line.split() for line in lines if not line.startswith("EDGE")]
        # What segments and wrenches say would be refused before a lie is looked at.
        self.rows = [r for r in self.rows if r and r[0] not in ("PARAMS_SEGMENT", "VERTEX_WRENCHES")]
        self.vertices = [r for r in self.rows if r[0] == "VERTEX_CONFIGURATION"]
        self.joints = None

    def add(self, vertex, number, amount):
        """To number 0 1 2 … of a vertex: x y z qx …"""
        words = self.vertices[vertex]
        words[5 + number] = repr(float(words[5 + number]) + amount)

    def times(self, change):
        for words in self.vertices:
            words[3] = repr(change(float(words[3])))

    def slopes(self, factor, joints):
        for words in self.vertices:
            first = 5 + 7 + joints
            words[first:] = [repr(factor * float(w)) for w in words[first:]]

    def write(self, file):
        with open(file, "w", encoding="utf-8") as out:
            out.writelines(" ".join(row) + "\n" for row in self.rows)


class Lies(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        os.makedirs(FOLDER, exist_ok=True)
        cls.plan = os.path.join(FOLDER, f"{SCENARIO}.g2o")
        subprocess.run([BINARY, "plan", SCENARIO, "-o", cls.plan, "--seed", "3", "--quiet"],
                       check=True, capture_output=True)
        cls.checker = Checker(cls.plan)
        cls.joints = len(cls.checker.robot.active)
        cls.middle = len(cls.checker.plan.q) // 2
        cls.format = cls.checker.plan.format

    def setUp(self):
        self.lines = Lines(self.plan)

    def seen(self, *constraints):
        """Both say no, and this one for one of these reasons."""
        file = os.path.join(FOLDER, "lie.g2o")
        self.lines.write(file)
        report = Checker(file).run(every=EVERY)
        violated = {c.name for c in report.constraints.values() if c.violated}
        self.assertTrue(violated & set(constraints), f"only {violated} seen, not {constraints}")
        judged = subprocess.run([BINARY, "check", file, "--json", "--quiet"], capture_output=True, text=True)
        self.assertIn(judged.returncode, (1, 2), "the program's own check believes it")
        if judged.returncode == 1:
            judged = json.loads(judged.stdout)
            self.assertFalse(judged["feasible"])
            violated = {v["constraint"] for v in judged["violations"] if v["violated"]}
            self.assertTrue(violated & {*constraints, "torque_limits"},
                            f"the program's own check sees {violated}, not {constraints}")
        os.remove(file)

    def test_truth_is_believed(self):
        file = os.path.join(FOLDER, "truth.g2o")
        self.lines.write(file)
        report = Checker(file).run(every=EVERY)
        os.remove(file)
        violated = [c.name for c in report.constraints.values() if c.violated]
        if self.format == 2:      # made by a program that joined vertices by straight lines
            violated = [name for name in violated if name != "static_balance"]
        self.assertEqual(violated, [])

    def test_slopes_by_the_rule_may_be_written(self):
        file = os.path.join(FOLDER, "slopes.g2o")
        for words, slope in zip(self.lines.vertices, self.checker.curve.slope):
            words[5 + 7 + self.joints:] = [repr(float(x)) for x in slope]
        self.lines.write(file)
        written = Checker(file)
        os.remove(file)
        for own, theirs in ((written.curve.second, self.checker.curve.second),
                            (written.curve.third, self.checker.curve.third)):
            np.testing.assert_array_equal(own, theirs)

    def test_base_aside(self):
        self.lines.add(self.middle, 0, 1e-3)
        self.seen("contact_position")

    def test_base_turned(self):
        self.lines.add(self.middle, 3, 2e-3)
        self.seen("contact_position", "base_orientation")

    def test_joint_turned(self):
        self.lines.add(self.middle, 7, 2e-3)
        self.seen("contact_position")

    def test_joint_beyond_its_limit(self):
        self.lines.add(self.middle, 8, 3.5)
        self.seen("joint_limits")

    def test_three_times_as_fast(self):
        self.lines.times(lambda t: t / 3.0)
        self.lines.slopes(3.0, self.joints)
        self.seen("static_balance", "velocity_limits")

    def test_ten_times_as_fast(self):
        self.lines.times(lambda t: t / 10.0)
        self.lines.slopes(10.0, self.joints)
        self.seen("velocity_limits")

    def test_backwards(self):
        last = float(self.lines.vertices[-1][3])
        self.lines.times(lambda t: last - t)
        self.seen("scenario_goals", "scenario_start")

    def test_times_that_meet(self):
        self.lines.vertices[self.middle][3] = self.lines.vertices[self.middle + 1][3]
        self.seen("time_order")

    def test_time_before_the_clock(self):
        if self.format == 2:
            self.skipTest("format 2")
        self.lines.times(lambda t: t - 1.0)
        self.seen("time_order")

    def test_stances_exchanged(self):
        rows = [r for r in self.lines.rows if r[0] == "PARAMS_STANCE"]
        swapped = {rows[1][1]: rows[2][1], rows[2][1]: rows[1][1]}
        for words in self.lines.vertices:
            words[4] = swapped.get(words[4], words[4])
        self.seen("contact_position")

    def test_contact_elsewhere(self):
        used = {number for r in self.lines.rows if r[0] == "PARAMS_STANCE" for number in r[3:]}
        contact = [r for r in self.lines.rows if r[0] == "PARAMS_CONTACT" and r[1] in used][-1]
        k = contact.index("at")
        contact[k + 1] = repr(float(contact[k + 1]) + 5e-4)
        self.seen("contact_position", "contact_relabelled")

    def test_more_friction_than_known(self):
        for words in self.lines.rows:
            if words[0] == "PARAMS_CONTACT":
                words[8 if words[5] == "surface" else 7] = "2.0"
        self.seen("contact_claims")

    def test_another_radius(self):
        for words in self.lines.rows:
            if words[0] == "PARAMS_CONTACT" and words[5] == "point":
                words[6] = repr(0.5 * float(words[6]))
        self.seen("contact_claims")

    def test_goal_not_reached(self):
        for words in self.lines.vertices[-len(self.lines.vertices) // 3:]:
            self.lines.rows.remove(words)
        self.seen("scenario_goals")

    def test_slope_at_the_beginning(self):
        if self.format == 2:
            self.skipTest("no slopes in format 2")
        words = self.lines.vertices[0]
        words[5 + 7 + self.joints:] = ["0"] * (6 + self.joints)
        words[-1] = "0.2"
        self.seen("end_at_rest")

    def test_slope_that_swings_out(self):
        if self.format == 2:
            self.skipTest("no slopes in format 2")
        slope = self.checker.curve.slope[self.middle] + np.array([0.0, 0.0, 0.5] + [0.0] * (3 + self.joints))
        self.lines.vertices[self.middle][5 + 7 + self.joints:] = [repr(float(x)) for x in slope]
        self.seen("contact_between", "static_balance")

    def test_swings_between_fine_vertices(self):
        """Slowly, and back at each vertex and midway between two of them."""
        if self.format == 2:
            self.skipTest("no slopes in format 2")
        curve, stance = self.checker.curve, self.checker.plan.stance
        first = max(range(40, len(stance) - 30), key=lambda k: len(set(stance[k - 1:k + 25])) == 1)
        slow, parts, rows = 1500.0, 20, []
        for k, words in enumerate(self.lines.vertices):
            fine = first <= k < first + 20
            fractions = np.arange(parts if fine else 1) / parts
            at = curve.at([min(k, curve.steps - 1)] * len(fractions), fractions)
            for i, s in enumerate(fractions):
                q, slope = (at[0][i], at[1][i]) if i else (words[5:12 + self.joints], curve.slope[k])
                time = curve.time[k] + (s * curve.duration[k] if fine else 0.0)
                slope = np.array(slope) / slow
                if fine:
                    swing = 0.015 * min(1.0, (k - first + s) / 4, (first + 20 - k - s) / 4)
                    slope[1] += swing / (slow * curve.duration[k] / parts)
                rows.append([words[0], str(len(rows)), words[2], repr(float(slow * time)), words[4],
                             *(x if isinstance(x, str) else repr(float(x)) for x in q),
                             *(repr(float(x)) for x in slope)])
        self.lines.rows = [r for r in self.lines.rows if r[0] not in ("VERTEX_CONFIGURATION", "FIX")] + rows
        self.seen("contact_between", "contact_motion")


if __name__ == "__main__":
    if len(sys.argv) < 3:
        print(__doc__, file=sys.stderr)
        sys.exit(2)
    BINARY, FOLDER = sys.argv[1:3]
    unittest.main(argv=[sys.argv[0]] + sys.argv[3:])
