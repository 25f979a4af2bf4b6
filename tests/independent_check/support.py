"""What of a contact lies on the planes, faces and bars of a scenario, and with what friction.

    support = support_of(contact, effector, scenario, axes, touching)
    support.corners          # about the sole's point in its axes, N x 2; None: one place
    support.outside          # beyond the nearest border [m]; 0: on it
"""

import numpy as np

from rotations import angle_between
from scenario_file import Bar

CLOSED_M, CLOSED_RAD, HELD_M = 1e-4, 1e-3, 1e-3


class Support:
    def __init__(self, friction):
        self.known, self.outside, self.friction, self.corners, self.names = False, np.inf, friction, None, []

    @property
    def bears(self):
        return not self.known or self.outside <= CLOSED_M


def rectangle(half):
    return np.array([[half[0], half[1]], [-half[0], half[1]], [-half[0], -half[1]], [half[0], -half[1]]])


def clip(polygon, normal, bound):
    """The part of a convex polygon where normal . x <= bound."""
    inside = []
    for here, there in zip(polygon, np.roll(polygon, -1, axis=0)):
        a, b = normal @ here - bound, normal @ there - bound
        if a <= 0.0:
            inside.append(here)
        if a * b < 0.0:
            inside.append(here + (there - here) * (a / (a - b)))
    return np.array(inside).reshape(-1, 2)


def _area(polygon):
    x, y = polygon.T
    return 0.5 * abs(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))


def surfaces_under(contact, scenario):
    """In whose plane the contact's place lies, facing as its normal does."""
    return [s for s in scenario.surfaces
            if angle_between(contact.normal, s.axes[:, 2]) <= CLOSED_RAD
            and abs((contact.position - s.centre) @ s.axes[:, 2]) <= CLOSED_M]


def places_of(contact, effector, scenario):
    """Surfaces and bars that a contact is on; remembered, as that does not change."""
    if not hasattr(contact, "places"):
        surfaces = [] if contact.kind == "rung" else surfaces_under(contact, scenario)
        bars = [b for b in scenario.bars if off_bar(contact, effector, b) <= CLOSED_M]
        contact.places = surfaces, bars
    return contact.places


def off_bar(contact, effector, bar):
    """How far a contact's place is off a bar without ends; infinite if its directions do not fit."""
    away = contact.position - bar.start
    away = away - bar.axis * (bar.axis @ away)
    if contact.kind == "point":
        if angle_between(away, contact.normal) > CLOSED_RAD:
            return np.inf
        return abs(np.linalg.norm(away) - bar.radius)
    if contact.kind == "surface":
        if abs(contact.normal @ bar.axis) > np.sin(CLOSED_RAD):
            return np.inf
        height = contact.normal @ away - bar.radius
        aside = abs(np.cross(contact.normal, bar.axis) @ away) - np.hypot(*effector.half)
        return np.hypot(height, max(0.0, aside))
    if contact.kind == "rung":
        held = np.cross(contact.normal, contact.forward)
        if min(angle_between(held, bar.axis), angle_between(held, -bar.axis)) > CLOSED_RAD:
            return np.inf
        return np.linalg.norm(away)
    return np.inf


def _line_in_sole(bar, contact, half, axes, touching):
    """Where a sole touches a bar: the part of a line within its rectangle, in the sole's axes."""
    ends = np.array([bar.start, bar.end]) + bar.radius * contact.normal - touching
    a, b = ends @ axes[:, :2]
    low, high = 0.0, 1.0
    for axis in (0, 1):
        way = b[axis] - a[axis]
        if abs(way) < 1e-15:
            if abs(a[axis]) > half[axis]:
                return None
            continue
        cuts = sorted(((-half[axis] - a[axis]) / way, (half[axis] - a[axis]) / way))
        low, high = max(low, cuts[0]), min(high, cuts[1])
    line = np.array([a + low * (b - a), a + high * (b - a)])
    if high <= low or np.linalg.norm(line[1] - line[0]) < CLOSED_M:
        return None
    return line


def bar_under_ball(contact, effector, scenario):
    """The bar that a ball rolls round; None: it rolls on the plane of the place where it touched down,
    as it does wherever that is within the border of a surface. What a scan holds is not known here:
    there the plan's word is taken, as for the place."""
    surfaces, bars = places_of(contact, effector, scenario)
    if not surfaces and not bars and scenario.scans and contact.stated_bar:
        radius, axis = contact.stated_bar
        foot = contact.position - radius * contact.normal
        bars = [Bar("scan", foot - axis, foot + axis, radius, None)]
    if not bars or not contact.is_ball(effector):
        return None
    if any(_beyond(s, contact.position) <= CLOSED_M for s in surfaces):
        return None
    return min(bars, key=lambda b: _past_ends(b, contact.position))


def _beyond(surface, points):
    """How far points are beyond the border of a surface."""
    off = np.abs((points - surface.centre) @ surface.axes[:, :2])
    return np.linalg.norm(np.maximum(0.0, off - surface.half), axis=-1)


def _past_ends(bar, points):
    along = (points - bar.start) @ bar.axis
    return np.maximum(0.0, np.maximum(-along, along - bar.length))


def places_under_ball(contact, effector, scenario, point):
    """Of the surfaces and bars of its place those that a ball may be on at a point."""
    surfaces, bars = places_of(contact, effector, scenario)
    if contact.round is None:
        return surfaces, []
    off = lambda b: np.linalg.norm(np.cross(b.axis, point - b.start)) - b.radius
    return [], [b for b in bars if abs(off(b)) <= HELD_M]


def ball_outside(contact, effector, scenario, points):
    """How far the places that a ball has rolled to are beyond the nearest border; None: nothing is
    known of what it is on."""
    surfaces, bars = places_of(contact, effector, scenario)
    off = [_beyond(s, points) for s in surfaces if contact.round is None]
    off += [_past_ends(b, points) for b in bars if contact.round is not None]
    return np.min(off, axis=0) if off else None


def support_of(contact, effector, scenario, axes, touching):
    """axes: of the sole in the world (columns); touching: the point that touches."""
    support = Support(effector.friction)
    surfaces, bars = places_of(contact, effector, scenario)
    if not surfaces and not bars:
        support.friction = scenario.scan_friction(effector)
        return support
    if contact.is_ball(effector):
        surfaces, bars = places_under_ball(contact, effector, scenario, touching)
    support.known, corners, friction = True, [], []

    def lies_on(place, outside, polygon):
        support.outside = min(support.outside, outside)
        if polygon is not None:
            corners.extend(polygon)
        if outside <= CLOSED_M:
            support.names.append(place.name)
            friction.append(effector.friction if place.friction is None else place.friction)

    for surface in surfaces:
        local = surface.axes.T @ (touching - surface.centre)
        if contact.kind != "surface":
            lies_on(surface, _beyond(surface, touching), None)
            continue
        polygon = rectangle(effector.half)
        for axis in (0, 1):
            if np.isinf(surface.half[axis]):
                continue
            normal = surface.axes[:, axis] @ axes[:, :2]
            for side in (1.0, -1.0):
                if len(polygon):
                    polygon = clip(polygon, side * normal, surface.half[axis] - side * local[axis])
        inside = len(polygon) > 2 and _area(polygon) > 1e-8
        lies_on(surface, 0.0 if inside else HELD_M, polygon if inside else None)
    for bar in bars:
        if contact.kind == "surface":
            line = _line_in_sole(bar, contact, effector.half, axes, touching)
            lies_on(bar, HELD_M if line is None else 0.0, line)
        else:
            lies_on(bar, _past_ends(bar, touching), None)
    support.corners = np.array(corners) if corners else None
    if friction:
        support.friction = min(friction)
    return support
