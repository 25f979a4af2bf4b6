"""A scenario file: robot, end effectors, limits, what may be touched, start and goals.

    scenario = Scenario(find_scenario("stepping_stones", data))
    data = Data("../..")             # where robots/models and planners/scenarios are

Only what a plan is checked by is read. What scans (mesh, cloud, octomap) hold is not known here:
contacts on them are taken on trust.
"""

import math
import os
import xml.etree.ElementTree as ElementTree

import numpy as np

from rotations import from_rpy
from urdf import numbers

WHEEL_FRICTION, WHEEL_FORCE = 0.8, 5000.0


class Data:
    """Finds the robots and scenarios that come along, in the sources or as they are installed."""

    def __init__(self, folder):
        self.folder = folder

    def _first(self, *names):
        for name in names:
            path = os.path.join(self.folder, name)
            if os.path.exists(path):
                return path
        raise ValueError(f"none of {', '.join(names)} in {self.folder}")

    def scenario(self, name):
        return self._first(*(f"{folder}scenarios/{name}.xml"
                             for folder in ("planners/", "", "share/locograph/")))

    def model(self, name):
        urdf = self._first(*(f"{folder}robots/models/{name}/{name}.urdf"
                             for folder in ("", "share/locograph/")))
        srdf = urdf[:-4] + "srdf"
        return urdf, srdf if os.path.exists(srdf) else None


class Effector:
    def __init__(self, element, friction):
        self.kind = element.get("kind", "wheel")
        self.link = element.get("link")
        self.name = element.get("name", self.link)
        vector = lambda name, otherwise: numbers(element.get(name, otherwise), 3)
        self.point = vector("point", "0 0 0")
        self.normal_in_link = vector("link_normal", "0 0 1")
        self.forward_in_link = vector("link_forward", "1 0 0")
        self.half = np.array([float(element.get("half_x", "0")), float(element.get("half_y", "0"))])
        self.radius = float(element.get("radius", "0"))
        self.max_force = float(element.get("max_force", WHEEL_FORCE))
        self.max_moment = float(element.get("max_moment", "0"))
        self.friction = 0.0 if self.kind == "rung" else float(element.get("friction", friction))


def axes_of(normal, forward):
    """Columns x y z: forward made normal to the normal, across, normal."""
    z = np.asarray(normal, float) / np.linalg.norm(normal)
    y = np.cross(z, np.asarray(forward, float))
    y = y / np.linalg.norm(y)
    return np.column_stack([np.cross(y, z), y, z])


def _forward_in(normal):
    """World x, or z where the normal is along x."""
    n = np.asarray(normal, float) / np.linalg.norm(normal)
    return np.array([1.0, 0, 0]) if abs(n[0]) < 1.0 - 1e-9 else np.array([0, 0, 1.0])


class Surface:
    """A flat rectangle that is touched from the side of its normal; infinite halves: no border."""

    def __init__(self, name, axes, centre, half, friction):
        self.name, self.axes, self.centre, self.half, self.friction = name, axes, centre, half, friction


class Bar:
    def __init__(self, name, start, end, radius, friction):
        self.name, self.start, self.end, self.radius, self.friction = name, start, end, radius, friction
        self.length = np.linalg.norm(end - start)
        self.axis = (end - start) / self.length


def _faces(element, friction):
    centre, size = numbers(element.get("center"), 3), numbers(element.get("size"), 3)
    rotation = from_rpy(numbers(element.get("rpy", "0 0 0"), 3))
    for side, normal in (("top", (0, 0, 1)), ("bottom", (0, 0, -1)), ("front", (1, 0, 0)),
                         ("back", (-1, 0, 0)), ("left", (0, 1, 0)), ("right", (0, -1, 0))):
        axes = axes_of(normal, _forward_in(normal))
        half = np.abs(axes[:, :2]).T @ (0.5 * size)
        yield Surface(f"{element.get('name')} {side}", rotation @ axes,
                      centre + rotation @ (0.5 * size * np.array(normal)), half, friction)


class Place:
    """A contact of the start or of a goal."""

    def __init__(self, element):
        self.effector = element.get("end_effector")
        self.position = numbers(element.get("position"), 3)
        self.normal = numbers(element.get("normal"), 3)
        self.normal = self.normal / np.linalg.norm(self.normal)
        forward = element.get("forward")
        self.forward = None if forward is None else numbers(forward, 3)


class Scenario:
    def __init__(self, file, data):
        self.file, folder = file, os.path.dirname(os.path.abspath(file))
        root = ElementTree.parse(file).getroot()
        robot = root.find("robot")
        if robot.get("model"):
            self.urdf, self.srdf = data.model(robot.get("model"))
        else:
            self.urdf = os.path.join(folder, robot.get("urdf"))
            self.srdf = os.path.join(folder, robot.get("srdf")) if robot.get("srdf") else None
        self.active = [robot.get("active")] if robot.get("active") else []
        self.state = robot.get("state", "home")
        self.effort_scale = float(robot.get("effort_scale", "1"))
        planner = root.find("planner")
        self.enforce_torques = planner is None or planner.get("torque_limits", "enforce") == "enforce"
        limits = root.find("limits")
        limit = lambda name: math.inf if limits is None else float(limits.get(name, "inf"))
        self.base_linear, self.base_angular = limit("base_linear"), limit("base_angular")
        self.joint_acceleration = limit("joint_acceleration")
        self.surfaces, self.bars, self.scans = [], [], []
        environment = root.find("environment")
        friction = None if environment is None else environment.get("friction")
        for element in [] if environment is None else environment:
            self._touchable(element)
        self._read_effectors(root, None if friction is None else float(friction))
        self.drive = root.find("drive")
        if self.drive is not None and not (self.surfaces or self.bars or self.scans):
            self.surfaces.append(Surface("ground", np.eye(3), np.zeros(3), np.full(2, math.inf), None))
        start = root.find("start")
        self.start = [] if start is None else [Place(c) for c in start.findall("contact")]
        self.goals = [[Place(c) for c in goal.findall("contact")] for goal in root.findall("goal")]

    def _touchable(self, element):
        friction = None if element.get("friction") is None else float(element.get("friction"))
        name = element.get("name")
        if element.tag == "plane":
            normal = numbers(element.get("normal"), 3)
            forward = element.get("forward")
            axes = axes_of(normal, _forward_in(normal) if forward is None else numbers(forward, 3))
            self.surfaces.append(Surface(name, axes, numbers(element.get("center"), 3),
                                         0.5 * numbers(element.get("size"), 2), friction))
        elif element.tag == "box":
            self.surfaces.extend(_faces(element, friction))
        elif element.tag == "rung":
            self.bars.append(Bar(name, numbers(element.get("from"), 3), numbers(element.get("to"), 3),
                                 float(element.get("radius")), friction))
        elif element.tag in ("mesh", "cloud", "octomap"):
            self.scans.append((name, friction))

    def _read_effectors(self, root, friction):
        own = [s.friction for s in self.surfaces + self.bars] + [f for _, f in self.scans]
        largest = max((f for f in own if f is not None), default=0.0)
        self.effectors = {}
        for tag, otherwise in (("wheels/wheel", WHEEL_FRICTION), ("end_effectors/end_effector", largest)):
            for element in root.findall(tag):
                effector = Effector(element, otherwise if friction is None else friction)
                self.effectors[effector.name] = effector

    def scan_friction(self, effector):
        """The least that a contact on some scan may have."""
        return min((effector.friction if f is None else f for _, f in self.scans),
                   default=effector.friction)


def find_scenario(word, folder, data):
    """A name that comes along, or a path (with a /) relative to the plan."""
    if "/" not in word and not os.path.exists(os.path.join(folder, word)):
        return data.scenario(word)
    return os.path.join(folder, word)
