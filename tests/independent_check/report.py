"""The worst value of each constraint, its limit and where it is.

    report.add("joint_limits", excess, 1e-6, "rad", vertices, "LKneePitch")
    report.add("balance", margins, 0.0, "1", vertices, "", least=True)
    report.tell("balls roll", "up to 0.031 m, hand")
"""

import numpy as np


class Constraint:
    def __init__(self, name, limit, unit, least, slack):
        self.name, self.limit, self.unit, self.least, self.slack = name, limit, unit, least, slack
        self.worst, self.at_vertex, self.time, self.what, self.count = None, None, None, "", 0

    @property
    def violated(self):
        return self.count > 0

    def add(self, values, vertices, times, what):
        values = np.atleast_1d(np.asarray(values, float))
        if values.size == 0:
            return
        sign = -1.0 if self.least else 1.0
        high = np.where(np.isnan(values), np.inf, sign * values)
        self.count += int(np.sum(high > sign * self.limit + self.slack))
        k = int(np.argmax(high))
        if self.worst is not None and high[k] <= sign * self.worst:
            return
        self.worst = float(values[k])
        self.at_vertex = int(np.broadcast_to(vertices, values.shape)[k])
        self.time = float(np.broadcast_to(times, values.shape)[k])
        self.what = what if isinstance(what, str) else str(what[k])


class Report:
    def __init__(self):
        self.constraints, self.told, self.rolled = {}, {}, {}     # rolled: ways of balls [m], by name

    def add(self, name, values, limit, unit, vertices, times, what="", least=False, slack=0.0):
        if name not in self.constraints:
            self.constraints[name] = Constraint(name, limit, unit, least, slack)
        self.constraints[name].add(values, vertices, times, what)

    def tell(self, what, value):
        self.told[what] = value

    @property
    def feasible(self):
        return not any(c.violated for c in self.constraints.values())

    def worst(self, name):
        found = self.constraints.get(name)
        return None if found is None else found.worst

    def as_dict(self):
        rows = [{"constraint": c.name, "worst": c.worst, "limit": c.limit, "unit": c.unit,
                 "violated": c.violated, "count": c.count, "at_vertex": c.at_vertex, "time": c.time,
                 "what": c.what} for c in self.constraints.values() if c.worst is not None]
        return {"holds": self.feasible, "constraints": rows, "told": self.told}

    def text(self):
        lines = []
        for c in self.constraints.values():
            if c.worst is None:
                continue
            mark = "VIOLATED" if c.violated else "holds"
            lines.append(f"{mark:9}{c.name:22}{c.worst:>13.6g} {c.unit:6}limit {c.limit:<11.6g}"
                         f"vertex {c.at_vertex} at {c.time:.4f} s  {c.what}")
        lines += [f"told      {what}: {value}" for what, value in self.told.items()]
        return "\n".join(lines)
