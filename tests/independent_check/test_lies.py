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

import rotations
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
            # numpy's sums depend on where an array lies in memory, in the last bit
            np.testing.assert_allclose(own, theirs, rtol=0.0, atol=1e-12 * np.abs(theirs).max())

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


BALL = """<robot name="ball"><link name="ball"><inertial><mass value="2"/><inertia ixx="1e-3" ixy="0"
ixz="0" iyy="1e-3" iyz="0" izz="1e-3"/></inertial><collision><geometry><sphere radius="0.03"/></geometry>
</collision></link><link name="arm"><inertial><mass value="0.01"/><inertia ixx="1e-5"
ixy="0" ixz="0" iyy="1e-5" iyz="0" izz="1e-5"/></inertial></link><joint name="elbow" type="revolute">
<parent link="ball"/><child link="arm"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" velocity="1" effort="1"/></joint></robot>"""
BALL_ROLLS = """<scenario version="1" name="ball_rolls"><robot urdf="ball.urdf"/><end_effectors>
<end_effector name="ball" link="ball" kind="point" radius="0.03" max_force="100"/>
<end_effector name="tip" link="arm" kind="point" max_force="100" point="0.2 0 0"/></end_effectors>
<environment friction="0.5"><plane name="table" center="0 0 0" normal="0 0 1" size="1 1"/>
<rung name="bar" from="3 -1 1" to="3 1 1" radius="0.02"/></environment>
<start base="{base} 0 0 0 1"><contact end_effector="ball" position="{place}" normal="0 0 1"/></start>
<goal><contact end_effector="ball" position="{place}" normal="0 0 1"/></goal></scenario>"""


class Balls(unittest.TestCase):
    """A ball that is told how to move on a table, or on a bar: both checks say the same of it."""

    PLACES = {"table": ("0 0 0.03", "0 0 0"), "bar": ("3 0 1.05", "3 0 1.02")}

    def slip(self, on, way, turn, stances_only=False):
        """How far the skin slips, by both, and what both see; way: of the centre at s = 0 … 1 from
        where it touches down, turn: the rotation vector there, of a fixed axis."""
        base, place = self.PLACES[on]
        os.makedirs(FOLDER, exist_ok=True)
        files = {"ball.urdf": BALL, "ball.xml": BALL_ROLLS.format(base=base, place=place)}
        contact = f"PARAMS_CONTACT 2 0 ball ball point 0.03 0.5 100 0 0 0 0 0 1 1 0 0 at {place} 0 0 1 free"
        lines = ["PARAMS_ROBOT 0 ball.urdf - floating 0", "PARAMS_SCENARIO 1 ./ball.xml", contact,
                 "PARAMS_STANCE 3 1 2", "PARAMS_PLAN 4 3" + " stances_only" * stances_only]
        last = np.array(base.split(), float) + way(1.0) + rotations.exp(np.array(turn, float)) @ [0.2, 0, 0]
        # Something else touches down as a plan of stances goes on.
        at = " ".join(repr(float(x)) for x in last)
        lines += [f"PARAMS_CONTACT 5 0 tip arm point 0 0.5 100 0.2 0 0 0 0 1 1 0 0 at {at} 0 0 1 free",
                  "PARAMS_STANCE 6 2 2 5"] * stances_only
        count = 1 if stances_only else 80
        for k in range(count + 1):
            s = k / count
            centre = np.array(base.split(), float) + way(s)
            quaternion = rotations.quaternion(rotations.exp(s * np.array(turn, float)))
            time = k if stances_only else 0.5 * k
            numbers = " ".join(repr(float(x)) for x in [*centre, *quaternion])
            stance = 6 if stances_only and k == count else 3
            lines.append(f"VERTEX_CONFIGURATION {k} 0 {time} {stance} {numbers} 0")
        files["ball.g2o"] = "\n".join(lines) + "\n"
        for name, text in files.items():
            with open(os.path.join(FOLDER, name), "w", encoding="utf-8") as out:
                out.write(text)
        file = os.path.join(FOLDER, "ball.g2o")
        report = Checker(file).run(every=EVERY)
        judged = subprocess.run([BINARY, "check", file, "--json", "--quiet"], capture_output=True, text=True)
        self.assertIn(judged.returncode, (0, 1), judged.stderr)
        judged = json.loads(judged.stdout)
        theirs = {v["constraint"]: v for v in judged["violations"]}
        same = ("contact_position", "contact_motion", "contact_on_surface")[:2 if stances_only else 3]
        for name in same:
            own = report.constraints[name]
            self.assertEqual(own.violated, theirs[name]["violated"], name)
            self.assertAlmostEqual(own.worst, theirs[name]["worst"], delta=1e-5)
        self.assertAlmostEqual(report.rolled["ball"], judged["max_ball_rolling_m"], delta=1e-5)
        return report.worst("contact_motion"), {n for n in same if report.constraints[n].violated}

    def test_rolls(self):
        for stances_only in (False, True):
            slip, seen = self.slip("table", lambda s: s * np.array([0.06, 0.03, 0]), [-1.0, 2.0, 0],
                                   stances_only)
            self.assertLess(slip, 1e-6)
            self.assertEqual(seen, set())

    def test_spins_about_the_normal(self):
        self.assertEqual(self.slip("table", lambda s: np.zeros(3), [0, 0, 2.5])[1], set())

    def test_slides(self):
        slip, seen = self.slip("table", lambda s: s * np.array([0.06, 0, 0]), [0, 0, 2.5])
        self.assertAlmostEqual(slip, 0.06, places=6)
        self.assertEqual(seen, {"contact_motion"})

    def test_turns_on_the_spot(self):
        slip, seen = self.slip("table", lambda s: np.zeros(3), [0, 1.0, 0])
        self.assertAlmostEqual(slip, 0.03, places=6)
        self.assertEqual(seen, {"contact_motion"})

    def test_rolls_off_the_edge(self):
        self.assertEqual(self.slip("table", lambda s: s * np.array([0.55, 0, 0]), [0, 0.55 / 0.03, 0])[1],
                         {"contact_on_surface"})

    def test_is_lifted(self):
        lifted = self.slip("table", lambda s: s * np.array([0, 0, 2e-4]), [0, 0, 0])
        self.assertEqual(lifted[1], {"contact_position"})

    def test_rolls_round_a_bar(self):
        around = lambda s: 0.05 * np.array([np.sin(0.5 * s), 0, np.cos(0.5 * s) - 1])
        slip, seen = self.slip("bar", around, [0, 0.5 * 5 / 3, 0])
        self.assertLess(slip, 1e-6)
        self.assertEqual(seen, set())
        slip, seen = self.slip("bar", around, [0, 0.5, 0])          # as if it were flat
        self.assertAlmostEqual(slip, 0.5 * 0.02, places=6)
        self.assertEqual(seen, {"contact_motion"})
        slip, seen = self.slip("bar", around, [0, 0.5 * 5 / 3, 0], stances_only=True)
        self.assertLess(slip, 1e-6)
        self.assertEqual(seen, set())

    def test_rolls_along_a_bar(self):
        self.assertEqual(self.slip("bar", lambda s: s * np.array([0, 0.3, 0]), [-10.0, 0, 0])[1], set())


if __name__ == "__main__":
    if len(sys.argv) < 3:
        print(__doc__, file=sys.stderr)
        sys.exit(2)
    BINARY, FOLDER = sys.argv[1:3]
    unittest.main(argv=[sys.argv[0]] + sys.argv[3:])
