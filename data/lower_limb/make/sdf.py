# SPDX-License-Identifier: BSD-3-Clause
"""Solids as functions of a point: negative inside, about the signed distance in millimetres near the surface.

A solid is a function f(x, y, z) of three arrays. Only + - * / sqrt min max are used, which IEEE arithmetic
rounds correctly on every machine: the same meshes come out everywhere, bit for bit.
"""
import numpy as np


def length(x, y, z):
    return np.sqrt(x * x + y * y + z * z)


def union(*solids):
    def f(x, y, z):
        d = solids[0](x, y, z)
        for s in solids[1:]:
            d = np.minimum(d, s(x, y, z))
        return d
    return f


def smooth_min(a, b, k):
    """min(a, b) with the edge filled over a width of k (polynomial, C1)."""
    h = np.maximum(k - np.abs(a - b), 0.0) / k
    return np.minimum(a, b) - h * h * (k * 0.25)


def smooth_max(a, b, k):
    return -smooth_min(-a, -b, k)


def blend(k, *solids):
    """Union with fillets of width k."""
    def f(x, y, z):
        d = solids[0](x, y, z)
        for s in solids[1:]:
            d = smooth_min(d, s(x, y, z), k)
        return d
    return f


def carve(k, solid, *tools):
    """The solid without the tools, edges rounded over k."""
    def f(x, y, z):
        d = solid(x, y, z)
        for t in tools:
            d = smooth_max(d, -t(x, y, z), k)
        return d
    return f


def common(k, *solids):
    """Intersection, edges rounded over k."""
    def f(x, y, z):
        d = solids[0](x, y, z)
        for s in solids[1:]:
            d = smooth_max(d, s(x, y, z), k)
        return d
    return f


def offset(solid, thickness):
    """The solid grown by a thickness."""
    return lambda x, y, z: solid(x, y, z) - thickness


def half_space(point, outward):
    """The points behind a plane."""
    n = np.asarray(outward, float)
    n = n / np.sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2])
    p = point
    return lambda x, y, z: (x - p[0]) * n[0] + (y - p[1]) * n[1] + (z - p[2]) * n[2]


def ball(centre, radius):
    c = centre
    return lambda x, y, z: length(x - c[0], y - c[1], z - c[2]) - radius


def frame(axis, up=(0.0, 0.0, 1.0)):
    """Orthonormal rows (e1, e2, e3): e2 along axis, e3 as near to up as can be, e1 = e2 x e3."""
    e2 = np.asarray(axis, float)
    e2 = e2 / length(*e2)
    u = np.asarray(up, float)
    e3 = u - e2 * (u[0] * e2[0] + u[1] * e2[1] + u[2] * e2[2])
    e3 = e3 / length(*e3)
    e1 = np.array([e2[1] * e3[2] - e2[2] * e3[1], e2[2] * e3[0] - e2[0] * e3[2], e2[0] * e3[1] - e2[1] * e3[0]])
    return e1, e2, e3


WORLD = (np.array([1.0, 0, 0]), np.array([0, 1.0, 0]), np.array([0, 0, 1.0]))


def _local(x, y, z, c, axes):
    dx, dy, dz = x - c[0], y - c[1], z - c[2]
    return [dx * e[0] + dy * e[1] + dz * e[2] for e in axes]


def ellipsoid(centre, radii, axes=WORLD):
    """Half axes along the rows of `axes`; distance by one Newton step, exact on the surface."""
    a, b, c = radii

    def f(x, y, z):
        u, v, w = _local(x, y, z, centre, axes)
        k0 = length(u / a, v / b, w / c)
        k1 = length(u / (a * a), v / (b * b), w / (c * c))
        return np.where(k1 > 1e-9, k0 * (k0 - 1.0) / np.maximum(k1, 1e-9), -min(radii))
    return f


def box(centre, half, rounding, axes=WORLD):
    """Box of half extents `half` along the rows of `axes`, edges rounded by a radius (inside the extents)."""
    h = [max(s - rounding, 0.0) for s in half]

    def f(x, y, z):
        u, v, w = _local(x, y, z, centre, axes)
        qx, qy, qz = np.abs(u) - h[0], np.abs(v) - h[1], np.abs(w) - h[2]
        outside = length(np.maximum(qx, 0.0), np.maximum(qy, 0.0), np.maximum(qz, 0.0))
        return outside + np.minimum(np.maximum(qx, np.maximum(qy, qz)), 0.0) - rounding
    return f


def cone(a, b, ra, rb, squeeze=None, factor=1.0):
    """Round cone: ball of radius ra at a, of rb at b, straight between; thickness along `squeeze` times factor."""
    a, b = np.asarray(a, float), np.asarray(b, float)
    d = b - a
    dd = d[0] * d[0] + d[1] * d[1] + d[2] * d[2]
    if squeeze is not None:
        s = np.asarray(squeeze, float)
        s = s - d * ((s[0] * d[0] + s[1] * d[1] + s[2] * d[2]) / dd)
        s = s / length(*s)

    def f(x, y, z):
        px, py, pz = x - a[0], y - a[1], z - a[2]
        t = np.clip((px * d[0] + py * d[1] + pz * d[2]) / dd, 0.0, 1.0)
        qx, qy, qz = px - t * d[0], py - t * d[1], pz - t * d[2]
        r = ra + t * (rb - ra)
        if squeeze is None:
            return length(qx, qy, qz) - r
        along = qx * s[0] + qy * s[1] + qz * s[2]
        extra = along * (1.0 / factor - 1.0)
        rho = length(qx, qy, qz)
        n = length(qx + extra * s[0], qy + extra * s[1], qz + extra * s[2]) / r
        return rho - rho / np.maximum(n, 1e-9)
    return f


def interpolate(keys, values, t):
    """Monotone cubic through (keys, values) (Fritsch and Carlson 1980, harmonic-mean slopes); constant beyond the ends."""
    keys, values = np.asarray(keys, float), np.asarray(values, float)
    h, slope = np.diff(keys), np.diff(values) / np.diff(keys)
    m = np.zeros(len(keys))
    m[0], m[-1] = slope[0], slope[-1]
    for i in range(1, len(keys) - 1):
        if slope[i - 1] * slope[i] > 0:
            w1, w2 = 2 * h[i] + h[i - 1], h[i] + 2 * h[i - 1]
            m[i] = (w1 + w2) / (w1 / slope[i - 1] + w2 / slope[i])
    t = np.clip(t, keys[0], keys[-1])
    i = np.clip(np.searchsorted(keys, t, side='right') - 1, 0, len(keys) - 2)
    s = (t - keys[i]) / h[i]
    s2, s3 = s * s, s * s * s
    return (values[i] * (2 * s3 - 3 * s2 + 1) + h[i] * m[i] * (s3 - 2 * s2 + s)
            + values[i + 1] * (3 * s2 - 2 * s3) + h[i] * m[i + 1] * (s3 - s2))


def tube(points, radii, pieces=6):
    """Round bar along a smooth curve through the points, its radius interpolated."""
    points = np.asarray(points, float)
    keys = np.arange(len(points), dtype=float)
    t = np.arange((len(points) - 1) * pieces + 1) / pieces
    p = np.stack([interpolate(keys, points[:, j], t) for j in range(3)], axis=1)
    r = interpolate(keys, radii, t)
    return union(*[cone(p[i], p[i + 1], r[i], r[i + 1]) for i in range(len(t) - 1)])


def loft(sections, rounding, squareness=0.0):
    """Column along z. A section is (z, centre x, centre y, half width +x, -x, half depth -y (front), +y (back)).

    Sections are ellipses of four quarters, squared towards the fourth-power ellipse; the ends are flat.
    """
    s = np.asarray(sections, float)
    s = s[np.argsort(s[:, 0])]
    keys = s[:, 0]

    def f(x, y, z):
        cx, cy, xp, xm, ym, yp = [interpolate(keys, s[:, j], z) for j in range(1, 7)]
        u, v = x - cx, y - cy
        un, vn = u / np.where(u > 0, xp, xm), v / np.where(v > 0, yp, ym)
        u2, v2 = un * un, vn * vn
        n = (1 - squareness) * np.sqrt(u2 + v2) + squareness * np.sqrt(np.sqrt(u2 * u2 + v2 * v2))
        rho = np.sqrt(u * u + v * v)
        side = np.where(n > 1e-6, rho - rho / np.maximum(n, 1e-6), -np.minimum(xp, yp))
        ends = np.maximum(z - keys[-1], keys[0] - z)
        return smooth_max(side, ends, rounding)
    return f
