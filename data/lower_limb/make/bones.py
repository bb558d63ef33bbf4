# SPDX-License-Identifier: BSD-3-Clause
"""The 28 bones as solids. Millimetres; right leg; x medial, -y front, z up; floor z = 0; ankle joint above the origin.

Lengths and positions follow anthropometry.py (see ../SOURCES.md); the shapes are modelled freely.
Neighbours are kept apart by carving each bone with the earlier ones of ORDER grown by a joint gap, which also makes
the hollow half of each joint fit the round half.
"""
from anthropometry import (ANKLE_HEIGHT, BALL_Y, FIBULA_LENGTH, METATARSAL_HEADS, METATARSAL_PROTRUSION, PHALANGES,
                           PLATEAU_HEIGHT)
from sdf import ball, blend, box, carve, common, cone, ellipsoid, frame, half_space, loft, offset, tube

GAP = 2.0  # joint space, mm


def talus():
    z = ANKLE_HEIGHT
    trochlea = common(4, ellipsoid((0, 0, z), (60, 19, 19)), half_space((15, 0, z), (1, 0, 0.08)),
                      half_space((-15, 0, z), (-1, 0, 0.08)), half_space((0, 0, z - 9), (0, 0.15, -1)))
    groove = cone((0, -22, z + 21), (0, 22, z + 21), 3.5, 3.5)
    body = blend(5, carve(5, trochlea, groove),
                 ellipsoid((-15, 3, z - 5), (6, 7, 5)),          # lateral process
                 cone((3, 14, z - 4), (2, 22, z - 7), 7, 5))      # posterior process
    neck = cone((3, -8, z - 6), (10, -22, z - 11), 10.5, 10, (0, 0, 1), 0.85)
    head = ellipsoid((10, -27, z - 13), (13.5, 11.5, 10.5), frame((0.2, -1, -0.3), (0.45, 0, 1)))
    return blend(8, body, neck, head)


def calcaneus():
    tuber = blend(8, cone((-4, 36, 28), (-3, 35, 40), 13.5, 10.5, (1, 0, 0), 1.0),
                  ball((4, 34, 21), 8), ball((-10, 33, 21), 7))
    body = cone((-3, 30, 34), (-9, -12, 36), 13.5, 11, (1, 0, 0), 0.85)
    facet = ellipsoid((-4, 5, 46), (12.5, 14, 11))
    shelf = ellipsoid((13, -8, 42), (9, 9, 4.5))
    front = box((-12, -17, 35), (10, 10, 10.5), 5, frame((-0.1, -1, 0.1)))
    peroneal = ball((-18, -2, 29), 4)
    solid = blend(9, tuber, body, facet, shelf, front, peroneal)
    sinus = ellipsoid((-4, -11, 51), (12, 6, 7))
    hollow = ellipsoid((14, 12, 27), (8, 20, 9))
    return carve(6, solid, sinus, hollow)


def navicular():
    axes = frame((0.12, -1, -0.15), (0.25, 0, 1))
    disc = common(5, ellipsoid((9, -45, 48), (20, 16, 14), axes), half_space((9, -54.3, 47), (0.05, -1, -0.1)),
                  half_space((9, -37, 48), (0.25, 1, 0.1)))
    return blend(6, disc, cone((20, -46, 42), (27.5, -43, 38), 8, 5.5))


def cuneiforms():
    medial = common(4, box((19, -66, 36), (8, 10.7, 15), 6, frame((0, -1, 0), (-0.2, 0, 1))),
                    half_space((13, -66, 50), (-0.8, 0, 0.6)))
    inner = common(3, box((3.5, -62, 47), (6.5, 6.7, 8.5), 3), half_space((9, -62, 42), (0.9, 0, -0.45)),
                   half_space((-2, -62, 42), (-0.9, 0, -0.45)))
    outer = common(3, box((-11, -62, 41), (7, 7.5, 11), 3.5), half_space((-6, -62, 34), (0.9, 0, -0.45)),
                   half_space((-15, -62, 34), (-0.9, 0, -0.45)))
    return {'cuneiform_medial': medial, 'cuneiform_intermediate': inner, 'cuneiform_lateral': outer}


def cuboid():
    block = box((-25, -45, 29), (11.5, 15.5, 12), 5, frame((0.1, -1, -0.12), (-0.35, 0, 1)))
    wedge = half_space((-36, -45, 29), (-1, 0.55, 0))
    keel = cone((-32, -44, 19), (-18, -40, 19), 4.5, 5)
    groove = cone((-40, -52, 17), (-12, -48, 14), 3.5, 3.5)
    return carve(4, blend(5, common(5, block, wedge), keel), groove)


def metatarsals():
    bases = [(20.5, -79, 35), (4, -70.5, 45), (-10, -70.5, 40), (-22, -64, 32), (-33.5, -56, 23)]
    base_half = [(8.5, 6.5, 13.5), (7, 6.5, 9.5), (6.5, 6.5, 9.5), (6.5, 6.5, 8.5), (8, 7, 6.5)]
    shaft = [6.6, 3.7, 3.5, 3.5, 3.7]
    bones = {}
    for i in range(5):
        head, radius = METATARSAL_HEADS[i]
        base = bases[i]
        along = [h - b for h, b in zip(head, base)]
        axes = frame(along)
        at = lambda s, lift=0.0: tuple(b + s * d for b, d in zip(base[:2], along[:2])) + (
            base[2] + s * along[2] + lift,)
        front_y = BALL_Y + METATARSAL_PROTRUSION[i]  # the head's front
        if i == 0:
            knuckle = ellipsoid(head, (radius * 1.02, radius, radius), axes)
        else:
            knuckle = ellipsoid((head[0], front_y + radius, head[2]), (radius * 0.85, radius, radius * 1.1), axes)
        r = shaft[i]
        bar = tube([at(0.0), at(0.2, 0.5), at(0.5, 1.5), at(0.78, 1.0), at(0.95)],
                   [r * 1.35, r * 1.15, r, r * 1.05, r * 1.3])
        block = box(tuple(b + 0.06 * d for b, d in zip(base, along)), base_half[i], 3.2, axes)
        solid = blend(9, bar, block, knuckle)
        if i == 0:  # ridge between the sesamoid grooves; plantar lateral corner of the base
            solid = blend(4, solid, cone((head[0], head[1] + 6, head[2] - 7), (head[0], head[1] - 4, head[2] - 8), 3, 3))
        if i == 4:  # styloid process
            solid = blend(6, solid, cone((-37, -58, 21), (-44, -44, 18), 6.5, 4.2))
        bones[f'metatarsal_{i + 1}'] = solid
    return bones


def phalanx(a, b, base, waist, head, squeeze=0.85):
    """A small long bone from the plane of its base at a to the tip of its head at b; radii of base, shaft and head."""
    d = [q - p for p, q in zip(a, b)]
    axes = frame(d)
    l = sum(c * c for c in d) ** 0.5
    at = lambda s: tuple(p + s * c / l for p, c in zip(a, d))
    side = axes[0]
    cup = ellipsoid(at(base * 0.62), (base, base * 0.62, base * squeeze), axes)
    hs = head * 0.55
    knob = [tuple(c + s * hs * e for c, e in zip(at(l - head * 0.72), side)) for s in (-1, 1)]
    bar = cone(at(base * 0.7), at(l - head), waist, waist * 0.95)
    return blend(min(4.0, 0.9 * base), bar, cup, ball(knob[0], head * 0.72), ball(knob[1], head * 0.72))


def distal_phalanx(a, b, base, waist, tuft):
    """Base, thin waist and the flat tuft under the nail."""
    d = [q - p for p, q in zip(a, b)]
    axes = frame(d)
    l = sum(c * c for c in d) ** 0.5
    at = lambda s: tuple(p + s * c / l for p, c in zip(a, d))
    cup = ellipsoid(at(base * 0.6), (base, base * 0.6, base * 0.8), axes)
    flat = ellipsoid(at(l - tuft * 0.6), (tuft, tuft * 0.6, tuft * 0.6), axes)
    return blend(min(3.0, 0.7 * base), cone(at(base * 0.5), at(l - tuft * 0.6), waist, waist * 0.9), cup, flat)


def phalanges():
    bones = {}
    for toe, (chain, sizes) in PHALANGES.items():
        names = ['proximal', 'distal'] if toe == 1 else ['proximal', 'middle', 'distal']
        for name, (a, b), size in zip(names, chain, sizes):
            make = distal_phalanx if name == 'distal' else phalanx
            bones[f'phalanx_{name}_{toe}'] = make(a, b, *size)
    return bones


def fibula():
    top = FIBULA_LENGTH + 57.0
    shaft = tube([(-35, 21, top - 14), (-36, 19, top - 38), (-37, 16, 330), (-36, 13, 240), (-32, 9, 150),
                  (-26.5, 5, 105), (-25.5, 4, 88)], [8, 5.6, 6.2, 6.4, 6.0, 6.8, 7.6])
    head = ellipsoid((-35, 22, top - 12), (9.5, 10.5, 11.5))
    styloid = cone((-36, 24, top - 10), (-37, 26, top - 3), 6, 3)
    malleolus = blend(6, cone((-26, 3, 92), (-26, 3, 68), 8.6, 7.6, (1, 0, 0), 0.92), ball((-25.5, 5, 63), 6.0))
    return blend(8, shaft, head, styloid, malleolus)


def tibia():
    top = PLATEAU_HEIGHT
    column = loft([(top, 0, 2, 36, 36, 22, 23), (top - 12, 0, 2, 36, 36, 23, 24), (top - 28, 0, 0, 29, 29, 24, 21),
                   (top - 48, 0, -3, 20, 20, 24, 17), (top - 75, 1, -6, 15.5, 15.5, 20, 15),
                   (top - 115, 2, -7, 13, 13.5, 17, 13), (250, 2, -6, 12, 12, 14.5, 12), (190, 2, -5, 11, 11.5, 13, 11.5),
                   (150, 2, -4, 11.5, 12, 12.5, 12), (120, 2, -3, 15, 14.5, 14, 14), (100, 2, -2, 21, 19, 18, 18),
                   (88, 2, -1, 25, 20, 19.5, 19), (80, 2, -1, 26, 19, 19, 19)], 5, 0.25)
    condyles = blend(6, ellipsoid((19.5, 3, top - 11), (18.5, 25, 12.5)), ellipsoid((-19.5, 3, top - 11), (18.5, 23, 12.5)))
    tuberosity = blend(8, ellipsoid((-2, -27, top - 38), (9, 8, 15)), cone((-2, -28, top - 42), (3, -22, top - 90), 6, 4))
    crest = tube([(2, -24, top - 80), (3, -18.5, 260), (3, -14, 190), (3, -9.5, 130)], [3.2, 3.0, 2.6, 2.0], 4)
    malleolus = blend(7, cone((21, -1, 96), (23.5, -3, 76), 11, 7.2, (1, 0, 0), 0.8), ball((23.5, -5, 73), 6.2))
    solid = blend(10, blend(7, column, condyles), tuberosity, crest, malleolus)
    solid = common(4, solid, half_space((0, 0, top), (0, 0, 1)))
    spines = blend(3, cone((5, 2, top - 4), (4, 2, top + 4), 5, 2.2), cone((-5, 3, top - 4), (-4, 3, top + 3), 5, 2.2))
    dishes = [ellipsoid((20, 3, top + 12), (15, 20, 13.5)), ellipsoid((-20, 3, top + 12), (14, 17, 13))]
    notch = cone((0, 34, top - 40), (0, 34, top + 10), 11, 13)
    return carve(5, blend(5, carve(3, solid, *dishes), spines), notch)


# Earlier bones keep their shape, later ones give way.
ORDER = (['talus', 'calcaneus', 'fibula', 'tibia', 'navicular', 'cuneiform_medial', 'cuneiform_lateral',
          'cuneiform_intermediate', 'cuboid'] + [f'metatarsal_{i}' for i in (1, 2, 3, 4, 5)]
         + [f'phalanx_{n}_{i}' for n in ('proximal', 'middle', 'distal') for i in (1, 2, 3, 4, 5) if (n, i) != ('middle', 1)])

# Bones that touch in a joint, or nearly: the later is carved by the earlier.
NEIGHBOURS = {
    'calcaneus': ['talus'], 'fibula': ['talus', 'calcaneus'], 'tibia': ['talus', 'fibula'], 'navicular': ['talus', 'calcaneus'],
    'cuneiform_medial': ['navicular'], 'cuneiform_lateral': ['navicular', 'cuneiform_medial'],
    'cuneiform_intermediate': ['navicular', 'cuneiform_medial', 'cuneiform_lateral'],
    'cuboid': ['calcaneus', 'navicular', 'cuneiform_lateral', 'talus'],
    'metatarsal_1': ['cuneiform_medial'],
    'metatarsal_2': ['cuneiform_medial', 'cuneiform_intermediate', 'cuneiform_lateral', 'metatarsal_1'],
    'metatarsal_3': ['cuneiform_intermediate', 'cuneiform_lateral', 'metatarsal_2', 'cuboid'],
    'metatarsal_4': ['cuneiform_lateral', 'cuboid', 'metatarsal_3'], 'metatarsal_5': ['cuboid', 'metatarsal_4'],
}
for _i in range(1, 6):
    NEIGHBOURS[f'phalanx_proximal_{_i}'] = [f'metatarsal_{_i}']
    if _i > 1:
        NEIGHBOURS[f'phalanx_middle_{_i}'] = [f'phalanx_proximal_{_i}']
    NEIGHBOURS[f'phalanx_distal_{_i}'] = [f'phalanx_{"proximal" if _i == 1 else "middle"}_{_i}']


def skeleton():
    """Name -> solid, in ORDER."""
    raw = {'talus': talus(), 'calcaneus': calcaneus(), 'fibula': fibula(), 'tibia': tibia(), 'navicular': navicular(),
           'cuboid': cuboid(), **cuneiforms(), **metatarsals(), **phalanges()}
    done = {}
    for name in ORDER:
        tools = [offset(raw[n], GAP) for n in NEIGHBOURS.get(name, [])]
        done[name] = carve(1.5, raw[name], *tools) if tools else raw[name]
    return done
