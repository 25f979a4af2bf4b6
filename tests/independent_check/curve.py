"""The one curve that a plan defines: configurations, rates and accelerations anywhere along it.

    curve = Curve(plan)
    q, rate, acceleration = curve.at(steps, fractions)     # arrays of the same length

Joints and base position are cubics (Hermite) over each step, the base's rotation is R exp(c) with c
a cubic of the step's rotation vector. Rates: base position in the world, rotation along the base's
own axes, joints.
"""

import numpy as np

from rotations import exp, from_quaternion, log, own_rates, quaternion, right_jacobian


class Curve:
    def __init__(self, plan):
        self.q, self.time = plan.q, plan.time
        self.steps = len(plan.q) - 1
        self.duration = np.diff(plan.time)
        self.rotation = from_quaternion(self.q[:, 3:7])
        self.turn = log(self.rotation[:-1].transpose(0, 2, 1) @ self.rotation[1:])
        self.change = np.hstack([np.diff(self.q[:, :3], axis=0), self.turn, np.diff(self.q[:, 7:], axis=0)])
        self.slope = self._slopes(plan)
        # value = first s + second s^2 + third s^3 above that of the first vertex.
        h = self.duration[:, None]
        start, end = h * self.slope[:-1], h * self.slope[1:]
        if self.steps:
            inverse = np.linalg.inv(right_jacobian(self.turn))
            end[:, 3:6] = np.einsum("nij,nj->ni", inverse, end[:, 3:6])
        self.first, self.second, self.third = (
            start, 3 * self.change - 2 * start - end, start + end - 2 * self.change)

    def _slopes(self, plan):
        slope = np.zeros((len(self.q), self.q.shape[1] - 1))
        for i, stored in enumerate(plan.slopes):
            if stored is not None:
                slope[i] = stored
            elif 0 < i < self.steps and plan.stance[i] == plan.stance[i - 1]:
                h0, h1 = self.duration[i - 1], self.duration[i]
                d0, d1 = self.change[i - 1] / h0, self.change[i] / h1
                slope[i] = (h1 * d0 + h0 * d1) / (h0 + h1)
        return slope

    def at(self, steps, fractions):
        steps = np.asarray(steps)
        s, h = np.asarray(fractions, float)[:, None], self.duration[steps][:, None]
        a, b, c = self.first[steps], self.second[steps], self.third[steps]
        value = s * (a + s * (b + s * c))
        rate = (a + s * (2 * b + 3 * s * c)) / h
        acceleration = (2 * b + 6 * s * c) / h**2
        q = self.q[steps].copy()
        q[:, :3] += value[:, :3]
        q[:, 7:] += value[:, 6:]
        turned = self.rotation[steps] @ exp(value[:, 3:6])
        q[:, 3:7] = quaternion(turned)
        rate[:, 3:6], acceleration[:, 3:6] = own_rates(
            value[:, 3:6], rate[:, 3:6], acceleration[:, 3:6])
        return q, rate, acceleration

    def time_at(self, step, fraction):
        return self.time[step] + fraction * self.duration[step]

    def joint_extremes(self):
        """Fractions of each step (steps x joints x 2) where a joint turns back; 0 where it does not."""
        a, b, c = (3 * self.third[:, 6:], 2 * self.second[:, 6:], self.first[:, 6:])
        with np.errstate(divide="ignore", invalid="ignore"):
            root = np.sqrt(np.maximum(b * b - 4 * a * c, 0.0))
            half = -0.5 * (b + np.where(b >= 0, root, -root))
            found = np.stack([half / a, c / half], axis=-1)
        bad = ~np.isfinite(found) | (b * b < 4 * a * c)[..., None] | (found < 0) | (found > 1)
        return np.where(bad, 0.0, found)
