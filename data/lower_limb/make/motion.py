# SPDX-License-Identifier: BSD-3-Clause
"""Walking and a vertical jump of the right leg in the sagittal plane, from published curves (../SOURCES.md), as BVH.

Axes and unit of the mesh: x to the left (medial of a right leg), -y forward, z up, millimetres. Angles in degrees:
hip and knee flexion, ankle dorsiflexion, toe extension are positive. Pitch is that of the foot against the floor, toes up
positive; thigh and shank lean positive where the knee, the ankle are in front. The pelvis does not turn.
"""
from math import acos, atan2, cos, degrees, hypot, radians, sin, sqrt

import numpy as np

from anthropometry import ANKLE_HEIGHT, HIP_HEIGHT, KNEE_AXIS_HEIGHT, METATARSAL_HEADS
from sdf import interpolate

RATE = 100  # frames a second
FINE = 1000  # samples of a stride, or of a second of the jump
GRAVITY = 9810.0

HIP, KNEE, ANKLE = (0.0, HIP_HEIGHT), (0.0, KNEE_AXIS_HEIGHT), (0.0, ANKLE_HEIGHT)  # (y, z)
TOE = tuple((METATARSAL_HEADS[0][0][d] + METATARSAL_HEADS[4][0][d]) / 2 for d in (1, 2))
TOE_X = (METATARSAL_HEADS[0][0][0] + METATARSAL_HEADS[4][0][0]) / 2
TOE_END = (-200.0, 8.0)
THIGH, SHANK = HIP[1] - KNEE[1], KNEE[1] - ANKLE[1]


def kernel(width):
    """Cubic B-spline over `width` samples: what it smooths is twice continuously differentiable."""
    box = np.ones(max(1, width // 4)) / max(1, width // 4)
    k = box
    for _ in range(3):
        k = np.convolve(k, box)
    return k


def smoothed(values, width, periodic):
    k = kernel(width)
    n = len(k) // 2
    padded = np.concatenate([values[-n:], values, values[:n]]) if periodic else np.pad(values, n, mode='edge')
    return np.convolve(padded, k, mode='valid')[:len(values)]


def turn(point, centre, angle):
    """Rotation by `angle` degrees in the (y, z) plane: positive lifts what lies in front (-y) of the centre."""
    c, s = cos(radians(angle)), sin(radians(angle))
    y, z = point[0] - centre[0], point[1] - centre[1]
    return centre[0] + c * y + s * z, centre[1] - s * y + c * z


def pose(thigh, knee, ankle):
    """Knee, ankle and pitch of the foot for a hip at the origin."""
    shank = thigh - knee
    k = (-THIGH * sin(radians(thigh)), -THIGH * cos(radians(thigh)))
    a = (k[0] - SHANK * sin(radians(shank)), k[1] - SHANK * cos(radians(shank)))
    return k, a, shank + ankle


def foot_points(skin_v):
    """(y, z) of the sole's skin, of the foot and of the toes apart, relative to the ankle."""
    low = skin_v[skin_v[:, 2] < 30.0][:, 1:]
    low = low - np.array(ANKLE)
    toes = low[:, 0] < TOE[0] - 12.0
    return low[~toes], low[toes]


def sole(points, ankle, pitch, extension):
    """The sole in the world, for a foot of this pitch whose toes are extended, with the ankle there."""
    foot, toes = points
    joint = (TOE[0] - ANKLE[0], TOE[1] - ANKLE[1])
    bent = [turn(p, joint, extension) for p in toes]
    all_points = [turn(p, (0, 0), pitch) for p in list(map(tuple, foot)) + bent]
    return np.array(all_points) + np.array(ankle)


# --- walking -------------------------------------------------------------------------------------------------------
STRIDE_TIME = 1.06  # seconds: 113 steps a minute
STRIDES = 4
# (percent of the cycle from heel contact, degrees)
WALK_KNEE = [(0, 5), (14, 18), (30, 8), (40, 5), (46, 6.5), (50, 10), (56, 22), (60, 35), (63, 44), (73, 63), (80, 50), (87, 26), (96, 3)]
WALK_ANKLE = [(0, 0), (7, -5), (14, 0), (31, 6), (46, 10), (50, 9), (56, 2), (63, -16), (74, -3), (82, 1), (95, 1)]
WALK_PITCH = [(0, 17), (4, 10), (9, 0), (12, 0), (31, 0), (36, -2), (41, -6), (46, -12), (50, -20), (56, -37), (60, -54),
              (64, -66), (68, -68), (76, -43), (81, -23), (87, -1), (94, 18), (97, 20)]
WALK_TOES = [(0, 15), (8, 4), (14, 0), (34, 0), (41, 6), (46, 13), (50, 20), (56, 33), (60, 39), (63, 36), (70, 12), (76, 8), (88, 14)]

def cycle(keys):
    """A periodic curve through keys, sampled FINE times a cycle."""
    p = [k - 100 for k, _ in keys] + [k for k, _ in keys] + [k + 100 for k, _ in keys]
    v = [a for _, a in keys] * 3
    return smoothed(interpolate(p, v, np.arange(FINE) * 100.0 / FINE), FINE * 7 // 100, True)


def blend_step(s):
    s = np.clip(s, 0.0, 1.0)
    return s * s * s * (s * (s * 6 - 15) + 10)


def walk(skin_v):
    """Columns: root y, root z, hip, knee, ankle, toes; one row a frame."""
    points = foot_points(skin_v)
    knee, ankle, pitch, toes = cycle(WALK_KNEE), cycle(WALK_ANKLE), cycle(WALK_PITCH), cycle(WALK_TOES)
    hip = pitch + knee - ankle
    dt = STRIDE_TIME / FINE
    soles = np.array([sole(points, pose(h, k, a)[1], p, e) for h, k, a, p, e in zip(hip, knee, ankle, pitch, toes)])
    lowest = soles[:, :, 1].min(axis=1)
    weight = np.maximum(0.0, 1.0 - (soles[:, :, 1] - lowest[:, None]) / 10.0) ** 3
    speed = (np.roll(soles[:, :, 0], -1, axis=0) - np.roll(soles[:, :, 0], 1, axis=0)) / (2 * dt)
    contact_speed = (weight * speed).sum(axis=1) / weight.sum(axis=1)
    phase = np.arange(FINE) / FINE
    right = blend_step(phase / 0.12) * (1 - blend_step((phase - 0.5) / 0.12))  # how much the right leg carries
    other = lambda a: np.roll(a, FINE // 2)
    height = smoothed(-(right * lowest + other(right * lowest)), FINE * 8 // 100, True)
    forward = smoothed(right * contact_speed + other(right * contact_speed), FINE * 12 // 100, True)
    stride = float(forward.sum() * dt)
    travel = np.concatenate([[0.0], np.cumsum(0.5 * (forward + np.roll(forward, -1)) * dt)[:-1]])
    frames = int(round(STRIDES * STRIDE_TIME * RATE)) + 1
    rows = []
    for i in range(frames):
        s = i / RATE / STRIDE_TIME
        n, x = int(s), (s - int(s)) * FINE
        j, f = int(x), x - int(x)
        at = lambda a: float(a[j] * (1 - f) + a[(j + 1) % FINE] * f)
        far = travel[j] * (1 - f) + (travel[j + 1] if j + 1 < FINE else stride) * f
        rows.append([n * stride + far, at(height), at(hip), at(knee), at(ankle), at(toes)])
    return np.array(rows)


# --- vertical jump -------------------------------------------------------------------------------------------------
JUMP_HEIGHT = 330.0   # rise of the hip between take-off and the top
JUMP_SECONDS = 3.0
CROUCH, TAKE_OFF = 1.10, 1.38
JUMP_PITCH = [(0, 0), (1.18, 0), (1.26, -14), (1.34, -48), (1.40, -64), (1.46, -64), (1.62, -52), (1.80, -42), (1.90, -34), (1.97, -14), (2.03, 0), (3, 0)]
JUMP_TOES = [(0, 0), (1.18, 0), (1.26, 14), (1.34, 46), (1.37, 48), (1.46, 14), (1.6, 4), (1.8, 14), (1.90, 32), (1.97, 14), (2.03, 0), (3, 0)]


def hermite(nodes, t):
    """Quintic pieces through nodes (time, value, speed, acceleration): twice continuously differentiable."""
    if t <= nodes[0][0]:
        return nodes[0][1]
    for (t0, p0, v0, a0), (t1, p1, v1, a1) in zip(nodes, nodes[1:]):
        if t <= t1:
            h, s = t1 - t0, (t - t0) / (t1 - t0)
            s3, s4, s5 = s ** 3, s ** 4, s ** 5
            return (p0 * (1 - 10 * s3 + 15 * s4 - 6 * s5) + v0 * h * (s - 6 * s3 + 8 * s4 - 3 * s5)
                    + a0 * h * h * (s * s / 2 - 1.5 * s3 + 1.5 * s4 - s5 / 2) + p1 * (10 * s3 - 15 * s4 + 6 * s5)
                    + v1 * h * (-4 * s3 + 7 * s4 - 3 * s5) + a1 * h * h * (s3 / 2 - s4 + s5 / 2))
    return nodes[-1][1]


def jump(skin_v):
    """Columns as in walk()."""
    speed = sqrt(2 * GRAVITY * JUMP_HEIGHT)
    stand = HIP_HEIGHT - 1.2  # the knee is never quite straight
    leave = stand + 68.0
    land = stand + 10.0
    down = sqrt(2 * GRAVITY * (leave + JUMP_HEIGHT - land))
    touch = TAKE_OFF + (speed + down) / GRAVITY
    height = [(0.45, stand, 0, 0), (CROUCH, stand - 285.0, 0, 7000.0), (TAKE_OFF, leave, speed, -GRAVITY),
              (touch, land, -down, -GRAVITY), (touch + 0.24, stand - 215.0, 0, 9000.0), (touch + 1.0, stand, 0, 0)]
    back = [(0.45, 0, 0, 0), (CROUCH, 245.0, 0, -1500.0), (TAKE_OFF, -72.0, 0, 0), (touch, -30.0, 0, 0),
            (touch + 0.24, 185.0, 0, 0), (touch + 1.0, 0, 0, 0)]
    ballistic = lambda t: (leave + speed * (t - TAKE_OFF) - GRAVITY / 2 * (t - TAKE_OFF) ** 2,
                           speed - GRAVITY * (t - TAKE_OFF), -GRAVITY)
    rise, settle = TAKE_OFF + 0.035, touch - 0.03
    (z1, v1, a1), (z2, v2, a2) = ballistic(rise), ballistic(settle)
    reach1, reach2 = 965.0, 944.0  # hip above toe joint, legs long; ready to land
    joint = [(TAKE_OFF - 0.05, TOE[1], 0, 0), (rise, z1 - reach1, v1, a1)]
    fold = [(rise, reach1, 0, 0), (settle, reach2, 0, 0)]
    landing = [(settle, z2 - reach2, v2, a2), (touch + 0.03, TOE[1], 0, 0)]
    steps = int(JUMP_SECONDS * FINE) + 1
    times = np.arange(steps) / FINE
    pitch, toes = [smoothed(interpolate([k for k, _ in keys], [a for _, a in keys], times), 60, False)
                   for keys in (JUMP_PITCH, JUMP_TOES)]
    points = foot_points(skin_v)
    sink = []  # how far the sole reaches below its rest under the turning joint
    for i in range(0, steps, 5):
        a = turn(ANKLE, TOE, float(pitch[i]))
        sink.append(-sole(points, a, float(pitch[i]), float(toes[i]))[:, 1].min())
    sink = smoothed(np.interp(np.arange(steps), np.arange(0, steps, 5), sink), 60, False)
    rows = []
    for i in range(0, steps, FINE // RATE):
        t = times[i]
        z, y = hermite(height, t), hermite(back, t)
        if rise < t < settle:
            toe_z = ballistic(t)[0] - hermite(fold, t)
        else:
            toe_z = hermite(joint, t) if t <= rise else hermite(landing, t)
        a = turn(ANKLE, TOE, float(pitch[i]))
        a = (a[0], a[1] + toe_z - TOE[1] + sink[i])
        dy, dz = a[0] - y, a[1] - z
        d = hypot(dy, dz)
        assert d < THIGH + SHANK, f'at {t:.2f} s the leg is {d - THIGH - SHANK:.1f} mm too short'
        knee = 180 - degrees(acos((THIGH ** 2 + SHANK ** 2 - d * d) / (2 * THIGH * SHANK)))
        lean = degrees(atan2(-dy, -dz))
        hip = lean + degrees(acos((THIGH ** 2 + d * d - SHANK ** 2) / (2 * THIGH * d)))
        rows.append([-y, z, hip, knee, float(pitch[i]) - (hip - knee), float(toes[i])])
    return np.array(rows)


# --- files ---------------------------------------------------------------------------------------------------------
def write_bvh(path, rows):
    """Rows: root forward, root height, hip, knee, ankle, toes."""
    x, (y, z) = TOE_X, (TOE[0] - ANKLE[0], TOE[1] - ANKLE[1])
    offsets = [('ROOT Hips', (0, 0, 0)), ('JOINT RightUpLeg', (0, 0, 0)), ('JOINT RightLeg', (0, 0, -THIGH)),
               ('JOINT RightFoot', (0, 0, -SHANK)), ('JOINT RightToeBase', (x, y, z))]
    lines, indent = ['HIERARCHY'], ''
    for head, o in offsets:
        lines += [indent + head, indent + '{', indent + '  OFFSET %.3f %.3f %.3f' % o]
        position = '6 Xposition Yposition Zposition ' if head.startswith('ROOT') else '3 '
        lines.append(indent + '  CHANNELS ' + position + 'Zrotation Yrotation Xrotation')
        indent += '  '
    lines += [indent + 'End Site', indent + '{', indent + '  OFFSET %.3f %.3f %.3f' % (0, TOE_END[0] - TOE[0], TOE_END[1] - TOE[1]),
              indent + '}']
    while indent:
        indent = indent[:-2]
        lines.append(indent + '}')
    lines += ['MOTION', f'Frames: {len(rows)}', f'Frame Time: {1 / RATE:.6f}']
    for forward, up, hip, knee, ankle, toes in rows:
        # A positive turn about x lifts what lies behind (+y); so flexion of the hip, which brings the leg forward, is negative.
        angles = (0.0, -hip, knee, -ankle, -toes)
        lines.append('0 %.3f %.3f ' % (-forward, up) + ' '.join('0 0 %.4f' % (a + 0.0) for a in angles))
    path.write_text('\n'.join(lines) + '\n')


def report(name, rows, skin_v):
    """Heights and slips of the sole as the rows move it, and the ranges of the angles."""
    points = foot_points(skin_v)
    soles = []
    for forward, up, hip, knee, ankle, toes in rows:
        _, a, p = pose(hip, knee, ankle)
        soles.append(sole(points, (a[0] - forward, a[1] + up), p, toes))
    soles = np.array(soles)
    low = soles[:, :, 1].min(axis=1)
    slip = []
    for i in range(1, len(soles)):
        on = (soles[i, :, 1] < 2) & (soles[i - 1, :, 1] < 2)
        if on.any():
            slip.append(float(np.abs(np.diff(soles[i - 1:i + 1, on, 0], axis=0)).mean()) * RATE)
    print(f'{name}: {len(rows)} frames; travels {rows[-1, 0]:.0f} mm; hip height {rows[:, 1].min():.1f} to {rows[:, 1].max():.1f}; '
          f'sole at {low.min():.1f} to {low.max():.1f} mm; what touches slips at {np.median(slip):.0f} mm/s (median)')
    for j, label in enumerate(('hip', 'knee', 'ankle', 'toes')):
        a = rows[:, 2 + j]
        jerk = np.abs(np.diff(a, 2)).max() * RATE * RATE
        print(f'  {label}: {a.min():.1f} to {a.max():.1f} degrees, {a[0]:.1f} at the start, at most {np.abs(np.diff(a)).max() * RATE:.0f} deg/s, {jerk:.0f} deg/s2')
