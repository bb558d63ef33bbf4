# SPDX-License-Identifier: BSD-3-Clause
"""From a solid (sdf.py) to a closed triangle mesh with an exact number of vertices and well-shaped triangles.

Marching tetrahedra on a grid (always a closed manifold), edge collapse of the relatively shortest edge, edge flips
towards Delaunay, tangential smoothing, projection onto the surface of the solid.
"""
import heapq

import numpy as np

# The six tetrahedra around the main diagonal of a cube; corner = bit 0: x, bit 1: y, bit 2: z.
TETRAHEDRA = [(0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7), (0, 5, 1, 7)]


def evaluate(solid, points, chunk=40000):
    out = np.empty(len(points))
    for i in range(0, len(points), chunk):
        p = points[i:i + chunk]
        out[i:i + chunk] = solid(p[:, 0].copy(), p[:, 1].copy(), p[:, 2].copy())
    return out


def gradient(solid, points, values, h=0.05):
    """Forward differences; values = the solid at the points."""
    g = np.empty_like(points)
    for j in range(3):
        d = np.zeros(3)
        d[j] = h
        g[:, j] = (evaluate(solid, points + d) - values) / h
    return g


def norm(v):
    return np.sqrt(v[:, 0] * v[:, 0] + v[:, 1] * v[:, 1] + v[:, 2] * v[:, 2])


def dot(a, b):
    return a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1] + a[:, 2] * b[:, 2]


def cross(a, b):
    return np.stack([a[:, 1] * b[:, 2] - a[:, 2] * b[:, 1], a[:, 2] * b[:, 0] - a[:, 0] * b[:, 2],
                     a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]], axis=1)


def project(solid, points, level=0.0, steps=2, reach=3.0):
    """Moves points along the gradient onto solid = level (a number or one per point)."""
    for _ in range(steps):
        value = evaluate(solid, points)
        g = gradient(solid, points, value)
        step = (value - level) / np.maximum(dot(g, g), 0.05)
        move = g * step[:, None]
        n = norm(move)
        points = points - move * np.minimum(1.0, reach / np.maximum(n, 1e-12))[:, None]
    return points


def sample(solid, axes, block=6):
    """Values at the grid points, exact near the surface only: a look at the middle of each block decides where."""
    shape = [len(a) for a in axes]
    starts = [np.arange(0, n, block) for n in shape]
    ends = [np.minimum(s + block, n) - 1 for s, n in zip(starts, shape)]
    middle = [0.5 * (a[s] + a[e]) for a, s, e in zip(axes, starts, ends)]
    half = [0.5 * (a[e] - a[s]) for a, s, e in zip(axes, starts, ends)]
    step = max(float(np.max(np.diff(a))) for a in axes)
    centres = np.stack(np.meshgrid(*middle, indexing='ij'), axis=-1).reshape(-1, 3)
    radius = norm(np.stack(np.meshgrid(*half, indexing='ij'), axis=-1).reshape(-1, 3))
    coarse = evaluate(solid, centres)
    near = np.abs(coarse) < 1.6 * radius + 2 * step
    index = np.stack(np.meshgrid(*[np.arange(n) // block for n in shape], indexing='ij'), axis=-1)
    where = (index[..., 0] * len(starts[1]) + index[..., 1]) * len(starts[2]) + index[..., 2]
    values = coarse[where]
    active = np.argwhere(near[where])
    points = np.stack([axes[d][active[:, d]] for d in range(3)], axis=1)
    values[active[:, 0], active[:, 1], active[:, 2]] = evaluate(solid, points)
    return values


def marching_tetrahedra(solid, axes):
    """Vertices and outward triangles of the surface; axes are the grid's coordinates (need not be uniform)."""
    value = sample(solid, axes)
    value = np.where(np.abs(value) < 1e-6, 1e-6, value)
    inside = value < 0
    nx, ny, nz = value.shape
    assert not (inside[0].any() or inside[-1].any() or inside[:, 0].any() or inside[:, -1].any()
                or inside[:, :, 0].any() or inside[:, :, -1].any()), 'the grid is too small'
    count = np.zeros((nx - 1, ny - 1, nz - 1), int)
    for c in range(8):
        count += inside[c & 1:nx - 1 + (c & 1), (c >> 1) & 1:ny - 1 + ((c >> 1) & 1), (c >> 2):nz - 1 + (c >> 2)]
    cells = np.argwhere((count > 0) & (count < 8))
    corner = [((cells[:, 0] + (c & 1)) * ny + cells[:, 1] + ((c >> 1) & 1)) * nz + cells[:, 2] + (c >> 2)
              for c in range(8)]
    flat = inside.reshape(-1)
    faces = []  # each a triple of grid edges (a, b): a inside, b outside
    for tet in TETRAHEDRA:
        ids = np.stack([corner[c] for c in tet], axis=1)
        code = sum(flat[ids[:, i]].astype(int) << i for i in range(4))
        for mask in range(1, 15):
            rows = ids[code == mask]
            if len(rows) == 0:
                continue
            ins = [i for i in range(4) if mask >> i & 1]
            out = [i for i in range(4) if not mask >> i & 1]
            odd = _odd(ins + out)
            if len(ins) == 1:
                a, (b, c, d) = ins[0], out
                tris = [[(a, b), (a, c), (a, d)]]
            elif len(ins) == 3:
                (a, b, c), d = ins, out[0]
                tris = [[(a, d), (b, d), (c, d)]]
            else:
                (a, b), (c, d) = ins, out
                tris = [[(a, c), (a, d), (b, d)], [(a, c), (b, d), (b, c)]]
            for t in tris:
                t = t[::-1] if odd else t
                faces.append(np.stack([np.stack([rows[:, i], rows[:, j]], axis=1) for i, j in t], axis=1))
    faces = np.concatenate(faces)
    key = faces[:, :, 0].astype(np.int64) * (nx * ny * nz) + faces[:, :, 1]
    edges, index = np.unique(key.reshape(-1), return_inverse=True)
    a, b = edges // (nx * ny * nz), edges % (nx * ny * nz)
    va, vb = value.reshape(-1)[a], value.reshape(-1)[b]

    def place(i):
        return np.stack([axes[0][i // (ny * nz)], axes[1][i // nz % ny], axes[2][i % nz]], axis=1)
    t = np.clip(va / (va - vb), 0.02, 0.98)
    vertices = place(a) + (place(b) - place(a)) * t[:, None]
    triangles = index.reshape(-1, 3)
    if volume(vertices, triangles) < 0:
        triangles = triangles[:, ::-1]
    return vertices, triangles.copy()


def largest_piece(vertices, triangles):
    """The piece with the most vertices."""
    label = np.arange(len(vertices))
    while True:
        low = label[triangles].min(axis=1)
        new = label.copy()
        for k in range(3):
            np.minimum.at(new, triangles[:, k], low)
        new = new[new]
        if (new == label).all():
            break
        label = new
    keep = label == np.argmax(np.bincount(label))
    index = np.cumsum(keep) - 1
    return vertices[keep], index[triangles[keep[triangles[:, 0]]]]


def _odd(p):
    return sum(p[i] > p[j] for i in range(len(p)) for j in range(i + 1, len(p))) % 2 == 1


def volume(v, t):
    a, b, c = v[t[:, 0]], v[t[:, 1]], v[t[:, 2]]
    return float(np.sum(dot(a, cross(b, c)))) / 6.0


def angles(v, t):
    """#T by 3 cosines of the corner angles."""
    out = np.empty((len(t), 3))
    for i in range(3):
        e, f = v[t[:, (i + 1) % 3]] - v[t[:, i]], v[t[:, (i + 2) % 3]] - v[t[:, i]]
        out[:, i] = dot(e, f) / np.maximum(norm(e) * norm(f), 1e-12)
    return out


class Mesh:
    """Triangles with the sets of triangles around each vertex, for collapses and flips."""

    def __init__(self, vertices, triangles):
        self.v = np.array(vertices, float)
        self.t = [list(map(int, t)) for t in triangles]
        self.around = [[] for _ in range(len(self.v))]
        for i, t in enumerate(self.t):
            for c in t:
                self.around[c].append(i)
        self.count = len(self.v)

    def neighbours(self, u):
        return {c for i in self.around[u] for c in self.t[i]} - {u}

    def arrays(self):
        used = [i for i, a in enumerate(self.around) if a]
        new = {o: n for n, o in enumerate(used)}
        return self.v[used], np.array([[new[c] for c in t] for t in self.t if t is not None])

    def collapse(self, u, w, p):
        """Merges w into u at p; False where that would spoil the manifold or turn a triangle over."""
        common = self.neighbours(u) & self.neighbours(w)
        if len(common) != 2 or any(len(self.around[c]) <= 3 for c in common):
            return False
        if len(self.around[u]) + len(self.around[w]) - 4 > 9:
            return False
        gone = [i for i in self.around[u] if w in self.t[i]]
        for end in (u, w):
            for i in self.around[end]:
                if i in gone:
                    continue
                tri = self.t[i]
                q = [self.v[c].tolist() for c in tri]
                new = [p if c == end else q[k] for k, c in enumerate(tri)]
                n0, n1 = _normal(q), _normal(new)
                d = n0[0] * n1[0] + n0[1] * n1[1] + n0[2] * n1[2]
                l0 = n0[0] ** 2 + n0[1] ** 2 + n0[2] ** 2
                l1 = n1[0] ** 2 + n1[1] ** 2 + n1[2] ** 2
                if d <= 0 or d * d < 0.2 * l0 * l1:
                    return False
        for i in gone:
            for c in self.t[i]:
                self.around[c].remove(i)
            self.t[i] = None
        for i in self.around[w]:
            self.t[i][self.t[i].index(w)] = u
            self.around[u].append(i)
        self.around[w] = []
        self.v[u] = p
        self.count -= 1
        return True


def _normal(q):
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = q
    ux, uy, uz, wx, wy, wz = bx - ax, by - ay, bz - az, cx - ax, cy - ay, cz - az
    return uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx


def decimate(vertices, triangles, size, target):
    """Collapses the edge that is shortest against the wanted size at its ends until `target` vertices are left."""
    m = Mesh(vertices, triangles)
    s = size(m.v)
    heap = []

    def push(u, w):
        d = m.v[u] - m.v[w]
        heapq.heappush(heap, ((d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) / (s[u] * s[w]), u, w, stamp[u], stamp[w]))

    stamp = [0] * len(m.v)
    for t in m.t:
        for a, b in ((t[0], t[1]), (t[1], t[2]), (t[2], t[0])):
            if a < b:
                push(a, b)
    while m.count > target and heap:
        _, u, w, su, sw = heapq.heappop(heap)
        if stamp[u] != su or stamp[w] != sw or not m.around[u] or not m.around[w]:
            continue
        if m.collapse(u, w, ((m.v[u] + m.v[w]) * 0.5).tolist()):
            s[u] = 0.5 * (s[u] + s[w])
            stamp[u] += 1
            for n in sorted(m.neighbours(u)):
                push(min(u, n), max(u, n))
    assert m.count == target, f'stuck at {m.count} of {target} vertices'
    return m.arrays()


def flip_edges(v, t, passes=3):
    """Flips edges where that raises the smaller of the smallest angles without folding the surface."""
    t = [list(map(int, r)) for r in t]
    p = [tuple(r) for r in v.tolist()]
    for _ in range(passes):
        edge = {}
        for i, r in enumerate(t):
            for k in range(3):
                edge[(r[k], r[(k + 1) % 3])] = (i, r[(k + 2) % 3])
        valence = {}
        for a, b in edge:
            valence[a] = valence.get(a, 0) + 1
        touched, changed = set(), 0
        for (a, b) in sorted(edge):
            if a > b:
                continue
            i, c = edge[(a, b)]
            j, d = edge[(b, a)]
            if i in touched or j in touched or (c, d) in edge or (d, c) in edge:
                continue
            if valence[a] <= 4 or valence[b] <= 4 or valence[c] >= 9 or valence[d] >= 9:
                continue
            old = (p[a], p[b], p[c]), (p[b], p[a], p[d])
            new = (p[c], p[d], p[b]), (p[d], p[c], p[a])
            if min(_smallest_angle_cos(q) for q in new) <= min(_smallest_angle_cos(q) for q in old) + 1e-9:
                continue
            n = [_unit(_normal(q)) for q in old + new]
            before = sum(x * y for x, y in zip(n[0], n[1]))
            after = sum(x * y for x, y in zip(n[2], n[3]))
            mean = [x + y for x, y in zip(n[0], n[1])]
            if after < min(before - 0.12, 0.8) or min(sum(x * y for x, y in zip(mean, q)) for q in n[2:]) < 0.5:
                continue
            t[i], t[j] = [c, d, b], [d, c, a]
            touched.update((i, j))
            valence[a] -= 1
            valence[b] -= 1
            valence[c] += 1
            valence[d] += 1
            changed += 1
            for k in (i, j):  # neighbours see stale records in this pass
                touched.update(m for e in _edges(t[k]) for m in (edge.get(e, (k,))[0], edge.get(e[::-1], (k,))[0]))
        if not changed:
            break
    return np.array(t)


def _edges(r):
    return ((r[0], r[1]), (r[1], r[2]), (r[2], r[0]))


def _unit(n):
    s = (n[0] ** 2 + n[1] ** 2 + n[2] ** 2) ** 0.5 or 1.0
    return n[0] / s, n[1] / s, n[2] / s


def _smallest_angle_cos(q):
    """Minus the largest cosine of a triangle's angles: the larger, the better shaped."""
    worst = -1.0
    for k in range(3):
        a, b, c = q[k], q[(k + 1) % 3], q[(k + 2) % 3]
        e = (b[0] - a[0], b[1] - a[1], b[2] - a[2])
        f = (c[0] - a[0], c[1] - a[1], c[2] - a[2])
        ee = e[0] ** 2 + e[1] ** 2 + e[2] ** 2
        ff = f[0] ** 2 + f[1] ** 2 + f[2] ** 2
        worst = max(worst, (e[0] * f[0] + e[1] * f[1] + e[2] * f[2]) / (ee * ff) ** 0.5 if ee * ff > 0 else 1.0)
    return -worst


def smooth(v, t, size, strength=0.6):
    """Each vertex towards the centroid of its triangles, weighted by area over wanted area, within the tangent plane."""
    a, b, c = v[t[:, 0]], v[t[:, 1]], v[t[:, 2]]
    n = cross(b - a, c - a)
    mid = (a + b + c) / 3.0
    s = size(mid)
    w = norm(n) / (s * s)
    total, target, normal = np.zeros(len(v)), np.zeros_like(v), np.zeros_like(v)
    for k in range(3):
        total += np.bincount(t[:, k], w, len(v))
        for j in range(3):
            target[:, j] += np.bincount(t[:, k], w * mid[:, j], len(v))
            normal[:, j] += np.bincount(t[:, k], n[:, j], len(v))
    move = target / total[:, None] - v
    normal /= np.maximum(norm(normal), 1e-12)[:, None]
    return v + strength * (move - normal * dot(move, normal)[:, None])


def remesh(solid, axes, size, target, rounds=14, after=None):
    """The surface of the solid as a closed mesh of genus 0 with exactly `target` vertices.

    `size`: wanted edge length at points (only its ratios matter). `after(v, t, round)`: applied after each of the last rounds.
    """
    v, t = largest_piece(*marching_tetrahedra(solid, axes))
    assert len(t) == 2 * len(v) - 4, f'the solid has handles: {len(v)} vertices, {len(t)} triangles'
    while len(v) > target:
        v, t = decimate(v, t, size, max(target, int(len(v) * 0.4)))
        t = flip_edges(v, t)
        v = project(solid, smooth(v, t, size))
    for i in range(rounds):
        t = flip_edges(v, t, passes=2)
        v = project(solid, smooth(v, t, size, 0.5))
        if after is not None:
            v = after(v, t, i)
    return v, t


def grid(low, high, step):
    """Coordinates of a uniform grid that covers low..high in each direction; step: one number or three."""
    step = [step] * 3 if np.isscalar(step) else step
    return [low[d] + step[d] * np.arange(int(np.ceil((high[d] - low[d]) / step[d])) + 1) for d in range(3)]
