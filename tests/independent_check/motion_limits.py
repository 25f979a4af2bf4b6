"""Limits of joints and base along the curve: at its vertices, midway, and where its cubics turn back."""

import numpy as np

ROUNDING = 1e-6
AT_REST = 1e-6       # m/s, rad/s


def check_configurations(report, plan, robot):
    """What holds of plans of stances, too."""
    ids = np.array(plan.ids)
    norm = np.linalg.norm(plan.q[:, 3:7], axis=1)
    report.add("base_orientation", np.abs(norm - 1), 1e-6, "1", ids, plan.time)
    for i, joint in enumerate(robot.active_joints):
        q = plan.q[:, 7 + i]
        if joint.type != "continuous":
            report.add("joint_limits", np.maximum(joint.lower - q, q - joint.upper), ROUNDING, "rad",
                       ids, plan.time, joint.name)


def check_times(report, plan):
    ids, times = np.array(plan.ids[:-1]), plan.time[:-1]
    report.add("time_order", np.diff(plan.time), 0.0, "s", ids, times, least=True, slack=-1e-300)
    if plan.time[0] < 0.0:
        report.add("time_order", plan.time[0], 0.0, "s", plan.ids[0], plan.time[0], "before 0", least=True)


def check_motion(report, plan, robot, scenario, curve):
    ids, times = np.array(plan.ids[:-1]), curve.time[:-1]
    if not plan.incomplete:
        for end in (0, -1):
            report.add("end_at_rest", np.abs(curve.slope[end]).max(), AT_REST, "rad/s", plan.ids[end],
                       curve.time[end], "slope of the first or last vertex")
    turning = curve.joint_extremes()
    for i, joint in enumerate(robot.active_joints):
        k = 6 + i
        a, b, c = curve.first[:, k], curve.second[:, k], curve.third[:, k]
        h = curve.duration
        # Where a joint turns back, and at the ends and midway.
        s = np.stack([np.zeros_like(a), np.full_like(a, 0.5), np.ones_like(a),
                      turning[:, i, 0], turning[:, i, 1]])
        q = plan.q[:-1, 7 + i] + s * (a + s * (b + s * c))
        if joint.type != "continuous":
            report.add("joint_limits", np.maximum(joint.lower - q, q - joint.upper).max(axis=0),
                       ROUNDING, "rad", ids, times, joint.name)
        # The velocity is a parabola, the acceleration a line.
        with np.errstate(divide="ignore", invalid="ignore"):
            top = -b / (3 * c)
        s[3] = np.where(np.isfinite(top) & (top > 0) & (top < 1), top, 0.0)
        rate = np.abs((a + s[:4] * (2 * b + 3 * s[:4] * c)) / h).max(axis=0)
        if np.isfinite(joint.max_velocity):
            with np.errstate(divide="ignore", invalid="ignore"):
                ratio = np.where(rate > 0, rate / joint.max_velocity, 0.0)
            report.add("velocity_limits", ratio, 1.0, "ratio", ids, times, joint.name, slack=ROUNDING)
        if np.isfinite(scenario.joint_acceleration):
            push = np.abs(np.stack([2 * b, 2 * b + 6 * c]) / h**2).max(axis=0)
            report.add("acceleration_limits", push / scenario.joint_acceleration, 1.0, "ratio", ids,
                       times, joint.name, slack=ROUNDING)
    _check_base(report, scenario, curve, ids, times)


def _check_base(report, scenario, curve, ids, times):
    fractions = np.linspace(0, 1, 17)
    for limit, rows, what in ((scenario.base_linear, slice(0, 3), "linear"),
                              (scenario.base_angular, slice(3, 6), "angular")):
        if not np.isfinite(limit):
            continue
        speed = np.zeros(curve.steps)
        for s in fractions:
            _, rate, _ = curve.at(np.arange(curve.steps), np.full(curve.steps, s))
            speed = np.maximum(speed, np.linalg.norm(rate[:, rows], axis=1))
        report.add("base_velocity", speed / limit, 1.0, "ratio", ids, times, what, slack=ROUNDING)
