# SPDX-License-Identifier: BSD-3-Clause
"""Published measures of the body the model stands for, and the places that follow from them. Millimetres.

Sources, by the letters used here, are listed in ../SOURCES.md.
"""
# [A] ANSUR II, means of all 6068 men and women.
FOOT_LENGTH = 263.0
BALL_OF_FOOT_LENGTH = 194.8
FOOT_BREADTH = 98.9
HEEL_BREADTH = 70.8
BALL_CIRCUMFERENCE = 244.2
HEEL_ANKLE_CIRCUMFERENCE = 332.6
ANKLE_CIRCUMFERENCE = 224.9
CALF_CIRCUMFERENCE = 386.0
LOWER_THIGH_CIRCUMFERENCE = 406.5
BIMALLEOLAR_BREADTH = 72.3
LATERAL_MALLEOLUS_HEIGHT = 69.6
KNEE_HEIGHT_MIDPATELLA = 475.5
EPICONDYLE_HEIGHT = 483.2
STATURE = 1714.0

# [D] Segment lengths as fractions of stature: the hip joint stands at 0.530, the thigh is 0.245.
HIP_HEIGHT = 0.530 * STATURE

# [T] Stature from bones, solved for the bone: tibia (78.62 cm + 2.52 L), without its malleolus [J]; fibula (71.78 + 2.68 L).
TIBIA_LENGTH = (STATURE - 786.2) / 2.52
FIBULA_LENGTH = (STATURE - 717.8) / 2.68

ANKLE_HEIGHT = 64.0  # axis of the ankle, a little below the most prominent points of the malleoli [I]
CUT_HEIGHT = 548.0   # 65 mm above the epicondyles
TALAR_RADIUS = 19.0  # of the trochlea
PLATEAU_HEIGHT = ANKLE_HEIGHT + TALAR_RADIUS + 2.0 + TIBIA_LENGTH  # over a joint space of 2 mm
KNEE_AXIS_HEIGHT = EPICONDYLE_HEIGHT - 4.0

HEEL_Y = 60.0                                  # the back of the heel
TOE_Y = HEEL_Y - FOOT_LENGTH                   # the tip of the longest toe
BALL_Y = -141.0                                # front of the head of metatarsal 2

# [P] How far the heads reach behind the second's front: means of 169 feet.
METATARSAL_PROTRUSION = [-0.94, 0.0, 4.44, 11.17, 20.21]
# Centre and radius of the heads.
_X = [29.5, 9.0, -8.5, -24.5, -40.0]
_Z = [20.5, 17.5, 16.5, 15.5, 14.5]
_R = [10.0, 6.8, 6.4, 6.2, 6.2]
METATARSAL_HEADS = [((x, BALL_Y + p + r, z), r) for x, p, r, z in zip(_X, METATARSAL_PROTRUSION, _R, _Z)]

# Chains of phalanges: (base, tip) of each, then (base, shaft, head radius). Lengths [F]: 28 mm for proximal 1, the
# longest, to about 5 mm for distal 5, the shortest.
PHALANGES = {
    1: ([((29.5, -143.5, 19.5), (29.2, -171.5, 16.0)), ((29.2, -173.0, 15.5), (28.7, -194.5, 12.0))],
        [(8.6, 5.4, 6.6), (7.4, 4.6, 5.2)]),
    2: ([((8.6, -143.0, 18.0), (7.4, -167.0, 19.0)), ((7.3, -168.0, 18.4), (7.0, -179.0, 12.5)),
         ((7.0, -180.3, 11.6), (7.0, -189.5, 8.5))], [(5.4, 2.9, 3.9), (4.2, 3.0, 3.6), (3.6, 2.2, 2.9)]),
    3: ([((-8.8, -138.5, 17.0), (-10.4, -160.5, 18.0)), ((-10.5, -161.5, 17.4), (-10.6, -171.0, 11.8)),
         ((-10.6, -172.3, 11.0), (-10.6, -180.8, 8.2))], [(5.1, 2.7, 3.7), (4.0, 2.9, 3.4), (3.5, 2.1, 2.8)]),
    4: ([((-25.0, -132.0, 16.0), (-28.2, -151.5, 16.8)), ((-28.3, -152.5, 16.2), (-28.5, -161.0, 11.2)),
         ((-28.5, -162.2, 10.4), (-28.5, -170.0, 8.0))], [(4.9, 2.6, 3.5), (3.8, 2.8, 3.2), (3.3, 2.0, 2.7)]),
    5: ([((-40.8, -123.0, 14.5), (-44.8, -140.5, 14.2)), ((-44.9, -141.5, 13.6), (-45.3, -148.5, 10.2)),
         ((-45.3, -149.7, 9.6), (-45.3, -155.8, 8.0))], [(4.7, 2.5, 3.3), (3.5, 2.7, 3.0), (3.1, 1.9, 2.5)]),
}
