# SPDX-License-Identifier: BSD-3-Clause
"""Measures of the finished meshes: distances, inside and outside, crossings, shape of the triangles."""
import numpy as np

from mesher import angles, cross, dot, norm, volume


def closest_points(points, v, t):
    """For each point the nearest point of the surface (Ericson, Real-Time Collision Detection, 5.1.5), its distance and
    its triangle."""
    a, b, c = v[t[:, 0]], v[t[:, 1]], v[t[:, 2]]
    best = np.full(len(points), np.inf)
    where = np.zeros_like(points)
    which = np.zeros(len(points), int)
    ab, ac = b - a, c - a
    for i, p in enumerate(points):
        ap, bp, cp = p - a, p - b, p - c
        d1, d2, d3, d4, d5, d6 = dot(ab, ap), dot(ac, ap), dot(ab, bp), dot(ac, bp), dot(ab, cp), dot(ac, cp)
        va, vb, vc = d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2
        total = np.maximum(va + vb + vc, 1e-30)
        q = a + ab * (vb / total)[:, None] + ac * (vc / total)[:, None]
        e = d4 - d3
        f = d5 - d6
        side = lambda mask, value: np.copyto(q, value, where=mask[:, None])
        side((va <= 0) & (e >= 0) & (f >= 0), b + (c - b) * (e / np.maximum(e + f, 1e-30))[:, None])
        side((vb <= 0) & (d2 >= 0) & (d6 <= 0), a + ac * (d2 / np.maximum(d2 - d6, 1e-30))[:, None])
        side((vc <= 0) & (d1 >= 0) & (d3 <= 0), a + ab * (d1 / np.maximum(d1 - d3, 1e-30))[:, None])
        side((d6 >= 0) & (d5 <= d6), c)
        side((d3 >= 0) & (d4 <= d3), b)
        side((d1 <= 0) & (d2 <= 0), a)
        d = norm(q - p)
        k = int(np.argmin(d))
        best[i], where[i], which[i] = d[k], q[k], k
    return best, where, which


def inside(points, v, t):
    """Winding number above one half (van Oosterom and Strackee 1983)."""
    out = np.zeros(len(points), bool)
    for i, p in enumerate(points):
        a, b, c = v[t[:, 0]] - p, v[t[:, 1]] - p, v[t[:, 2]] - p
        la, lb, lc = norm(a), norm(b), norm(c)
        angle = 2 * np.arctan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb)
        out[i] = angle.sum() > 2 * np.pi
    return out


def edges(t):
    e = np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]])
    return e[e[:, 0] < e[:, 1]]


def crossings(va, ta, vb, tb):
    """Edges of a that cross triangles of b (of another mesh, or of the same: those that share a vertex do not count)."""
    same = va is vb
    e = edges(ta)
    lo, hi = vb[tb].min(axis=1), vb[tb].max(axis=1)
    found = []
    for i, j in e:
        p, q = va[i], va[j]
        box = ((np.minimum(p, q) <= hi) & (np.maximum(p, q) >= lo)).all(axis=1)
        if same:
            box &= ~((tb == i) | (tb == j)).any(axis=1)
        k = np.flatnonzero(box)
        if len(k) == 0:
            continue
        a, b, c = vb[tb[k, 0]], vb[tb[k, 1]], vb[tb[k, 2]]
        d = (q - p)[None, :].repeat(len(k), axis=0)
        ab, ac, ap = b - a, c - a, p - a
        h = cross(d, ac)
        det = dot(ab, h)
        level = np.abs(det) <= 1e-9 * norm(ab) * norm(h)  # the edge lies in the triangle's plane, as on the flat cut
        det = np.where(level, 1.0, det)
        u = dot(ap, h) / det
        w = cross(ap, ab)
        s = dot(d, w) / det
        r = dot(ac, w) / det
        hit = ~level & (u >= 0) & (s >= 0) & (u + s <= 1) & (r >= 0) & (r <= 1)
        found += [(int(i), int(j), int(x)) for x in k[hit]]
    return found


def shape(v, t):
    """Smallest angle in degrees, longest over shortest edge of a triangle (worst), volume."""
    smallest = float(np.degrees(np.arccos(np.clip(angles(v, t).max(), -1, 1))))
    l = np.stack([norm(v[t[:, (k + 1) % 3]] - v[t[:, k]]) for k in range(3)], axis=1)
    return smallest, float((l.max(axis=1) / l.min(axis=1)).max()), volume(v, t)


def closed(v, t):
    """Every edge once in each direction, one piece of genus 0, every vertex used."""
    directed = set()
    for r in t.tolist():
        for k in range(3):
            directed.add((r[k], r[(k + 1) % 3]))
    return (len(directed) == 3 * len(t) and all((b, a) in directed for a, b in directed)
            and len(t) == 2 * len(v) - 4 and len(np.unique(t)) == len(v))


def girth(v, t, height):
    """Length of the convex hull of the section at a height: what a tape measures."""
    points = []
    for i, j in edges(t):
        za, zb = v[i, 2] - height, v[j, 2] - height
        if za * zb < 0:
            points.append(tuple((v[i] + (v[j] - v[i]) * (za / (za - zb)))[:2]))
    points = sorted(points)

    def half(ps):
        h = []
        for p in ps:
            while len(h) > 1 and ((h[-1][0] - h[-2][0]) * (p[1] - h[-2][1])
                                  - (h[-1][1] - h[-2][1]) * (p[0] - h[-2][0])) <= 0:
                h.pop()
            h.append(p)
        return h[:-1]
    hull = half(points) + half(points[::-1])
    return sum(((p[0] - q[0]) ** 2 + (p[1] - q[1]) ** 2) ** 0.5 for p, q in zip(hull, hull[1:] + hull[:1]))
