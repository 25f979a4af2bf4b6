"""What rolls: the slip of wheels along and across their heading, and of the skin of balls.

    slip = WheelSlip(contact, effector, trace, durations)
    for constraint, worst, step in slip.worst(): ...
    slip = integrate(skin_velocity(contact, effector, trace), durations)
    slip = integrate(skin_velocity(contact, effector, shortest_turns(contact, at_vertices)), ones)

Rates are integrated by Simpson's rule over quarters of each step.
"""

import numpy as np

from contacts import FRACTIONS, PARTS, Trace, across_bar, normal_at, unit
from rotations import exp, log

SLIP_M, STRETCH_M, SHARE = 5e-3, 0.1, 0.02
QUARTERS = PARTS // 2


def quarters(rate, durations):
    """Integrals over each quarter of each step: steps x quarters x numbers."""
    width = np.asarray(durations)[:, None, None] / QUARTERS
    return width / 6.0 * (rate[:, 0:-1:2] + 4.0 * rate[:, 1::2] + rate[:, 2::2])


def integrate(rate, durations):
    """The integral from the beginning to the end of each quarter, 0 first: many x numbers."""
    pieces = quarters(rate, durations).reshape(-1, rate.shape[-1])
    return np.vstack([np.zeros(rate.shape[-1]), np.cumsum(pieces, axis=0)])


def skin_velocity(contact, effector, trace):
    """Of a ball's skin over what it is on, c' - w x r n without what is along n; on a bar along its
    axis and along its arc. Zero where it rolls; that a ball spins about the normal takes no part."""
    n, v = normal_at(contact, trace.point), trace.velocity
    if contact.round is None:
        slip = v - effector.radius * np.cross(trace.omega, n)
        return slip - (slip @ n)[..., None] * n
    dot = lambda a, b: np.sum(a * b, axis=-1)
    axis, off = contact.round.axis, across_bar(contact.round, trace.point)
    around = dot(v, np.cross(axis, n)) / np.linalg.norm(off, axis=-1)
    arc = (contact.round.radius + effector.radius) * around - effector.radius * (trace.omega @ axis)
    along = v @ axis + effector.radius * dot(trace.omega, np.cross(axis, n))
    return np.stack([along, arc], axis=-1)


def touch_velocity(contact, effector, trace):
    """Of the place that touches, on a plane the centre's along it; on a bar as skin_velocity()."""
    still = Trace(trace.point, trace.rotation, trace.axle, trace.velocity, 0.0 * trace.omega)
    rate = skin_velocity(contact, effector, still)
    if contact.round is not None:
        rate[..., 1] *= contact.round.radius / (contact.round.radius + effector.radius)
    return rate


def shortest_turns(contact, trace):
    """Steps, of one second, between the moments of a trace: the link turns at a constant rate the short
    way, a ball's centre goes straight, or steadily round and along its bar."""
    s = FRACTIONS[:, None]
    steps = len(trace.point) - 1
    turn = log(trace.rotation[1:] @ trace.rotation[:-1].transpose(0, 2, 1))
    omega = np.repeat(turn[:, None], PARTS + 1, axis=1)
    rotation = np.repeat(trace.rotation[:-1, None], PARTS + 1, axis=1)
    here, there = trace.point[:-1, None], trace.point[1:, None]
    if contact.round is None:
        velocity = np.repeat(there - here, PARTS + 1, axis=1)
        return Trace(here + s * (there - here), rotation, None, velocity, omega)
    bar = contact.round
    a, b = across_bar(bar, trace.point[:-1]), across_bar(bar, trace.point[1:])
    angle = np.arctan2(np.cross(a, b) @ bar.axis, np.sum(a * b, axis=-1))
    along = (trace.point - bar.start) @ bar.axis
    point, velocity = np.zeros((2, steps, PARTS + 1, 3))
    for k in range(steps):
        out = exp(FRACTIONS[:, None] * angle[k] * bar.axis) @ a[k]
        point[k] = bar.start + (along[k] + s * (along[k + 1] - along[k])) * bar.axis + out
        velocity[k] = (along[k + 1] - along[k]) * bar.axis + angle[k] * np.cross(bar.axis, out)
    return Trace(point, rotation, None, velocity, omega)


def largest_change(way, value, stretch):
    """The largest change of a value within any stretch of a way that does not decrease."""
    largest, step, begin = 0.0, 0, 0
    for end in range(len(way)):
        while way[begin] < way[end] - stretch:
            begin += 1
        part = value[begin:end + 1]
        change = max(value[end] - part.min(), part.max() - value[end])
        if change > largest:
            largest, step = change, end
    return largest, step


class WheelSlip:
    """c the centre, a the axle, u the direction of the disc nearest to the normal n: the material
    point that touches moves by c' - r w x u, along a laid into the plane or along a x n."""

    def __init__(self, contact, effector, trace, durations):
        n = contact.normal
        along = np.sum(trace.axle * n, axis=-1, keepdims=True)
        up = unit(n - along * trace.axle)
        across = unit(trace.axle - along * n)
        heading = np.cross(across, n)
        slip = trace.velocity - effector.radius * np.cross(trace.omega, up)
        dot = lambda a, b: np.sum(a * b, axis=-1, keepdims=True)
        rates = np.concatenate([dot(slip, across), dot(slip, heading), dot(trace.velocity, heading),
                                effector.radius * dot(trace.omega, trace.axle)], axis=-1)
        pieces = quarters(rates, durations).reshape(-1, 4)
        in_world = integrate(slip, durations)
        self.way = np.concatenate([[0.0], np.cumsum(np.minimum(*np.abs(pieces[:, 2:4].T)))])
        total = np.vstack([np.zeros(2), np.cumsum(pieces[:, :2], axis=0)])
        directions = [self._at_quarters(across), self._at_quarters(heading)]
        self.sums = [(total[:, k], np.sum(in_world * directions[k], axis=-1)) for k in (0, 1)]

    @staticmethod
    def _at_quarters(direction):
        return np.vstack([direction[0, 0], direction[:, 2::2].reshape(-1, 3)])

    def worst(self):
        allowed = SLIP_M + SHARE * self.way
        for name, (own, world) in zip(("lateral_slip", "longitudinal_slip"), self.sums):
            stretch, at = largest_change(self.way, own, STRETCH_M)
            share = np.maximum(np.abs(own), np.abs(world)) * SLIP_M / allowed
            k = int(np.argmax(share))
            worst, place = max((stretch, at), (float(share[k]), k))
            yield name, worst, max(0, place - 1) // QUARTERS
