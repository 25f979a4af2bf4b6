"""How much margin contacts have to hold a robot: one linear programme for each moment and stance.

    holder = Holder(robot, scenario, effectors, enforce_torques=True)
    answer = holder.margin(links, t, demand[t], contacts, torques=True)
    answer.margin, answer.limiting, answer.torque_ratio

At each corner of a sole, and at each ball, wheel or point, acts a force f. W is the weight, c the
number of corners, s the margin, the largest s <= 1 with, along the contact's axes,

    n_k . f <= mu cos(pi/16) f_z - s W / c      16 directions n_k of the contact's plane
    sum of f_z <= (1 - s) f_max                 of the whole contact
    |each component| <= (1 - s) limit           of force and moment of a grasp
    |torque| <= (1 - s) effort                  where the scenario enforces it

while all of them together do to the base what gravity and inertia ask for. If nothing does, the
least |s|, s < 0, with which it is met within |s| W and |s| W m along the base's axes. The torque
ratio is the least largest |torque| / effort that balances at s = 0.
"""

import numpy as np
from scipy.optimize import linprog

from contacts import bearing_axes, touching
from dynamics import effect
from support import rectangle, support_of

SIDES = 16


class Answer:
    def __init__(self, margin, limiting, supports, torque_ratio=None, without_torques=None):
        self.margin, self.limiting, self.supports = margin, limiting, supports
        self.torque_ratio, self.without_torques = torque_ratio, without_torques


class Row:
    """coefficients . forces + share * s <= bound"""

    def __init__(self, coefficients, share, bound, what, torque=False):
        self.coefficients, self.share, self.bound, self.what = coefficients, share, bound, what
        self.torque = torque


class Holder:
    def __init__(self, robot, scenario, effectors, enforce_torques):
        self.robot, self.scenario, self.effectors = robot, scenario, effectors
        self.enforce_torques = enforce_torques
        self.weight = robot.mass * 9.81
        self.efforts = scenario.effort_scale * np.array([j.max_effort for j in robot.active_joints])

    def margin(self, links, t, demand, contacts, torques=False):
        """torques: also the torque ratio, and where nothing balances the margin without torque limits."""
        columns, rows, supports = [], [], []
        for contact in contacts:
            supports.append(self._add_contact(links, t, contact, columns, rows))
        if not columns:
            return Answer(-np.inf, "nothing bears", supports)
        effects = np.array(columns).T                    # of a force of the weight, each
        base = links.rotation[0][t].T
        turned = np.vstack([base @ effects[:3], base @ effects[3:6]]) / self.weight
        asked = np.concatenate([base @ demand[:3], base @ demand[3:6]]) / self.weight
        limited = rows + self._torque_rows(effects, demand)
        counted = limited if self.enforce_torques else rows
        best = self._best(turned, asked, counted)
        if not torques:
            return Answer(*best, supports)
        without = self._best(turned, asked, rows)[0] if best[0] < 0.0 else None
        return Answer(*best, supports, self._least_torques(turned, asked, limited), without)

    def _best(self, turned, asked, rows):
        return (self._largest(turned, asked, rows) or self._least_violation(turned, asked, rows)
                or (-np.inf, "no solution"))

    def _torque_rows(self, effects, demand):
        rows = []
        for j, effort in enumerate(self.efforts):
            if np.isinf(effort):
                continue
            row, need = effects[6 + j] / effort, demand[6 + j] / effort
            for sign in (1.0, -1.0):
                rows.append(Row(-sign * row, 1.0, 1.0 - sign * need,
                                f"torque of {self.robot.active[j]}", torque=True))
        return rows

    @staticmethod
    def _matrix(rows, count, last):
        return np.array([np.append(np.pad(r.coefficients, (0, count - len(r.coefficients))), last(r))
                         for r in rows])

    def _largest(self, turned, asked, rows):
        matrix = self._matrix(rows, turned.shape[1], lambda r: r.share)
        found = _programme(-1.0, matrix, [r.bound for r in rows], turned, asked, (0.0, 1.0))
        return found and self._answer(found, matrix, [r.what for r in rows])

    def _least_violation(self, turned, asked, rows):
        matrix = self._matrix(rows, turned.shape[1], lambda r: r.share)
        slack = np.ones((6, 1))
        matrix = np.vstack([matrix, np.hstack([turned, slack]), np.hstack([-turned, slack])])
        bounds = np.concatenate([[r.bound for r in rows], asked, -asked])
        found = _programme(-1.0, matrix, bounds, None, None, (None, 0.0))
        return found and self._answer(
            found, matrix, [r.what for r in rows] + ["what is left over on the base"] * 12)

    def _least_torques(self, turned, asked, rows):
        matrix = self._matrix(rows, turned.shape[1], lambda r: -1.0 if r.torque else 0.0)
        bounds = [r.bound - (1.0 if r.torque else 0.0) for r in rows]
        found = _programme(1.0, matrix, bounds, turned, asked, (0.0, None))
        return None if found is None else float(found.x[-1])

    @staticmethod
    def _answer(found, matrix, names):
        prices = -np.asarray(found.ineqlin.marginals) * matrix[:, -1]
        k = int(np.argmax(prices))
        return float(found.x[-1]), names[k] if prices[k] > 1e-9 else "nothing"

    def _add_contact(self, links, t, contact, columns, rows):
        effector = self.effectors[contact.name]
        link = self.robot.link_index[effector.link]
        moment_of = _Moment(links, t, link, effector)
        point = touching(contact, effector, moment_of)
        axes = bearing_axes(contact, effector, moment_of)
        support = support_of(contact, effector, self.scenario, axes, point)
        if not contact.bears_load or not support.bears:
            return support
        if contact.kind == "rung":
            self._add_grasp(links, t, link, effector, point, axes, columns, rows)
            return support
        corners = np.zeros((1, 2))
        if contact.kind == "surface":
            corners = rectangle(effector.half) if support.corners is None else support.corners
        begin, mu = len(columns), support.friction * np.cos(np.pi / SIDES)
        for corner in corners:
            here = len(columns)
            at = point + axes[:, :2] @ corner
            columns.extend(effect(links, t, link, at, self.weight * axes.T, np.zeros((3, 3))))
            for k in range(SIDES):
                angle = 2 * np.pi * k / SIDES
                row = np.zeros(here + 3)
                row[here:] = np.cos(angle), np.sin(angle), -mu
                rows.append(Row(row, 1.0 / len(corners), 0.0, f"friction of {contact.name}"))
        row = np.zeros(len(columns))
        row[begin + 2::3] = self.weight / effector.max_force
        rows.append(Row(row, 1.0, 1.0, f"force limit of {contact.name}"))
        return support

    def _add_grasp(self, links, t, link, effector, point, axes, columns, rows):
        for component in (0, 1, 2, 3, 5):
            limit = effector.max_force if component < 3 else effector.max_moment
            if limit == 0.0:
                continue
            force, moment = np.zeros(3), np.zeros(3)
            (force if component < 3 else moment)[:] = self.weight * axes[:, component % 3]
            columns.extend(effect(links, t, link, point, force, moment[None]))
            for sign in (1.0, -1.0):
                row = np.zeros(len(columns))
                row[-1] = sign * self.weight / limit
                rows.append(Row(row, 1.0, 1.0, f"limit of {effector.name}"))


class _Moment:
    """The part of a trace that a single moment has."""

    def __init__(self, links, t, link, effector):
        self.rotation = links.rotation[link][t]
        self.point = links.origin[link][t] + self.rotation @ effector.point
        self.axle = links.axis[link][t]


def _programme(sign, matrix, bounds, turned, asked, last):
    """Least sign * (last unknown); None where nothing fulfils the rows."""
    count = matrix.shape[1] - 1
    equal = None if turned is None else np.hstack([turned, np.zeros((6, 1))])
    found = linprog(np.append(np.zeros(count), sign), matrix, bounds, equal, asked,
                    [(None, None)] * count + [last], method="highs",
                    options={"primal_feasibility_tolerance": 1e-9, "dual_feasibility_tolerance": 1e-9})
    return found if found.status == 0 else None
