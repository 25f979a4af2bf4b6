"""Whether a plan begins in the start stance of its scenario and gets to its goals, by its contacts."""

import numpy as np

from rotations import angle_between

CLOSED_M, CLOSED_RAD = 1e-4, 1e-3
DRIVE_M, DRIVE_RAD = 0.25, 0.25
SCAN_M, SCAN_RAD = 0.05, 0.2     # contacts of a scenario are moved onto what a scan holds


def _is(stance, places, scenario, all_locked):
    """The contacts of a stance are those places, no more and no fewer."""
    near, turned = (SCAN_M, SCAN_RAD) if scenario.scans else (CLOSED_M, CLOSED_RAD)
    if {c.name for c in stance} != {p.effector for p in places} or len(stance) != len(places):
        return False
    for place in places:
        contact = next(c for c in stance if c.name == place.effector)
        if contact.kind == "wheel" and not (contact.locked or all_locked):
            return False
        if np.linalg.norm(contact.position - place.position) > near:
            return False
        if contact.kind != "rung" and angle_between(contact.normal, place.normal) > turned:
            return False
        if contact.kind not in ("surface", "rung") or place.forward is None:
            continue
        if contact.forward is None or angle_between(
                np.cross(contact.normal, contact.forward),
                np.cross(place.normal, place.forward)) > turned:
            return False
    return True


def check_ends(report, plan, scenario):
    if plan.moved:
        report.tell("start and goals", "not looked at: their contacts were moved")
        return
    if scenario.drive is not None:
        if not plan.incomplete:
            _check_drive(report, plan, scenario.drive)
        return
    starts = _is(plan.stances.get(plan.stance[0], []), scenario.start, scenario, plan.stances_only)
    report.add("scenario_start", float(not starts), 0, "count", plan.ids[0], plan.time[0])
    if plan.incomplete:
        return
    reached, goals = 0, scenario.goals
    for i, number in enumerate(plan.stance):
        last = i + 1 == len(plan.stance)
        while reached < len(goals) and (reached + 1 < len(goals) or last) and _is(
                plan.stances.get(number, []), goals[reached], scenario, plan.stances_only):
            reached += 1
    report.add("scenario_goals", float(len(goals) - reached), 0, "count", plan.ids[-1], plan.time[-1])


def _check_drive(report, plan, drive):
    distance, curvature = float(drive.get("distance")), float(drive.get("curvature", "0"))
    turn = curvature * distance
    end = np.array([distance, 0.0])
    if abs(turn) > 1e-9:
        end = np.array([np.sin(turn), 1.0 - np.cos(turn)]) / curvature
    x, y, z, w = plan.q[:, 3:7].T
    heading = np.unwrap(np.arctan2(2 * (w * z + x * y), w * w + x * x - y * y - z * z))
    report.add("drive_end", np.linalg.norm(plan.q[-1, :2] - end), DRIVE_M, "m", plan.ids[-1], plan.time[-1])
    report.add("drive_heading", abs(heading[-1] - turn), DRIVE_RAD, "rad", plan.ids[-1], plan.time[-1])
    report.add("drive_start", np.linalg.norm(plan.q[0, :2]), CLOSED_M, "m", plan.ids[0], plan.time[0])
    report.add("drive_start_heading", abs(heading[0]), CLOSED_RAD, "rad", plan.ids[0], plan.time[0])
