"""Poses, velocities and accelerations of all links of a robot, at many moments at once.

    links = Links(robot, q)                      # q: moments x (x y z qx qy qz qw joints…)
    links.place(k, [0, 0, 0.1])                  # a point of link k in the world, moments x 3
    links = Links(robot, q, rates, accelerations)

rates and accelerations: of the base position in world axes, of the base's rotation along its own
axes, of the joints.
"""

import numpy as np

from rotations import exp, from_quaternion


def turn(matrices, vector):
    """Matrices times one vector, or as many vectors."""
    return np.einsum("nij,nj->ni", matrices, np.broadcast_to(vector, matrices.shape[:1] + (3,)))


class Links:
    def __init__(self, robot, q, rates=None, accelerations=None):
        q = np.atleast_2d(q)
        self.robot, self.count = robot, len(q)
        self.rotation, self.origin, self.axis = [], [], []
        self.moves = rates is not None
        zero = np.zeros((self.count, 6 + len(robot.active)))
        rates = zero if rates is None else np.atleast_2d(rates)
        accelerations = zero if accelerations is None else np.atleast_2d(accelerations)
        base = from_quaternion(q[:, 3:7])
        # Of each link: angular velocity and acceleration, velocity and acceleration of its origin.
        self.omega, self.alpha, self.velocity, self.acceleration = [], [], [], []
        for k, link in enumerate(robot.links):
            if link.parent_joint is None:
                self._append(base, q[:, :3], np.zeros((self.count, 3)))
                self._append_rates(turn(base, rates[:, 3:6]), turn(base, accelerations[:, 3:6]),
                                   rates[:, :3], accelerations[:, :3])
                continue
            joint = link.parent_joint
            parent = robot.link_index[joint.parent]
            if joint.index is None:
                position = np.full(self.count, joint.frozen)
                speed = push = np.zeros(self.count)
            else:
                factor = joint.multiplier
                position = factor * q[:, 7 + joint.index] + (joint.offset if joint.leader else 0.0)
                speed = factor * rates[:, 6 + joint.index]
                push = factor * accelerations[:, 6 + joint.index]
            self._add(joint, parent, position, speed, push)

    def _append(self, rotation, origin, axis):
        self.rotation.append(rotation)
        self.origin.append(origin)
        self.axis.append(axis)

    def _append_rates(self, omega, alpha, velocity, acceleration):
        self.omega.append(omega)
        self.alpha.append(alpha)
        self.velocity.append(velocity)
        self.acceleration.append(acceleration)

    def _add(self, joint, parent, position, speed, push):
        before = self.rotation[parent] @ joint.rotation
        z = turn(before, joint.axis)
        arm = turn(self.rotation[parent], joint.translation)
        prismatic = joint.type == "prismatic"
        if prismatic:
            arm = arm + position[:, None] * z
            rotation = before
        else:
            rotation = before @ exp(position[:, None] * joint.axis) if joint.movable else before
        self._append(rotation, self.origin[parent] + arm, z)
        if not self.moves:
            return
        omega, alpha = self.omega[parent], self.alpha[parent]
        along, pushed = speed[:, None] * z, push[:, None] * z
        velocity = self.velocity[parent] + np.cross(omega, arm)
        acceleration = (self.acceleration[parent] + np.cross(alpha, arm)
                        + np.cross(omega, np.cross(omega, arm)))
        if prismatic:
            velocity = velocity + along
            acceleration = acceleration + 2.0 * np.cross(omega, along) + pushed
            self._append_rates(omega, alpha, velocity, acceleration)
        elif joint.movable:
            self._append_rates(omega + along, alpha + pushed + np.cross(omega, along),
                               velocity, acceleration)
        else:
            self._append_rates(omega, alpha, velocity, acceleration)

    def place(self, link, point):
        return self.origin[link] + turn(self.rotation[link], point)

    def direction(self, link, vector):
        return turn(self.rotation[link], vector)

    def velocity_of(self, link, point):
        return self.velocity[link] + np.cross(self.omega[link], turn(self.rotation[link], point))
