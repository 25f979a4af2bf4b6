"""A plan file read line by line: configurations, times, slopes, stances and contacts.

    plan = Plan("walk.g2o")
    plan.q, plan.time, plan.slopes      # slopes: None for a vertex without
    plan.stance                         # the stance that each vertex is left in

Lines of edges are passed over: nothing that a planner wanted counts here.
"""

import os

import numpy as np


class Contact:
    """An end effector, and its place in the world."""

    def __init__(self, words):
        words = list(words)
        take = lambda count: [float(words.pop(0)) for _ in range(count)]
        self.name, self.link, self.kind = words.pop(0), words.pop(0), words.pop(0)
        if self.name == '""':
            self.name = self.link
        self.half = np.zeros(2)
        self.radius = self.friction = self.max_moment = 0.0
        if self.kind == "surface":
            self.half = np.array(take(2))
        if self.kind in ("point", "wheel"):
            (self.radius,) = take(1)
        if self.kind != "rung":
            (self.friction,) = take(1)
        (self.max_force,) = take(1)
        if self.kind == "rung":
            (self.max_moment,) = take(1)
        self.point, self.normal_in_link, self.forward_in_link = (np.array(take(3)) for _ in range(3))
        if words.pop(0) != "at":
            raise ValueError("a contact without 'at'")
        self.position, self.normal = np.array(take(3)), np.array(take(3))
        self.normal = self.normal / np.linalg.norm(self.normal)
        self.forward = None
        if words[0] == "free":
            words.pop(0)
        else:
            self.forward = np.array(take(3))
        self.bears_load = "unloaded" not in words
        self.locked = "locked" in words
        self.stated_bar = None  # radius and axis
        if "bar" in words:
            at = words.index("bar") + 1
            self.stated_bar = float(words[at]), np.array([float(w) for w in words[at + 1:at + 4]])
        self.round = None       # the bar that it rolls round, see support.py

    @property
    def held(self):
        """Stays where it is, or rolls by turning only: no wheel, or a locked one."""
        return self.kind != "wheel" or self.locked

    def is_ball(self, effector):
        return self.kind == "point" and effector.radius > 0.0


class Plan:
    def __init__(self, file):
        self.file = file
        self.folder = os.path.dirname(os.path.abspath(file))
        self.format, self.stances_only, self.incomplete, self.moved = None, False, False, False
        self.recorded = False
        self.robot_words, self.scenario, self.contacts, self.stances = None, None, {}, {}
        vertices = []
        with open(file, encoding="utf-8") as lines:
            for number, line in enumerate(lines, 1):
                words = line.split("#")[0].split()
                if not words or words[0].startswith("EDGE") or words[0] == "VERTEX_WRENCHES":
                    continue
                try:
                    self._take(words, vertices)
                except (ValueError, IndexError, KeyError) as problem:
                    raise ValueError(f"{file}:{number}: {problem!r}") from problem
        if self.robot_words is None or not vertices:
            raise ValueError(f"{file}: no robot or no configuration")
        vertices.sort(key=lambda vertex: vertex[1])
        self.ids = [vertex[0] for vertex in vertices]
        self.time = np.array([vertex[1] for vertex in vertices])
        self.stance = [vertex[2] for vertex in vertices]
        self.numbers = [np.array(vertex[3]) for vertex in vertices]

    def _take(self, words, vertices):
        tag = words[0]
        if tag == "PARAMS_ROBOT" and self.robot_words is None:
            self.robot_words = words[2:]
        elif tag == "PARAMS_PLAN":
            self.format = int(words[2])
            self.stances_only, self.incomplete = "stances_only" in words, "incomplete" in words
            self.moved, self.recorded = "moved_contacts" in words, "recorded" in words
        elif tag == "PARAMS_SCENARIO":
            self.scenario = words[2]
        elif tag == "PARAMS_CONTACT":
            self.contacts[int(words[1])] = Contact(words[3:])
        elif tag == "PARAMS_STANCE":
            count = int(words[2])
            self.stances[int(words[1])] = [self.contacts[int(n)] for n in words[3:3 + count]]
        elif tag == "VERTEX_CONFIGURATION":
            stance = None if words[4] == "-" else int(words[4])
            vertices.append((int(words[1]), float(words[3]), stance, [float(w) for w in words[5:]]))

    def split(self, joints):
        """q and slopes of all vertices, for a robot with so many active joints."""
        size, rates = 7 + joints, 6 + joints
        for vertex, row in zip(self.ids, self.numbers):
            if len(row) not in (size, size + rates):
                raise ValueError(f"{self.file}: vertex {vertex} has {len(row)} numbers, "
                                 f"expected {size} or {size + rates}")
        self.q = np.array([row[:size] for row in self.numbers])
        self.slopes = [row[size:] if len(row) > size else None for row in self.numbers]
