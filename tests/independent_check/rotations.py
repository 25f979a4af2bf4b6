"""Rotation matrices and rotation vectors, many at once: the last axes are those of a matrix or vector."""

import numpy as np


def skew(v):
    v = np.asarray(v, float)
    m = np.zeros(v.shape[:-1] + (3, 3))
    m[..., 0, 1], m[..., 0, 2] = -v[..., 2], v[..., 1]
    m[..., 1, 0], m[..., 1, 2] = v[..., 2], -v[..., 0]
    m[..., 2, 0], m[..., 2, 1] = -v[..., 1], v[..., 0]
    return m


def _coefficients(v):
    """sin t / t, (1 - cos t) / t^2, (t - sin t) / t^3 for t = |v|; series where t is small."""
    t2 = np.sum(np.asarray(v, float) ** 2, axis=-1)
    small = t2 < 1e-4
    safe = np.where(small, 1.0, t2)
    t = np.sqrt(safe)
    a = np.where(small, 1 - t2 / 6 + t2**2 / 120 - t2**3 / 5040, np.sin(t) / t)
    b = np.where(small, 0.5 - t2 / 24 + t2**2 / 720 - t2**3 / 40320, (1 - np.cos(t)) / safe)
    c = np.where(small, 1 / 6 - t2 / 120 + t2**2 / 5040 - t2**3 / 362880, (t - np.sin(t)) / (safe * t))
    return a[..., None, None], b[..., None, None], c[..., None, None]


def exp(v):
    """Rotation matrix of a rotation vector."""
    a, b, _ = _coefficients(v)
    k = skew(v)
    return np.eye(3) + a * k + b * (k @ k)


def log(rotation):
    """Rotation vector of a rotation matrix, the short way round."""
    q = quaternion(rotation)
    q = np.where(q[..., 3:] < 0.0, -q, q)
    length = np.linalg.norm(q[..., :3], axis=-1, keepdims=True)
    angle = 2.0 * np.arctan2(length, q[..., 3:])
    return np.where(length < 1e-12, 2.0, angle / np.maximum(length, 1e-300)) * q[..., :3]


def quaternion(rotation):
    """x y z w of rotation matrices (Shepperd's method: divides by the largest)."""
    m = np.asarray(rotation, float)
    xx, yy, zz = m[..., 0, 0], m[..., 1, 1], m[..., 2, 2]
    trace = xx + yy + zz
    xy, xz, yz = (m[..., i, j] + m[..., j, i] for i, j in ((0, 1), (0, 2), (1, 2)))
    x, y, z = (m[..., i, j] - m[..., j, i] for i, j in ((2, 1), (0, 2), (1, 0)))
    rows = np.stack([np.stack([1 + 2 * xx - trace, xy, xz, x], -1),
                     np.stack([xy, 1 + 2 * yy - trace, yz, y], -1),
                     np.stack([xz, yz, 1 + 2 * zz - trace, z], -1),
                     np.stack([x, y, z, 1 + trace], -1)], -2)
    largest = np.argmax(np.stack([xx, yy, zz, trace], -1), axis=-1)
    q = np.take_along_axis(rows, largest[..., None, None], axis=-2)[..., 0, :]
    return q / np.linalg.norm(q, axis=-1, keepdims=True)


def from_quaternion(q):
    """Rotation matrices of quaternions x y z w of any length."""
    q = np.asarray(q, float)
    q = q / np.linalg.norm(q, axis=-1, keepdims=True)
    v, w = q[..., :3], q[..., 3:, None]
    k = skew(v)
    return np.eye(3) + 2.0 * w * k + 2.0 * (k @ k)


def from_rpy(rpy):
    """Roll about x, then pitch about y, then yaw about z, all fixed axes, as in URDF."""
    r, p, y = rpy
    return exp([0, 0, y]) @ exp([0, p, 0]) @ exp([r, 0, 0])


def right_jacobian(v):
    """Jr: the rotation exp(v(t)) turns by Jr(v) v' about its own axes."""
    _, b, c = _coefficients(v)
    k = skew(v)
    return np.eye(3) - b * k + c * (k @ k)


def own_rates(v, dv, ddv):
    """Angular velocity and acceleration, along its own axes, of exp(v(t))."""
    v, dv, ddv = (np.asarray(x, float) for x in (v, dv, ddv))
    _, b, c = _coefficients(v)
    t2 = np.sum(v * v, axis=-1)[..., None, None]
    small = t2 < 1e-4
    safe = np.where(small, 1.0, t2)
    # db = b'/t, dc = c'/t, so that the time derivative of b is db v.dv.
    db = np.where(small, -1 / 12 + t2 / 180, (_coefficients(v)[0] - 2 * b) / safe)
    dc = np.where(small, -1 / 60 + t2 / 1260, (b - 3 * c) / safe)
    k, dk = skew(v), skew(dv)
    rate = np.sum(v * dv, axis=-1)[..., None, None]
    jacobian = np.eye(3) - b * k + c * (k @ k)
    derivative = -b * dk - rate * db * k + c * (dk @ k + k @ dk) + rate * dc * (k @ k)
    velocity = (jacobian @ dv[..., None])[..., 0]
    return velocity, (derivative @ dv[..., None] + jacobian @ ddv[..., None])[..., 0]


def angle_between(a, b):
    """Of vectors of any length."""
    return np.arctan2(np.linalg.norm(np.cross(a, b), axis=-1), np.sum(a * b, axis=-1))
