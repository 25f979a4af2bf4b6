"""How contacts are kept: between vertices, in total while they last, and wheels and balls that roll.

    check_contacts(report, plan, curve, traces, scenario, effectors)     # curve: None, no motion

A held ball moves as its turning asks, c' = w x r n, from the place where it touched down; its skin
slips by no more than a held contact may move.
"""

import numpy as np

from contacts import PARTS, closure, touching, unit
from rolling import WheelSlip, integrate, shortest_turns, skin_velocity, touch_velocity
from rotations import angle_between, log
from support import ball_outside

CLOSED_M, CLOSED_RAD = 1e-4, 1e-3
HELD_M, HELD_RAD = 1e-3, np.radians(0.5)
SLIP_M = 5e-3


def spread(points):
    """The largest distance between two of many points: of those outermost in many directions."""
    points = np.asarray(points, float).reshape(-1, np.shape(points)[-1])
    k = np.arange(200) + 0.5
    z, turn = k / 200, np.pi * (3 - np.sqrt(5)) * k
    r = np.sqrt(1 - z * z)
    along = points @ np.array([r * np.cos(turn), r * np.sin(turn), z])
    outer = np.unique(np.concatenate([along.argmax(axis=0), along.argmin(axis=0)]))
    apart = points[outer][:, None] - points[outer][None]
    return float(np.sqrt((apart**2).sum(axis=-1)).max())


def stances_at(plan, vertex):
    """The stances of the steps before and after a vertex."""
    found = []
    for step in (vertex - 1, vertex):
        if step >= 0 and plan.stance[step] is not None and plan.stance[step] not in found:
            found.append(plan.stance[step])
    return found


def spans(plan, name):
    """(first step, last step, contact) of each stretch of steps in which an end effector touches,
    in whatever stances."""
    runs, contact_of = [], {}
    for step in range(len(plan.q) - 1):
        stance = plan.stances.get(plan.stance[step], [])
        contact_of[step] = next((c for c in stance if c.name == name), None)
    step = 0
    while step < len(plan.q) - 1:
        if contact_of[step] is None:
            step += 1
            continue
        end = step
        while contact_of.get(end + 1) is not None and contact_of[end + 1].held == contact_of[step].held:
            end += 1
        runs.append((step, end, contact_of[step]))
        step = end + 1
    return runs


def check_contacts(report, plan, curve, traces, scenario, effectors):
    _at_vertices(report, plan, traces, effectors)
    if curve is None or curve.steps == 0:
        if plan.stances_only:
            _rolled_between_stances(report, plan, traces, effectors)
        return
    for name, effector in effectors.items():
        trace = traces.on_steps[name]
        for first, last, contact in spans(plan, name):
            part = trace.pick(slice(first, last + 1))
            durations = curve.duration[first:last + 1]
            _between(report, plan, curve, contact, effector, part, first)
            if contact.is_ball(effector):
                _rolled(report, plan, contact, effector, part, durations, first)
                outside = ball_outside(contact, effector, scenario, touching(contact, effector, part))
                if outside is not None:
                    report.add("contact_on_surface", outside.max(axis=1), CLOSED_M, "m",
                               np.array(plan.ids)[first:last + 1], curve.time[first:last + 1], name)
            elif contact.held:
                _kept(report, plan, curve, contact, effector, part, first, last)
            else:
                slip = WheelSlip(contact, effector, part, durations)
                for which, worst, step in slip.worst():
                    report.add(which, worst, SLIP_M, "m", plan.ids[first + step],
                               curve.time[first + step], name)


def _rolled_between_stances(report, plan, traces, effectors):
    for name, effector in effectors.items():
        for first, last, contact in spans(plan, name):
            if contact.is_ball(effector):
                part = shortest_turns(contact, traces.at_vertices[name].pick(slice(first, last + 2)))
                _rolled(report, plan, contact, effector, part, np.ones(last + 1 - first), first)


def _rolled(report, plan, contact, effector, part, durations, first):
    slip = integrate(skin_velocity(contact, effector, part), durations)
    slid = np.linalg.norm(slip, axis=1)
    k = int(np.argmax(slid))
    step = first + max(0, k - 1) // ((len(slid) - 1) // len(durations))
    report.add("contact_motion", slid[k], HELD_M, "m", plan.ids[step], plan.time[step],
               f"skin of {contact.name}")
    rate = np.linalg.norm(touch_velocity(contact, effector, part), axis=-1, keepdims=True)
    way = float(integrate(rate, durations)[-1, 0])
    report.rolled[contact.name] = max(way, report.rolled.get(contact.name, 0.0))
    name = max(report.rolled, key=report.rolled.get)
    report.tell("balls roll", f"up to {report.rolled[name]:.6f} m, {name}")


def _touches_down(plan, vertex, name):
    held = lambda v: any(c.name == name for c in plan.stances.get(plan.stance[v], []))
    return held(vertex) and (vertex == 0 or not held(vertex - 1))


def _at_vertices(report, plan, traces, effectors):
    by_contact = {}
    for vertex in range(len(plan.q)):
        for number in stances_at(plan, vertex):
            for contact in plan.stances[number]:
                by_contact.setdefault(id(contact), (contact, []))[1].append(vertex)
    for contact, vertices in by_contact.values():
        if contact.name not in effectors:
            continue
        vertices = np.array(sorted(set(vertices)))
        effector, trace = effectors[contact.name], traces.at_vertices[contact.name].pick(vertices)
        position, angle = closure(contact, effector, trace)
        if contact.is_ball(effector):
            down = [_touches_down(plan, v, contact.name) for v in vertices]
            off = np.linalg.norm(touching(contact, effector, trace) - contact.position, axis=-1)
            position = np.where(down, off, position)
        ids, times = np.array(plan.ids)[vertices], plan.time[vertices]
        report.add("contact_position", position, CLOSED_M, "m", ids, times, contact.name)
        if angle is not None:
            report.add("contact_orientation", angle, CLOSED_RAD, "rad", ids, times, contact.name)


def _between(report, plan, curve, contact, effector, part, first):
    steps = len(part.point)
    position, angle = closure(contact, effector, part.pick(slice(None), slice(1, PARTS)))
    worst = position if angle is None else np.maximum(position, angle * (HELD_M / HELD_RAD))
    report.add("contact_between", worst.max(axis=1), HELD_M, "m",
               np.array(plan.ids)[first:first + steps], curve.time[first:first + steps], contact.name)


def _kept(report, plan, curve, contact, effector, part, first, last):
    place = touching(contact, effector, part)
    report.add("contact_motion", spread(place), HELD_M, "m", plan.ids[first], curve.time[first],
               f"{contact.name}, until {curve.time[last + 1]:.4f} s")
    if contact.kind == "point":
        return
    if contact.kind == "surface":
        turned = log(part.rotation @ part.rotation[0, 0].T)
    elif contact.kind == "rung":
        turned = unit(part.rotation @ np.cross(effector.normal_in_link, effector.forward_in_link))
    else:
        rate = np.sum(part.omega * part.axle, axis=-1, keepdims=True) * np.array([1.0, 0, 0])
        turned = integrate(rate, curve.duration[first:last + 1])
    report.add("contact_turn", spread(turned), HELD_RAD, "rad", plan.ids[first], curve.time[first],
               f"{contact.name}, until {curve.time[last + 1]:.4f} s")


def check_relabelled(report, plan):
    """A held contact has one place as long as it lasts, also after many small steps."""
    first = {}
    for vertex in range(1, len(plan.q)):
        before, after = plan.stance[vertex - 1], plan.stance[vertex]
        if before == after or before is None or after is None:
            continue
        off = 0
        held = {b.name for b in plan.stances[after] if b.held}
        first = {name: a for name, a in first.items() if name in held}
        for b in plan.stances[after]:
            for a in plan.stances[before]:
                if a.name != b.name or not (a.held and b.held):
                    continue
                a = first.setdefault(a.name, a)
                moved = np.linalg.norm(a.position - b.position) > CLOSED_M
                tilted = angle_between(a.normal, b.normal) > CLOSED_RAD
                turned = (a.forward is not None and b.forward is not None and angle_between(
                    np.cross(a.normal, a.forward), np.cross(b.normal, b.forward)) > CLOSED_RAD)
                off += moved or tilted or turned
        report.add("contact_relabelled", off, 0, "count", plan.ids[vertex], plan.time[vertex])
