"""A robot as its URDF and SRDF describe it: links, joints, which joints move, where frozen ones stand.

    robot = Robot("go2.urdf", "go2.srdf", active=[], frozen_state="home")
    robot.active            # names of the joints of a configuration, in its order

Links come root first, depth first, children in the order of the file; joints in the order of the
links below them. A mimic joint moves with its leader and is no part of a configuration.
"""

import math
import xml.etree.ElementTree as ElementTree

import numpy as np

from rotations import from_rpy

MOVABLE = ("revolute", "continuous", "prismatic")


def numbers(text, count):
    values = [float(word) for word in text.split()]
    if len(values) != count:
        raise ValueError(f"expected {count} numbers, found '{text}'")
    return np.array(values)


def _origin(element):
    """Rotation and translation of an <origin>."""
    origin = None if element is None else element.find("origin")
    if origin is None:
        return np.eye(3), np.zeros(3)
    return (from_rpy(numbers(origin.get("rpy", "0 0 0"), 3)), numbers(origin.get("xyz", "0 0 0"), 3))


class Link:
    def __init__(self, element):
        self.name = element.get("name")
        self.parent_joint = None
        self.mass, self.com, self.inertia = 0.0, np.zeros(3), np.zeros((3, 3))
        inertial = element.find("inertial")
        if inertial is None:
            return
        rotation, self.com = _origin(inertial)
        self.mass = float(inertial.find("mass").get("value"))
        entry = {name: float(value) for name, value in inertial.find("inertia").attrib.items()}
        own = np.array([[entry["ixx"], entry["ixy"], entry["ixz"]],
                        [entry["ixy"], entry["iyy"], entry["iyz"]],
                        [entry["ixz"], entry["iyz"], entry["izz"]]])
        self.inertia = rotation @ own @ rotation.T


class Joint:
    def __init__(self, element):
        self.name, self.type = element.get("name"), element.get("type")
        self.parent, self.child = element.find("parent").get("link"), element.find("child").get("link")
        self.rotation, self.translation = _origin(element)
        axis = element.find("axis")
        self.axis = numbers("1 0 0" if axis is None else axis.get("xyz"), 3)
        self.axis = self.axis / np.linalg.norm(self.axis) if self.movable else self.axis
        self.lower, self.upper = -math.inf, math.inf
        self.max_velocity = self.max_effort = math.inf
        limit = element.find("limit")
        if limit is not None:
            self.max_velocity = float(limit.get("velocity", "inf"))
            self.max_effort = float(limit.get("effort", "inf"))
            if self.type in ("revolute", "prismatic"):
                self.lower = float(limit.get("lower", "0"))
                self.upper = float(limit.get("upper", "0"))
        mimic = element.find("mimic")
        self.leader = None if mimic is None else mimic.get("joint")
        self.multiplier = 1.0 if mimic is None else float(mimic.get("multiplier", "1"))
        self.offset = 0.0 if mimic is None else float(mimic.get("offset", "0"))
        self.index = None      # of the active joint that it is or follows
        self.frozen = 0.0      # where it stands if no active joint moves it

    @property
    def movable(self):
        return self.type in MOVABLE

    def neutral(self):
        return min(max(0.0, self.lower), self.upper)


class Robot:
    def __init__(self, urdf, srdf=None, active=(), frozen_state="home"):
        root = ElementTree.parse(urdf).getroot()
        self.urdf = urdf
        links = {link.name: link for link in map(Link, root.findall("link"))}
        below, children = {}, {}
        for joint in map(Joint, root.findall("joint")):
            below[joint.child] = joint
            children.setdefault(joint.parent, []).append(joint)
        (top,) = [name for name in links if name not in below]
        if len(children.get(top, [])) == 1 and children[top][0].type == "floating":
            top = children[top][0].child
        self.links, self.joints = [], []
        self._order(top, links, children)
        self.link_index = {link.name: i for i, link in enumerate(self.links)}
        self.joint_named = {joint.name: joint for joint in self.joints}
        self.mass = sum(link.mass for link in self.links)
        self._lead_mimic_joints()
        groups, states = read_srdf(srdf, self)
        self._activate(active, groups, states.get(frozen_state, {}))

    def _order(self, top, links, children):
        waiting = [(top, None)]
        while waiting:
            name, joint = waiting.pop()
            link = links[name]
            if joint is not None:
                link.parent_joint = joint
                self.joints.append(joint)
            self.links.append(link)
            waiting.extend((child.child, child) for child in reversed(children.get(name, [])))

    def _lead_mimic_joints(self):
        for joint in [j for j in self.joints if j.leader is not None]:
            leader = self.joint_named[joint.leader]
            while leader.leader is not None:
                joint.offset += joint.multiplier * leader.offset
                joint.multiplier *= leader.multiplier
                leader = self.joint_named[leader.leader]
            joint.leads = leader
        for joint in [j for j in self.joints if j.leader is not None]:
            leader, factor = joint.leads, joint.multiplier
            if factor == 0.0:
                continue
            if joint.max_velocity > 0.0:
                leader.max_velocity = min(leader.max_velocity, joint.max_velocity / abs(factor))
            if joint.type == "continuous":
                continue
            ends = sorted(((joint.lower - joint.offset) / factor, (joint.upper - joint.offset) / factor))
            low, high = max(leader.lower, ends[0]), min(leader.upper, ends[1])
            if low < high:
                leader.lower, leader.upper = low, high

    def _activate(self, names, groups, state):
        free = [joint for joint in self.joints if joint.movable and joint.leader is None]
        if names:
            wanted = set()
            for name in names:
                wanted |= groups[name] if name in groups else {name}
            # A mimic joint stands for its leader.
            wanted |= {self.joint_named[n].leads.name for n in wanted if self.joint_named[n].leader}
            free = [joint for joint in free if joint.name in wanted]
        self.active_joints = free
        self.active = [joint.name for joint in free]
        for joint in self.joints:
            joint.frozen = state.get(joint.name, joint.neutral()) if joint.movable else 0.0
        for i, joint in enumerate(free):
            joint.index = i
        for joint in self.joints:
            if joint.movable and joint.leader is not None:
                joint.index = joint.leads.index
                joint.frozen = joint.multiplier * joint.leads.frozen + joint.offset

    def body(self, link):
        """The first link of the rigid body that a link belongs to."""
        link = self.links[self.link_index[link]]
        while link.parent_joint is not None and link.parent_joint.index is None:
            link = self.links[self.link_index[link.parent_joint.parent]]
        return link.name


def read_srdf(file, robot):
    """Groups (name to set of movable joints) and states (name to positions by joint)."""
    if file is None:
        return {}, {}
    root = ElementTree.parse(file).getroot()
    elements = {group.get("name"): group for group in root.findall("group")}

    def joints_above(tip, base):
        found, name = set(), tip
        while name != base:
            joint = robot.links[robot.link_index[name]].parent_joint
            if joint is None:
                raise ValueError(f"no chain from {base} to {tip}")
            found.add(joint.name)
            name = joint.parent
        return found

    def members(name):
        found = set()
        for member in elements[name]:
            if member.tag == "joint":
                found.add(member.get("name"))
            elif member.tag == "link":
                joint = robot.links[robot.link_index[member.get("name")]].parent_joint
                found |= set() if joint is None else {joint.name}
            elif member.tag == "chain":
                found |= joints_above(member.get("tip_link"), member.get("base_link"))
            elif member.tag == "group":
                found |= members(member.get("name"))
        return {n for n in found if n in robot.joint_named and robot.joint_named[n].movable}

    states = {state.get("name"): {joint.get("name"): float(joint.get("value"))
                                  for joint in state.findall("joint")}
              for state in root.findall("group_state")}
    return {name: members(name) for name in elements}, states
