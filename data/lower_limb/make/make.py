# SPDX-License-Identifier: BSD-3-Clause
"""Makes the lower limb: skin.obj, bones/*.obj, landmarks.csv, landmarks_with_toes.csv, walk.bvh, jump.bvh, rig.toml, rig_with_toes.toml.

    python3 make.py [FOLDER]     (default: the folder above this one)

Needs Python 3 and numpy. The same files come out on every machine.
"""
import multiprocessing
import pathlib
import sys

import numpy as np

import anthropometry
import bones
import checks
import motion
import skin
from mesher import evaluate, grid, marching_tetrahedra, norm, cross, project, remesh

SKIN_VERTICES = 606
BONE_VERTICES = 4797
SMALLEST_BONE = 60


def bounds(solid, low, high, step=4.0):
    g = grid(low, high, step)
    points = np.stack(np.meshgrid(*g, indexing='ij'), axis=-1).reshape(-1, 3)
    near = points[evaluate(solid, points) < step]
    return near.min(axis=0) - 2.0, near.max(axis=0) + 2.0


def bone_grid(name, solid):
    if name in ('tibia', 'fibula'):
        low, high = bounds(solid, (-60, -60, 40), (60, 60, 480))
        return grid(low, high, (2.2, 2.2, 2.8))
    low, high = bounds(solid, (-60, -210, 0), (50, 60, 100), 2.0 if name.startswith('phalanx') else 4.0)
    return grid(low, high, 0.8 if name.startswith('phalanx') else 1.4)


def area_of(name):
    solid = bones.skeleton()[name]
    v, t = marching_tetrahedra(solid, bone_grid(name, solid))
    return float(np.sum(norm(cross(v[t[:, 1]] - v[t[:, 0]], v[t[:, 2]] - v[t[:, 0]])))) / 2


def share_vertices(areas):
    """Numbers of vertices that grow with the square root of the area and add up to BONE_VERTICES."""
    weight = {n: a ** 0.5 for n, a in areas.items()}
    scale = BONE_VERTICES / sum(weight.values())
    for _ in range(50):
        counts = {n: max(SMALLEST_BONE, int(w * scale)) for n, w in weight.items()}
        scale *= BONE_VERTICES / sum(counts.values())
    order = sorted(weight, key=lambda n: (-weight[n], n))
    i, step = 0, 1 if sum(counts.values()) < BONE_VERTICES else -1
    while sum(counts.values()) != BONE_VERTICES:
        counts[order[i % len(order)]] += step
        i += 1
    return counts


def bone_mesh(task):
    name, count = task
    solid = bones.skeleton()[name]
    if name in ('tibia', 'fibula'):  # finer at the ends than along the shaft
        middle, reach = (255.0, 195.0) if name == 'tibia' else (245.0, 185.0)
        size = lambda p: 1.0 - 0.5 * (np.abs(p[:, 2] - middle) / reach) ** 2 * (np.abs(p[:, 2] - middle) / reach)
    else:
        size = lambda p: np.ones(len(p))
    v, t = remesh(solid, bone_grid(name, solid), size, count)
    return name, np.round(v, 3), t


def bony_landmarks():
    """The bony prominences [name, bone that carries it, place]."""
    first, fifth = anthropometry.METATARSAL_HEADS[0], anthropometry.METATARSAL_HEADS[4]
    knee = anthropometry.EPICONDYLE_HEIGHT
    return [('LE', 'tibia', (-46.0, 4.0, knee)), ('ME', 'tibia', (46.0, 4.0, knee)),
            ('LM', 'fibula', (-34.0, 3.0, anthropometry.LATERAL_MALLEOLUS_HEIGHT)),
            ('MM', 'tibia', (29.0, -3.0, anthropometry.LATERAL_MALLEOLUS_HEIGHT + 8.0)),
            ('5H', 'metatarsal_5', (fifth[0][0] - fifth[1], fifth[0][1], fifth[0][2])),
            ('1H', 'metatarsal_1', (first[0][0] + first[1], first[0][1], first[0][2]))]


def toe_landmarks():
    """Three more, over the tips of the toes 1, 3 and 5, for a skin whose toes bend."""
    return [(f'T{i}', f'phalanx_distal_{i}', anthropometry.PHALANGES[i][0][-1][1]) for i in (1, 3, 5)]


def skin_mesh(skeleton, bone_vertices):
    body = skin.uncut(skeleton)
    solid = skin.skin(body)
    cut = anthropometry.CUT_HEIGHT
    pins = project(body, np.array([p for _, _, p in bony_landmarks()]), steps=12)
    axes = [np.arange(-78.0, 82.0, 2.3), np.concatenate([np.arange(-209.0, -100.0, 2.4), np.arange(-100.0, 90.0, 3.2)]),
            np.concatenate([np.arange(-5.0, 60.0, 2.6), np.arange(60.0, 120.0, 4.0), np.arange(120.0, 560.0, 7.0)])]

    def sharpen(v, t, i):
        if i < 6:
            return v
        rim = np.flatnonzero((v[:, 2] > cut - 12) & (evaluate(body, v) > -12))
        p = v[rim]
        p[:, 2] = cut
        for _ in range(3):
            value = evaluate(body, p)
            gx = (evaluate(body, p + (0.05, 0, 0)) - value) / 0.05
            gy = (evaluate(body, p + (0, 0.05, 0)) - value) / 0.05
            s = value / np.maximum(gx * gx + gy * gy, 0.05)
            p[:, 0] -= s * gx
            p[:, 1] -= s * gy
        v[rim] = p
        for pin in pins:
            v[int(np.argmin(norm(v - pin)))] = pin
        return v
    v, t = remesh(solid, axes, skin.wanted_edge, SKIN_VERTICES, rounds=24, after=sharpen)
    v = fit(solid, v, t, cut)
    v = push_out(v, t, bone_vertices)
    v[:, 2] = np.where(v[:, 2] > cut - 0.5, cut, v[:, 2])
    return np.round(v, 3), t


def fit(solid, v, t, cut):
    """Moves the vertices a little outward so that the flat triangles enclose the volume of the rounded body."""
    wall = v[:, 2] < cut - 0.5
    for _ in range(2):
        mid = np.concatenate([v[t].mean(axis=1)] + [0.5 * (v[t[:, k]] + v[t[:, (k + 1) % 3]]) for k in range(3)])
        value = np.clip(evaluate(solid, mid).reshape(4, -1), -4.0, 4.0).mean(axis=0)
        total, count = np.zeros(len(v)), np.zeros(len(v))
        for k in range(3):
            total += np.bincount(t[:, k], value, len(v))
            count += np.bincount(t[:, k], None, len(v))
        most = np.where(v[:, 1] < -140.0, 0.6, 2.5)  # leave the gaps between the toes
        level = np.clip(evaluate(solid, v) - 0.8 * total / count, 0.0, most)
        v = np.where(wall[:, None], project(solid, v, level), v)
        v[:, 2] = np.maximum(v[:, 2], 0.0)
    return v


def push_out(v, t, bone_vertices, room=1.0):
    """Moves triangles that come closer than `room` to a bone outward."""
    v = v.copy()
    for _ in range(12):
        near = []
        d, q, k = checks.closest_points(bone_vertices, v, t)
        out = ~checks.inside(bone_vertices[d < 8.0], v, t)
        signed = d.copy()
        signed[np.flatnonzero(d < 8.0)[out]] *= -1
        bad = np.flatnonzero(signed < room)
        if len(bad) == 0:
            break
        n = cross(v[t[:, 1]] - v[t[:, 0]], v[t[:, 2]] - v[t[:, 0]])
        n /= norm(n)[:, None]
        move, most = np.zeros_like(v), np.zeros(len(v))
        for i in bad:
            need = room - signed[i] + 0.2
            for c in t[k[i]]:
                if need > most[c]:
                    most[c], move[c] = need, need * n[k[i]]
        v += move * 0.8
    print(f'pushed out: {len(bad)} bone vertices nearer than {room} mm left')
    return v


def write_obj(path, v, t):
    lines = ['v %.3f %.3f %.3f' % tuple(p) for p in v] + ['f %d %d %d' % tuple(r + 1) for r in t]
    path.write_text('\n'.join(lines) + '\n')


def write_landmarks(path, landmarks, skin_v, bone_meshes):
    rows = ['name,skin_vertex,skin_x,skin_y,skin_z,bone,bone_x,bone_y,bone_z']
    for name, bone, place in landmarks:
        i = int(np.argmin(norm(skin_v - np.array(place))))
        _, q, _ = checks.closest_points(skin_v[[i]], *bone_meshes[bone])
        rows.append(f'{name},{i},' + '%.3f,%.3f,%.3f' % tuple(skin_v[i]) + f',bones/{bone}.obj,' + '%.3f,%.3f,%.3f' % tuple(q[0]))
    path.write_text('\n'.join(rows) + '\n')


def rig(bending_toes):
    """The rig file of both motions; the toes are a segment of their own or go with the foot."""
    point = lambda p: '[%.3f, %.3f, %.3f]' % tuple(p)
    knee, ankle = (0.0, *motion.KNEE), (0.0, *motion.ANKLE)
    toe, end = (motion.TOE_X, *motion.TOE), (motion.TOE_X, *motion.TOE_END)
    toes = [n for n in bones.ORDER if n.startswith('phalanx')]
    foot = [n for n in bones.ORDER if n not in toes + ['tibia', 'fibula']]
    segments = [('shank', '', ['tibia', 'fibula'], knee, ankle, 'RightLeg', 'RightFoot'),
                ('foot', 'shank', foot if bending_toes else foot + toes, ankle, toe, 'RightFoot', 'RightToeBase')]
    if bending_toes:
        segments += [('toes', 'foot', toes, toe, end, 'RightToeBase', 'RightToeBase.end')]
    why = ['# The toes bend; for landmarks_with_toes.csv, whose landmarks on the toes take the skin along.'] if bending_toes else [
        '# The landmarks of landmarks.csv end at the ball of the foot, so bones and skin of the toes go with the foot;',
        '# rig_with_toes.toml and landmarks_with_toes.csv bend them.']
    lines = ['# SPDX-License-Identifier: BSD-3-Clause',
             '# The lower limb of this folder with walk.bvh or jump.bvh. Written by make/make.py; the keys are described in docs/rig.md.',
             *why,
             '', '[mesh]', 'up = "+z"', 'forward = "-y"', 'floor = 0', '', '[motion]', 'format = "bvh"', 'up = "+z"',
             'forward = "-y"', 'scale = 1']
    for name, parent, carried, proximal, distal, joint, next_joint in segments:
        lines += ['', f'[segments.{name}]'] + ([f'parent = "{parent}"'] if parent else [])
        lines += ['bones = [' + ', '.join(f'"{n}"' for n in carried) + ']', f'proximal = {point(proximal)}',
                  f'distal = {point(distal)}', 'axis = [1, 0, 0]', f'proximal_joint = "{joint}"',
                  f'distal_joint = "{next_joint}"', 'motion_axis = [1, 0, 0]']
    return '\n'.join(lines) + '\n'


def report(skin_v, skin_t, bone_meshes):
    a, r, vol = checks.shape(skin_v, skin_t)
    print(f'skin: {len(skin_v)} vertices, {len(skin_t)} triangles, closed {checks.closed(skin_v, skin_t)}, smallest angle '
          f'{a:.1f}, edge ratio {r:.2f}, {vol / 1e6:.3f} litres, self-crossings {len(checks.crossings(skin_v, skin_t, skin_v, skin_t))}')
    for name, z in (('lower thigh', 530), ('knee', 475), ('calf', 350), ('ankle', 125)):
        print(f'girth of the {name} (z = {z}): {checks.girth(skin_v, skin_t, z):.1f}')
    low, high = skin_v.min(axis=0), skin_v.max(axis=0)
    foot = skin_v[skin_v[:, 2] < 40]
    print(f'foot length {foot[:, 1].max() - foot[:, 1].min():.1f}, breadth {foot[:, 0].max() - foot[:, 0].min():.1f}, lowest {low[2]:.2f}')
    total_v = total_t = 0
    nearest, gap, worst = (np.inf, ''), (np.inf, ''), (90.0, '')
    names = sorted(bone_meshes)
    for n in names:
        v, t = bone_meshes[n]
        total_v, total_t = total_v + len(v), total_t + len(t)
        assert checks.closed(v, t), n
        assert checks.inside(v, skin_v, skin_t).all(), f'{n} leaves the skin'
        crossing = checks.crossings(v, t, v, t) + checks.crossings(v, t, skin_v, skin_t) + checks.crossings(skin_v, skin_t, v, t)
        assert not crossing, f'{n}: {len(crossing)} crossings'
        nearest = min(nearest, (float(checks.closest_points(v, skin_v, skin_t)[0].min()), n))
        worst = min(worst, (checks.shape(v, t)[0], n))
        for m in names:
            w, s = bone_meshes[m]
            if m == n or (v.min(axis=0) - 5 > w.max(axis=0)).any() or (w.min(axis=0) - 5 > v.max(axis=0)).any():
                continue
            assert not checks.crossings(v, t, w, s), f'{n} crosses {m}'
            assert not checks.inside(v[:1], w, s).any(), f'{n} in {m}'
            gap = min(gap, (float(checks.closest_points(v, w, s)[0].min()), f'{n} - {m}'))
    print(f'bones: {len(names)}, {total_v} vertices, {total_t} triangles; smallest angle {worst[0]:.1f} ({worst[1]}); '
          f'nearest to the skin {nearest[0]:.2f} ({nearest[1]}), to one another {gap[0]:.2f} ({gap[1]})')


def main():
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent.parent
    (folder / 'bones').mkdir(parents=True, exist_ok=True)
    with multiprocessing.Pool(2) as pool:
        counts = share_vertices(dict(zip(bones.ORDER, pool.map(area_of, bones.ORDER, 1))))
        meshes = {n: (v, t) for n, v, t in pool.imap_unordered(bone_mesh, [(n, counts[n]) for n in bones.ORDER], 1)}
    for name in bones.ORDER:
        write_obj(folder / 'bones' / f'{name}.obj', *meshes[name])
    v, t = skin_mesh(bones.skeleton(), np.concatenate([meshes[n][0] for n in bones.ORDER]))
    write_obj(folder / 'skin.obj', v, t)
    write_landmarks(folder / 'landmarks.csv', bony_landmarks(), v, meshes)
    write_landmarks(folder / 'landmarks_with_toes.csv', bony_landmarks() + toe_landmarks(), v, meshes)
    (folder / 'rig.toml').write_text(rig(False))
    (folder / 'rig_with_toes.toml').write_text(rig(True))
    report(v, t, meshes)
    for name, move in (('walk', motion.walk), ('jump', motion.jump)):
        rows = move(v)
        motion.write_bvh(folder / f'{name}.bvh', rows)
        motion.report(name, rows, v)


if __name__ == '__main__':
    main()
