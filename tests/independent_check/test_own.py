#!/usr/bin/env python3
"""Tests of the checker's own mechanics: rotations, curves, kinematics, dynamics, programmes.

    python3 test_own.py
"""

import os
import sys
import tempfile
import types
import unittest

sys.dont_write_bytecode = True

import numpy as np

import rotations
from balance import Holder
from contacts import Trace, closure, height_of_ball, normal_at
from curve import Curve
from dynamics import GRAVITY, effect, momentum, required
from held import spread
from kinematics import Links
from plan_file import Contact
from rolling import (WheelSlip, integrate, largest_change, shortest_turns, skin_velocity,
                     touch_velocity)
from scenario_file import Data, Scenario
from support import clip, rectangle
from urdf import Robot

SOURCES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
DATA = Data(os.environ.get("LOCOGRAPH_DATA") or SOURCES)


def wild_plan(joints, count=5, seed=1):
    """Numbers of a plan that moves everything."""
    random = np.random.default_rng(seed)
    q = random.normal(scale=0.4, size=(count, 7 + joints))
    q[:, 3:7] = [0, 0, 0, 1] + 0.3 * q[:, 3:7]
    q[:, 3:7] /= np.linalg.norm(q[:, 3:7], axis=1, keepdims=True)
    return types.SimpleNamespace(q=q, time=np.cumsum(random.uniform(0.2, 0.6, count)),
                                 slopes=[None] * count, stance=[0] * count, ids=list(range(count)))


class Rotations(unittest.TestCase):
    def test_log_undoes_exp(self):
        for length in (0.0, 1e-9, 1e-3, 0.5, 2.0, 3.1):
            v = length * np.array([0.6, -0.48, 0.64])
            np.testing.assert_allclose(rotations.log(rotations.exp(v)), v, atol=1e-12)

    def test_quaternions(self):
        for v in ([0, 0, 0], [3, 0.1, 0], [0, -3, 0.2], [0.1, 0, 3.1], [0.5, 0.4, 0.3]):
            m = rotations.exp(v)
            np.testing.assert_allclose(rotations.from_quaternion(rotations.quaternion(m)), m, atol=1e-12)

    def test_own_rates_are_derivatives(self):
        for scale in (1.0, 3e-3):
            a, b, c = scale * np.array([[0.4, -0.7, 0.2], [0.3, 0.5, -0.9], [-0.6, 0.1, 0.4]])
            at = lambda t: (a + t * b + t * t * c, b + 2 * t * c, 2 * c)
            h = 1e-5
            turn = lambda t: rotations.exp(at(t)[0])
            velocity, acceleration = rotations.own_rates(*at(0.3))
            stepped = rotations.log(turn(0.3 - h).T @ turn(0.3 + h)) / (2 * h)
            np.testing.assert_allclose(velocity, stepped, atol=1e-8 * max(scale, 0.1))
            ahead, behind = (rotations.own_rates(*at(0.3 + k * h))[0] for k in (1, -1))
            np.testing.assert_allclose(acceleration, (ahead - behind) / (2 * h), atol=1e-8)


class Curves(unittest.TestCase):
    def test_rates_are_derivatives_and_go_on_at_vertices(self):
        plan = wild_plan(3)
        curve = Curve(plan)
        h = 1e-6
        q, rate, acceleration = curve.at([1], [0.4])
        s = h / curve.duration[1]
        (q0, r0, _), (q1, r1, _) = (curve.at([1], [0.4 + k * s]) for k in (-1, 1))
        np.testing.assert_allclose(rate[0, :3], (q1 - q0)[0, :3] / (2 * h), atol=1e-7)
        before, after = (rotations.from_quaternion(q[0, 3:7]) for q in (q0, q1))
        turned = rotations.log(before.T @ after)
        np.testing.assert_allclose(rate[0, 3:6], turned / (2 * h), atol=1e-7)
        np.testing.assert_allclose(acceleration, (r1 - r0) / (2 * h), atol=1e-6)
        for vertex in (1, 2, 3):
            before, after = curve.at([vertex - 1], [1.0]), curve.at([vertex], [0.0])
            np.testing.assert_allclose(before[1], after[1], atol=1e-12)
            np.testing.assert_allclose(after[1][0], curve.slope[vertex], atol=1e-12)
            there = np.sign(before[0][0, 3:7] @ after[0][0, 3:7])
            np.testing.assert_allclose(before[0][:, 3:7], there * after[0][:, 3:7], atol=1e-12)

    def test_ends_and_changes_of_stance_are_at_rest(self):
        plan = wild_plan(2)
        plan.stance = [0, 0, 1, 1, 1]
        slope = Curve(plan).slope
        self.assertEqual([bool(row.any()) for row in slope], [False, True, False, True, False])

    def test_stored_slopes_count(self):
        plan = wild_plan(2)
        plan.slopes[0] = np.full(8, 0.1)
        self.assertTrue((Curve(plan).slope[0] == 0.1).all())

    def test_parabolas_are_met(self):
        plan = wild_plan(1)
        plan.q[:, 7] = 2.0 * plan.time**2 - plan.time
        np.testing.assert_allclose(Curve(plan).slope[1:-1, 6], 4.0 * plan.time[1:-1] - 1.0, atol=1e-12)

    def test_joints_turn_back_where_they_are_said_to(self):
        curve = Curve(wild_plan(4))
        found = curve.joint_extremes()
        for step, joint, k in zip(*np.nonzero(found)):
            rate = curve.at([step], [found[step, joint, k]])[1][0, 6 + joint]
            self.assertLess(abs(rate), 1e-9)


FINGERS = """<robot name="fingers"><link name="palm"/><link name="a"/><link name="b"/><link name="c"/>
<joint name="two" type="prismatic"><parent link="palm"/><child link="b"/><axis xyz="0 0 1"/>
<limit lower="-0.1" upper="0.3" velocity="1" effort="1"/>
<mimic joint="one" multiplier="-0.5" offset="0.1"/></joint>
<joint name="one" type="revolute"><parent link="palm"/><child link="a"/><axis xyz="1 0 0"/>
<limit lower="-2" upper="1" velocity="4" effort="1"/></joint>
<joint name="three" type="revolute"><origin xyz="0 0 1"/><parent link="b"/><child link="c"/>
<axis xyz="0 1 0"/><limit lower="0.2" upper="1" velocity="0" effort="1"/></joint></robot>"""
WORDS = """<robot name="fingers">
<group name="tips"><chain base_link="b" tip_link="c"/><joint name="two"/></group>
<group_state name="bent" group="tips"><joint name="one" value="-0.4"/><joint name="three" value="0.7"/>
</group_state></robot>"""


class Mimic(unittest.TestCase):
    def robot(self, **options):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in (("f.urdf", FINGERS), ("f.srdf", WORDS)):
                with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                    file.write(text)
            return Robot(os.path.join(folder, "f.urdf"), os.path.join(folder, "f.srdf"), **options)

    def test_followers(self):
        robot = self.robot()
        self.assertEqual(robot.active, ["three", "one"])     # depth first, children as in the file
        leader = robot.joint_named["one"]
        # -0.1 <= 0.1 - q / 2 <= 0.3, and half the speed of the follower's limit.
        np.testing.assert_allclose([leader.lower, leader.upper, leader.max_velocity], [-0.4, 0.4, 2.0])
        q = np.array([[0, 0, 0, 0, 0, 0, 1, 0.0, 0.2]])
        links = Links(robot, q)
        np.testing.assert_allclose(links.origin[robot.link_index["c"]][0], [0, 0, 1.0])
        did = effect(links, 0, robot.link_index["b"], np.zeros(3), [0, 0, 8.0], np.zeros((1, 3)))[0]
        np.testing.assert_allclose(did[6:], [0.0, -4.0])

    def test_frozen(self):
        robot = self.robot(active=["three"], frozen_state="bent")
        links = Links(robot, [0, 0, 0, 0, 0, 0, 1, 0.0])
        np.testing.assert_allclose(links.origin[robot.link_index["b"]][0], [0, 0, 0.3])
        self.assertEqual(robot.body("b"), "palm")
        self.assertEqual(self.robot(active=["tips"]).active, ["three", "one"])   # two stands for one
        self.assertEqual(self.robot(active=["one"]).joint_named["three"].frozen, 0.2)


class Dynamics(unittest.TestCase):
    def setUp(self):
        self.robot = Robot(*DATA.model("coman_plus"))
        self.curve = Curve(wild_plan(len(self.robot.active)))

    def links(self, s):
        return Links(self.robot, *self.curve.at([2], [s]))

    def test_velocities_are_derivatives(self):
        h, d = 1e-6, self.curve.duration[2]
        now, before, after = (self.links(0.3 + k * h / d) for k in (0, -1, 1))
        for k in range(len(self.robot.links)):
            np.testing.assert_allclose(
                now.velocity[k], (after.origin[k] - before.origin[k]) / (2 * h), atol=1e-6)
            np.testing.assert_allclose(
                now.acceleration[k], (after.velocity[k] - before.velocity[k]) / (2 * h), atol=1e-4)
            np.testing.assert_allclose(now.alpha[k], (after.omega[k] - before.omega[k]) / (2 * h), atol=1e-4)

    def test_demand_is_the_rate_of_momentum(self):
        h, d = 1e-5, self.curve.duration[2]
        now, before, after = (self.links(0.6 + k * h / d) for k in (0, -1, 1))
        force = required(now)[0]
        (l0, a0), (l1, a1) = momentum(before), momentum(after)
        weight = self.robot.mass * GRAVITY
        np.testing.assert_allclose(force[:3], (l1 - l0)[0] / (2 * h) - weight, atol=1e-3)
        about_origin = force[3:6] + np.cross(now.origin[0][0], force[:3])
        still = required(Links(self.robot, self.curve.at([2], [0.6])[0]))[0]
        gravity = still[3:6] + np.cross(now.origin[0][0], still[:3])
        np.testing.assert_allclose(about_origin, (a1 - a0)[0] / (2 * h) + gravity, atol=1e-3)

    def test_work_of_a_wrench(self):
        now = self.links(0.5)
        link = self.robot.link_index["LBall"]
        force, moment = np.array([3.0, -7.0, 11.0]), np.array([0.3, 0.2, -0.5])
        point = now.place(link, [0.1, 0.2, 0.3])[0]
        did = effect(now, 0, link, point, force, moment[None])[0]
        _, rate, _ = self.curve.at([2], [0.5])
        by_rates = did[:3] @ rate[0, :3] + did[3:6] @ now.omega[0][0] + did[6:] @ rate[0, 6:]
        by_point = force @ now.velocity_of(link, [0.1, 0.2, 0.3])[0] + moment @ now.omega[link][0]
        self.assertAlmostEqual(by_rates, by_point, places=9)


BLOCK = """<robot name="block"><link name="block"><inertial><origin xyz="{x} 0 0.4"/>
<mass value="10"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link></robot>"""
STANDS = """<scenario version="1" name="stands"><robot urdf="block.urdf"/><end_effectors>
<end_effector name="sole" link="block" kind="surface" half_x="0.1" half_y="0.05" max_force="{force}"/>
</end_effectors><environment friction="0.5">
<plane name="floor" center="{centre} 0 0" normal="0 0 1" size="1 1"/></environment></scenario>"""


class Balance(unittest.TestCase):
    def margin(self, x=0.0, force=1000, centre=0.0, push=0.0):
        """Of a block of 10 kg on a sole, its centre of mass at x, accelerated sideways by push."""
        with tempfile.TemporaryDirectory() as folder:
            for name, text in (("block.urdf", BLOCK.format(x=x)),
                               ("stands.xml", STANDS.format(force=force, centre=centre))):
                with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                    file.write(text)
            scenario = Scenario(os.path.join(folder, "stands.xml"), DATA)
            robot = Robot(scenario.urdf)
        holder = Holder(robot, scenario, scenario.effectors, enforce_torques=True)
        links = Links(robot, [0, 0, 0, 0, 0, 0, 1], np.zeros(6), [0, push, 0, 0, 0, 0])
        words = f"sole block surface 0.1 0.05 0.5 {force} 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 1 0 0"
        return holder.margin(links, 0, required(links)[0], [Contact(words.split())]).margin

    def test_margins_that_are_known(self):
        mu = 0.5 * np.cos(np.pi / 16)
        self.assertAlmostEqual(self.margin(), mu)                       # friction at each corner
        self.assertAlmostEqual(self.margin(x=0.03), mu * (1 - 0.3))     # that of the corners behind
        self.assertAlmostEqual(self.margin(force=150), 1 - 98.1 / 150)  # the force
        # Half of the sole lies on the floor: from 0 to 0.1.
        self.assertAlmostEqual(self.margin(x=0.04, centre=0.5), mu * (1 - 0.2))
        # Beyond its edge by d: tipping is met within |s| W m, friction widens by |s| W, too.
        self.assertLess(self.margin(x=0.11), 0.0)
        self.assertGreater(self.margin(x=0.11), -0.01)
        # 0.4 m above the sole, 1 m/s^2 moves what bears by 0.041 m of 0.05.
        self.assertAlmostEqual(self.margin(push=0.0), mu)
        self.assertLess(self.margin(push=1.0), mu * (1 - 0.8))
        self.assertGreater(self.margin(push=1.0), 0.0)
        self.assertLess(self.margin(push=1.3), 0.0)

    def test_clipping(self):
        part = clip(rectangle([2.0, 1.0]), np.array([1.0, 0.0]), 0.5)
        self.assertAlmostEqual(part[:, 0].max(), 0.5)
        self.assertEqual(len(clip(part, np.array([0.0, 1.0]), -2.0)), 0)


def rolling_trace(slide, radius, steps=10):
    """A wheel about y on z = 0 that rolls along x at 1 m/s, and slides along y as well."""
    shape = (steps, 9)
    s = np.linspace(0, 1, 9)
    x = (np.arange(steps)[:, None] + s) * 0.1
    point = np.stack([x, slide * x, np.full(shape, radius)], axis=-1)
    full = lambda v: np.broadcast_to(np.array(v, float), shape + (3,))
    return Trace(point, np.broadcast_to(np.eye(3), shape + (3, 3)), full([0, 1, 0]),
                 full([1, slide, 0]), full([0, 1 / radius, 0]))


class Rolling(unittest.TestCase):
    def contact(self, kind):
        words = ["w", "link", kind, "0.1", "0.8", "100", *"0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 free".split()]
        return Contact(words)

    def test_wheels(self):
        effector = types.SimpleNamespace(radius=0.1)
        for slide in (0.0, 0.03):
            slip = WheelSlip(self.contact("wheel"), effector, rolling_trace(slide, 0.1), np.full(10, 0.1))
            worst = {name: value for name, value, _ in slip.worst()}
            self.assertAlmostEqual(worst["longitudinal_slip"], 0.0)
            self.assertAlmostEqual(slip.way[-1], 1.0)
            # 3 mm within 0.1 m, and 30 mm of 25 mm in total.
            self.assertAlmostEqual(worst["lateral_slip"], 0.03 * 5 / 25 if slide else 0.0, places=9)

    def test_skin_of_balls(self):
        effector = types.SimpleNamespace(radius=0.1)
        slid = lambda trace: np.linalg.norm(integrate(
            skin_velocity(self.contact("point"), effector, trace), np.full(10, 0.1)), axis=1).max()
        trace = rolling_trace(0.0, 0.1)
        self.assertAlmostEqual(slid(trace), 0.0)
        trace.omega = trace.omega + np.array([0, 0, 5.0])    # spin is free
        self.assertAlmostEqual(slid(trace), 0.0)
        trace.omega = np.zeros_like(trace.omega)
        self.assertAlmostEqual(slid(trace), 1.0)
        way = integrate(touch_velocity(self.contact("point"), effector, trace), np.full(10, 0.1))
        self.assertAlmostEqual(np.linalg.norm(way[-1]), 1.0)

    def on_a_bar(self, angle, turn, along=0.0):
        """A ball of 0.03 m on a bar of 0.02 m along y, from its top round it and along it."""
        contact, effector = self.contact("point"), types.SimpleNamespace(radius=0.03)
        contact.round = types.SimpleNamespace(start=np.zeros(3), axis=np.array([0, 1.0, 0]), radius=0.02)
        phi = np.array([0.0, 0.5, 1.0]) * angle
        point = 0.05 * np.stack([np.sin(phi), 0 * phi, np.cos(phi)], axis=-1)
        point[:, 1] = along * np.array([0.0, 0.5, 1.0])
        rotation = rotations.exp(np.array([0.0, 0.5, 1.0])[:, None] * turn)
        trace = shortest_turns(contact, Trace(point, rotation, None))
        return contact, effector, trace

    def test_balls_roll_round_bars(self):
        slid = lambda *moment: integrate(skin_velocity(*moment), np.ones(2))[-1]
        around = np.array([0, 1.0, 0])
        np.testing.assert_allclose(slid(*self.on_a_bar(0.9, 0.9 * 5 / 3 * around)), 0.0, atol=1e-9)
        np.testing.assert_allclose(slid(*self.on_a_bar(0.9, 0.9 * around)), [0, 0.02 * 0.9], atol=1e-9)
        np.testing.assert_allclose(slid(*self.on_a_bar(0.0, 0.9 * around)), [0, -0.03 * 0.9], atol=1e-9)
        # Along the bar it rolls by turning across it; about the normal it spins.
        np.testing.assert_allclose(slid(*self.on_a_bar(0.0, [-2.0, 0, 0], 0.06)), 0.0, atol=1e-9)
        np.testing.assert_allclose(slid(*self.on_a_bar(0.0, [0, 0, 2.0], 0.06)), [0.06, 0], atol=1e-9)
        contact, effector, trace = self.on_a_bar(0.9, 1.5 * around)
        way = integrate(touch_velocity(contact, effector, trace), np.ones(2))[-1]
        np.testing.assert_allclose(way, [0, 0.02 * 0.9], atol=1e-9)
        self.assertLess(height_of_ball(contact, effector, trace).max(), 1e-12)
        np.testing.assert_allclose(normal_at(contact, trace.point)[-1, -1],
                                   [np.sin(0.9), 0, np.cos(0.9)], atol=1e-12)

    def test_largest_change(self):
        way, value = np.array([0, 0.05, 0.1, 0.3, 0.35]), np.array([0, 1.0, -1.0, 5.0, 4.5])
        self.assertEqual(largest_change(way, value, 0.1), (2.0, 2))

    def test_spread(self):
        points = np.random.default_rng(2).normal(size=(3000, 3))
        exact = max(np.linalg.norm(points - p, axis=1).max() for p in points)
        self.assertGreater(spread(points), 0.999 * exact)

    def test_locked_wheels_are_held_where_they_touch(self):
        contact, effector = self.contact("wheel"), types.SimpleNamespace(radius=0.1)
        off, tilt = closure(contact, effector, rolling_trace(0.0, 0.1))
        self.assertLess(off.max() + tilt.max(), 1e-12)
        contact.locked = True
        self.assertAlmostEqual(closure(contact, effector, rolling_trace(0.0, 0.1))[0].max(), 1.0)


if __name__ == "__main__":
    unittest.main()
