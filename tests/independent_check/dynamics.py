"""What gravity and inertia ask of the base and of the joints: Newton and Euler, link by link.

    demand = required(links)         # moments x (force, moment about the base origin, torques)
    column = effect(links, t, link, point, force, moment)   # what a wrench at moment t does

Force and moment of the base are along world axes. A wrench holds the robot where the effects of all
of them equal the demand in the first six numbers; the joints bear what is left over in the others.
"""

import numpy as np

from kinematics import turn

GRAVITY = np.array([0.0, 0.0, -9.81])


def chain(robot, link):
    """The joints that an active joint moves, from a link up to the base, with their links."""
    found = []
    joint = robot.links[link].parent_joint
    while joint is not None:
        if joint.index is not None:
            found.append((joint, robot.link_index[joint.child]))
        joint = robot.links[robot.link_index[joint.parent]].parent_joint
    return found


def chains(robot):
    if not hasattr(robot, "_chains"):
        robot._chains = [chain(robot, k) for k in range(len(robot.links))]
    return robot._chains


def required(links):
    robot = links.robot
    demand = np.zeros((links.count, 6 + len(robot.active)))
    for k, link in enumerate(robot.links):
        if link.mass == 0.0 and not link.inertia.any():
            continue
        arm = turn(links.rotation[k], link.com)
        force = -link.mass * GRAVITY * np.ones((links.count, 1))
        moment = np.zeros((links.count, 3))
        if links.moves:
            omega, alpha = links.omega[k], links.alpha[k]
            centre = (links.acceleration[k] + np.cross(alpha, arm)
                      + np.cross(omega, np.cross(omega, arm)))
            inertia = links.rotation[k] @ link.inertia @ links.rotation[k].transpose(0, 2, 1)
            force = force + link.mass * centre
            moment = turn(inertia, alpha) + np.cross(omega, turn(inertia, omega))
        _add(demand, links, slice(None), k, links.origin[k] + arm, force, moment)
    return demand


def _add(out, links, t, link, point, force, moment):
    out[..., :3] += force
    out[..., 3:6] += np.cross(point - links.origin[0][t], force) + moment
    for joint, below in chains(links.robot)[link]:
        axis = links.axis[below][t]
        if joint.type == "prismatic":
            work = np.sum(axis * force, axis=-1)
        else:
            about = np.cross(point - links.origin[below][t], force) + moment
            work = np.sum(axis * about, axis=-1)
        out[..., 6 + joint.index] += joint.multiplier * work


def effect(links, t, link, point, force, moment):
    """Of several wrenches on one link at once: point, force and moment are wrenches x 3."""
    force = np.atleast_2d(force)
    out = np.zeros((len(force), 6 + len(links.robot.active)))
    _add(out, links, t, link, point, force, moment)
    return out


def momentum(links):
    """Linear momentum, and angular momentum about the world's origin: their rates are a cross-check."""
    linear, angular = np.zeros((links.count, 3)), np.zeros((links.count, 3))
    for k, link in enumerate(links.robot.links):
        if link.mass == 0.0:
            continue
        arm = turn(links.rotation[k], link.com)
        part = link.mass * (links.velocity[k] + np.cross(links.omega[k], arm))
        inertia = links.rotation[k] @ link.inertia @ links.rotation[k].transpose(0, 2, 1)
        linear += part
        angular += np.cross(links.origin[k] + arm, part) + turn(inertia, links.omega[k])
    return linear, angular
