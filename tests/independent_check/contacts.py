"""Where end effectors are along a plan, and whether each contact is closed at its place.

    traces = Traces(robot, curve, effectors)       # at all vertices, and at 9 places of each step
    position, angle = closure(contact, effector, traces.at_vertices[name])

A trace has, of the link of an end effector: the world position of its point, the rotation of the
link, angular velocity, velocity of the point, and of wheels the axle.
"""

import numpy as np

from kinematics import Links
from rotations import angle_between, exp
from scenario_file import axes_of

PARTS = 8
FRACTIONS = np.arange(PARTS + 1) / PARTS
CHUNK = 400


class Trace:
    def __init__(self, point, rotation, axle, velocity=None, omega=None):
        self.point, self.rotation, self.axle = point, rotation, axle
        self.velocity, self.omega = velocity, omega

    def pick(self, *index):
        some = lambda array: None if array is None else array[index]
        return Trace(some(self.point), some(self.rotation), some(self.axle), some(self.velocity),
                     some(self.omega))


def _trace(links, effector):
    k = links.robot.link_index[effector.link]
    velocity = omega = None
    if links.moves:
        velocity, omega = links.velocity_of(k, effector.point), links.omega[k]
    return (links.place(k, effector.point), links.rotation[k],
            links.axis[k], velocity, omega)


class Traces:
    def __init__(self, robot, curve, effectors, moves=True):
        self.at_vertices, self.on_steps = {}, {}
        links = Links(robot, curve.q)
        for name, effector in effectors.items():
            self.at_vertices[name] = Trace(*_trace(links, effector)[:3])
        if not moves or curve.steps == 0:
            return
        parts = {name: [] for name in effectors}
        for begin in range(0, curve.steps, CHUNK):
            steps = np.arange(begin, min(begin + CHUNK, curve.steps))
            links = Links(robot, *curve.at(np.repeat(steps, PARTS + 1), np.tile(FRACTIONS, len(steps))))
            for name, effector in effectors.items():
                arrays = _trace(links, effector)
                parts[name].append([a.reshape((len(steps), PARTS + 1) + a.shape[1:]) for a in arrays])
        for name, pieces in parts.items():
            self.on_steps[name] = Trace(*[np.concatenate(arrays) for arrays in zip(*pieces)])


def unit(v):
    return v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-300)


def across_bar(bar, point):
    """From the axis of a bar to points."""
    off = point - bar.start
    return off - (off @ bar.axis)[..., None] * bar.axis


def normal_at(contact, point):
    """Out of what touches, into the robot; that of a ball on a bar goes along with its centre."""
    return contact.normal if contact.round is None else unit(across_bar(contact.round, point))


def touching(contact, effector, trace):
    """The point that touches: a ball's lowest along the normal, a wheel's lowest of its disc."""
    if contact.kind == "point":
        return trace.point - effector.radius * normal_at(contact, trace.point)
    if contact.kind == "wheel":
        along = np.sum(trace.axle * contact.normal, axis=-1, keepdims=True)
        return trace.point - effector.radius * unit(contact.normal - along * trace.axle)
    return trace.point


def height_of_ball(contact, effector, trace):
    """How far a ball is off what it rolls on."""
    if contact.round is None:
        return np.abs((trace.point - contact.position) @ contact.normal - effector.radius)
    out = np.linalg.norm(across_bar(contact.round, trace.point), axis=-1)
    return np.abs(out - contact.round.radius - effector.radius)


def closure(contact, effector, trace):
    """How far each sample is off the contact's place [m] and off the directions it holds [rad]; a ball,
    off what it rolls on."""
    off = touching(contact, effector, trace) - contact.position
    if contact.kind == "wheel":
        tilt = np.abs(np.arcsin(np.clip(np.sum(trace.axle * contact.normal, axis=-1), -1, 1)))
        return np.linalg.norm(off, axis=-1) if contact.locked else np.abs(off @ contact.normal), tilt
    distance = np.linalg.norm(off, axis=-1)
    if contact.is_ball(effector):
        return height_of_ball(contact, effector, trace), None
    if contact.kind == "point":
        return distance, None
    own = axes_of(effector.normal_in_link, effector.forward_in_link)
    axes = trace.rotation @ own
    angle = np.zeros(distance.shape)
    if contact.kind == "surface":
        angle = angle_between(axes[..., :, 2], contact.normal)
    if contact.forward is not None:
        across = np.cross(contact.normal, contact.forward)
        angle = np.maximum(angle, angle_between(axes[..., :, 1], across))
    return distance, angle


def bearing_axes(contact, effector, moment):
    """Columns x y z in which forces act: of soles and grasps their own, else the contact's; those of a
    ball on a bar turn about the bar with it."""
    if contact.kind in ("surface", "rung"):
        return moment.rotation @ axes_of(effector.normal_in_link, effector.forward_in_link)
    n = contact.normal
    forward = contact.forward
    if forward is None:
        forward = np.array([1.0, 0, 0]) if abs(n[0]) < 0.9 else np.array([0, 1.0, 0])
    axes = axes_of(n, forward)
    if contact.round is None:
        return axes
    now, bar = normal_at(contact, moment.point), contact.round.axis
    return axes_of(now, exp(bar * np.arctan2(bar @ np.cross(n, now), n @ now)) @ axes[:, 0])


def false_claims(contact, effector):
    """What a plan says of an end effector that its scenario does not; empty: nothing."""
    if effector is None:
        return f"{contact.name} is no end effector of the scenario"
    off = lambda a, b: np.linalg.norm(np.asarray(a) - np.asarray(b)) > 1e-9
    if contact.kind != effector.kind or contact.link != effector.link:
        return f"{contact.name} is another kind or on another link"
    if off(contact.point, effector.point) or abs(contact.radius - effector.radius) > 1e-9:
        return f"{contact.name} has another point or radius"
    if contact.kind in ("surface", "rung") and off(
            axes_of(contact.normal_in_link, contact.forward_in_link),
            axes_of(effector.normal_in_link, effector.forward_in_link)):
        return f"{contact.name} has other axes"
    more = lambda a, b: np.any(np.asarray(a) > np.asarray(b) * (1 + 1e-9))
    if (more(contact.half, effector.half) or more(contact.max_force, effector.max_force)
            or more(contact.max_moment, effector.max_moment)
            or more(contact.friction, effector.friction)):
        return f"{contact.name} claims more than the scenario"
    return ""
