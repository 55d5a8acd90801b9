#!/usr/bin/env bash
# py123d 0.7.0 (123D, one interface for nuScenes, Argoverse, Waymo, nuPlan and others): roll, pitch and yaw of a pose, on a road that climbs.
#
# Expected: `EulerAngles(roll, pitch, yaw).quaternion.euler_angles` gives back what went in, as its rotation matrix does.
# Seen: only on a course along x. Angles become a quaternion by the order yaw, pitch, roll, and a quaternion becomes angles by the opposite order. On a climb of
# 0.1 rad (10 %) to the north (yaw 90 degrees) `.pitch` is 0 and `.roll` is 0.1: the climb is a bank. The heading `PoseSE3.yaw`, and `pose_se2`
# with it, is off where the course is oblique, here 0.14 degrees without roll and 0.25 degrees with a roll of 0.05 rad.
# Why it matters: slopes and banks change places with the course of the road, in one package for all data sets; tests on level ground pass. A heading that is
# off by 0.25 degrees moves the front of a truck of 18 m by 8 cm, and a point 100 m ahead by 0.4 m.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv --without-pip venv
# Only what the geometry needs: ray and others are left out by --no-deps.
python3 -m pip --python venv install -q --no-compile --no-deps py123d==0.7.0 numpy==2.2.6 shapely==2.1.2 pyquaternion==0.9.9 scipy==1.17.1 typing_extensions==4.16.0

venv/bin/python - <<'PY'
import math
import sys

from py123d.geometry import EulerAngles, PoseSE3
from scipy.spatial.transform import Rotation


def poses(roll, pitch, yaw):
    """(roll, pitch, yaw) of a PoseSE3, of its rotation matrix by py123d, and of its quaternion by scipy."""
    quaternion = EulerAngles(roll, pitch, yaw).quaternion
    pose = PoseSE3(0.0, 0.0, 0.0, quaternion.qw, quaternion.qx, quaternion.qy, quaternion.qz)
    by_matrix = EulerAngles.from_rotation_matrix(pose.rotation_matrix)
    by_scipy = Rotation.from_quat([quaternion.qx, quaternion.qy, quaternion.qz, quaternion.qw]).as_euler("ZYX")[::-1]
    assert pose.pose_se2.yaw == pose.yaw
    return (pose.roll, pose.pitch, pose.yaw), (by_matrix.roll, by_matrix.pitch, by_matrix.yaw), tuple(by_scipy)


def near(seen, expected):
    return all(abs(a - b) < 1e-4 for a, b in zip(seen, expected))


others_right, seen = True, {}
for roll, pitch, yaw in ((0.0, -0.1, 0.0), (0.0, -0.1, math.pi / 2), (0.0, -0.1, 0.8), (0.05, -0.1, 0.8)):
    of_pose, of_matrix, of_scipy = poses(roll, pitch, yaw)
    seen[roll, round(yaw, 1)] = of_pose
    others_right = others_right and near(of_matrix, (roll, pitch, yaw)) and near(of_scipy, (roll, pitch, yaw))
    told = [tuple(round(float(angle), 4) for angle in angles) for angles in ((roll, pitch, yaw), of_pose, of_matrix)]
    print(f"roll, pitch, yaw put in {told[0]}: pose {told[1]}, by its matrix {told[2]}; heading off by {math.degrees(of_pose[2] - yaw):.2f} degrees")
along_x = near(seen[0.0, 0.0], (0.0, -0.1, 0.0))
climb_is_bank = near(seen[0.0, 1.6], (0.1, 0.0, math.pi / 2))
heading_off = abs(math.degrees(seen[0.0, 0.8][2] - 0.8) - 0.14) < 0.02 and abs(math.degrees(seen[0.05, 0.8][2] - 0.8) - 0.25) < 0.02
print(f"right along x: {along_x}; a climb to the north is a bank: {climb_is_bank}; heading off: {heading_off}; scipy and the matrix right: {others_right}")
sys.exit(0 if along_x and climb_is_bank and heading_off and others_right else 1)
PY
