# SPDX-License-Identifier: BSD-3-Clause
"""The skin of the lower limb as a solid: soft tissue around the bones of bones.py, cut flat above the knee.

Girths and breadths are those of anthropometry.py; `make.py` prints what the mesh measures.
"""
import numpy as np

from anthropometry import CUT_HEIGHT, METATARSAL_HEADS
from sdf import blend, carve, common, cone, ellipsoid, half_space, loft, offset, smooth_max, smooth_min, tube, union

# (z, centre x, centre y, half width medial, lateral, depth front, back)
LEG = [
    (600, 0, 4, 69, 67, 68, 68),
    (548, 0, 2, 66, 64, 66, 64),
    (520, 0, 0, 63, 61, 63, 61),
    (495, 0, 0, 61, 59, 58, 58),
    (475, 0, 0, 58.5, 57, 54, 55),
    (450, 0, 2, 54.5, 54, 50, 54),
    (425, -1, 4, 52, 52.5, 47, 56),
    (395, -1, 8, 54.5, 55, 46, 62),
    (355, 0, 11, 60.3, 58.8, 47, 67.6),
    (315, 0, 11, 57.5, 55.5, 44, 64),
    (275, 0, 10, 50, 50, 39, 55),
    (235, 0, 9, 43, 44, 35, 46),
    (195, 0, 8, 36.5, 38.5, 31, 38),
    (155, 0, 7, 33, 34.5, 28.5, 36),
    (125, 0, 5, 33.4, 34.9, 28.3, 37.6),
    (100, 0, 3, 32, 32.5, 26, 38),
    (80, 0, 2, 30, 31, 25, 38),
    (60, 0, 0, 26, 27, 24, 38),
]


def shank():
    column = loft(LEG, 4, 0.12)
    calf = [ellipsoid((20, 36, 350), (31, 36, 82)), ellipsoid((-21, 36, 362), (30, 34, 74))]
    between = cone((0, 84, 420), (0, 84, 300), 6, 4)
    achilles = tube([(1, 50, 290), (1, 47.5, 245), (0, 44.5, 195), (-1, 42, 140), (-2, 42.5, 95), (-3, 46, 60)],
                    [10, 10, 9, 8.4, 8.6, 11], 5)
    patella = ellipsoid((1, -45.5, 474), (25, 20, 27))
    tendon = tube([(0, -44, 450), (-1, -36, 415), (0, -27, 370)], [13, 12.5, 12], 4)
    above = ellipsoid((17, -34, 520), (30, 28, 42))  # vastus medialis
    hollows = [ellipsoid((29, -62, 446), (11, 14, 18)), ellipsoid((-29, -62, 446), (11, 14, 18)), between,
               cone((27, 46, 135), (27, 46, 85), 13, 14), cone((-29, 46, 135), (-30, 46, 85), 13, 14)]
    body = blend(22, column, *calf)
    body = blend(14, body, above, tendon)
    body = blend(10, body, patella)
    return carve(12, blend(12, body, achilles), *hollows)


def foot(bones):
    """Heel, sole, arch and instep; the tissue over the bones is thin on top and thick below."""
    tarsus = ['talus', 'calcaneus', 'navicular', 'cuboid', 'cuneiform_medial', 'cuneiform_intermediate',
              'cuneiform_lateral'] + [f'metatarsal_{i}' for i in range(1, 6)]
    cover = blend(9, *[offset(bones[n], 4.0) for n in tarsus])
    heel = blend(14, ellipsoid((-3, 29, 23), (32, 29.5, 27)), ellipsoid((-4, 32.5, 42), (26, 25.5, 26)),
                 cone((-3, 22, 16), (-12, -20, 17), 22, 17, (0, 0, 1), 0.75))
    outer = tube([(-16, 10, 15), (-27, -35, 15), (-34, -75, 15), (-35, -110, 13.5)], [19, 17, 14, 11], 4)
    inner = tube([(20, 20, 24), (24, -25, 33), (23, -75, 31), (25.5, -118, 21)], [14, 11, 11, 12.5], 4)
    instep = blend(12, cone((3, -16, 60), (7, -62, 46), 21, 16, (0, 0, 1), 0.95), cone((7, -62, 44), (4, -120, 24), 17, 12))
    core = cone((0, 5, 42), (-4, -70, 30), 24, 18)
    sole = union(*[cone(((x1 + x2) / 2, y1 + 20, 24), ((x1 + x2) / 2, y1 - 6, 17), 13, 13)
                   for ((x1, y1, _), _), ((x2, _, _), _) in zip(METATARSAL_HEADS, METATARSAL_HEADS[1:])])
    pads = [ellipsoid((24.5, -128, 15), (15, 21, 16)), ellipsoid((9, -128, 14), (14, 21, 14)),
            ellipsoid((-9, -124, 13.5), (14, 21, 13.5)), ellipsoid((-25, -117, 13), (14, 21, 13)),
            ellipsoid((-33, -107, 13), (11, 20, 13))]
    ball_of_foot = blend(10, *pads)
    return blend(12, cover, heel, outer, inner, instep, core, sole, ball_of_foot)


# Radii of the skin around each toe: at the root, the middle joint and the pulp; the flattening of the tip.
TOES = {
    1: [(29.5, -136, 19, 14.0), (29.4, -160, 16.5, 12.6), (29.2, -177, 14.2, 12.6), (28.6, -190.6, 12.0, 11.8)],
    2: [(8.8, -136, 18, 9.0), (7.6, -160, 18.0, 7.8), (7.1, -174, 14.5, 7.6), (7.0, -189, 8.6, 7.8)],
    3: [(-8.6, -132, 17, 8.6), (-10.2, -154, 17.0, 7.5), (-10.6, -167, 13.6, 7.3), (-10.6, -180.5, 8.3, 7.5)],
    4: [(-25.0, -126, 16, 8.0), (-28.0, -146, 16.0, 7.2), (-28.5, -157.5, 12.8, 7.0), (-28.5, -170, 8.0, 7.2)],
    5: [(-40.6, -116, 15, 8.2), (-44.6, -136, 14.0, 7.3), (-45.3, -146, 11.2, 7.1), (-45.3, -156, 8.0, 7.2)],
}


def toe(number):
    p = np.array(TOES[number])
    return tube(p[:, :3], p[:, 3], 4)


def uncut(bones):
    """The whole body without the cut above the knee. `bones`: name -> solid."""
    leg, base = shank(), foot(bones)
    ankle = blend(5, offset(bones['fibula'], 5.0), offset(bones['tibia'], 5.0))
    malleoli = common(30, ankle, half_space((0, 0, 122), (0, 0, 1)))
    toes = [toe(i) for i in range(1, 6)]

    def f(x, y, z):
        body = smooth_min(leg(x, y, z), base(x, y, z), 16.0)
        body = smooth_min(body, malleoli(x, y, z), 9.0)
        whole = body
        for t in toes:  # each toe runs into the foot, but not into its neighbour
            whole = np.minimum(whole, smooth_min(body, t(x, y, z), 7.0))
        return smooth_max(whole, -z, 5.0)  # the floor flattens the sole
    return f


def skin(body):
    """The body, cut flat."""
    return lambda x, y, z: smooth_max(body(x, y, z), z - CUT_HEIGHT, 2.0)


def wanted_edge(points):
    """Edge length wanted at points: 7.5 mm at the toes, 15 at the foot, 29 at the shank, 20 around the kneecap."""
    x, y, z = points[:, 0], points[:, 1], points[:, 2]
    ease = lambda s: s * s * (3 - 2 * s)
    toe_part = ease(np.clip((-118.0 - y) / 25.0, 0.0, 1.0))
    up = ease(np.clip((z - 75.0) / 110.0, 0.0, 1.0))
    knee = ease(np.clip(1.6 - np.sqrt(x * x + (y + 55.0) * (y + 55.0) + (z - 472.0) * (z - 472.0)) / 50.0, 0.0, 1.0))
    return (15.0 - 7.5 * toe_part) * (1 - up) + (29.0 - 9.0 * knee) * up
