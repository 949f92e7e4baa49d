#!/usr/bin/env python3
"""SteamVR's trackers and controllers to limber: each one's pose as /VMC/Ext/Tra/Pos.

    pip install openvr python-osc
    steamvr_to_osc.py [HOST:PORT] [--rate 250]        # 127.0.0.1:39539
    limber stream osc:39539#LHR-1B2C3D4E              # it prints the serial numbers

Untested on hardware: nobody here has had a headset at hand. OpenVR is right-handed, y up, -z ahead; what goes out is
Unity's way, left-handed, y up, z ahead (z mirrored), as VMC's protocol has it and limber expects it.
"""
import argparse
import time

import openvr
from pythonosc.udp_client import SimpleUDPClient


def quaternion(m):
    """x y z w of a 3 x 4 matrix, by its largest part, which divides well."""
    m = [list(row) for row in m]
    squares = [1 + m[0][0] - m[1][1] - m[2][2], 1 - m[0][0] + m[1][1] - m[2][2], 1 - m[0][0] - m[1][1] + m[2][2],
               1 + m[0][0] + m[1][1] + m[2][2]]
    i = squares.index(max(squares))
    four = 2 * squares[i] ** 0.5
    if i == 3:
        return [(m[2][1] - m[1][2]) / four, (m[0][2] - m[2][0]) / four, (m[1][0] - m[0][1]) / four, four / 4]
    j, k = (i + 1) % 3, (i + 2) % 3
    q = [0.0] * 4
    q[i], q[j], q[k], q[3] = (four / 4, (m[j][i] + m[i][j]) / four, (m[k][i] + m[i][k]) / four,
                              (m[k][j] - m[j][k]) / four)
    return q


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("to", nargs="?", default="127.0.0.1:39539")
    parser.add_argument("--rate", type=float, default=250.0, help="poses a second (250)")
    choices = parser.parse_args()
    host, _, port = choices.to.rpartition(":")
    client, known = SimpleUDPClient(host, int(port)), {}
    system = openvr.init(openvr.VRApplication_Background)
    poses = (openvr.TrackedDevicePose_t * openvr.k_unMaxTrackedDeviceCount)()
    while True:
        system.getDeviceToAbsoluteTrackingPose(openvr.TrackingUniverseStanding, 0, poses)
        for index, pose in enumerate(poses):
            if not pose.bPoseIsValid:
                continue  # a tracker that sees nothing is silent
            if index not in known:
                known[index] = system.getStringTrackedDeviceProperty(index, openvr.Prop_SerialNumber_String)
                print(known[index], flush=True)
            m = pose.mDeviceToAbsoluteTracking.m
            x, y, z, w = quaternion(m)
            client.send_message("/VMC/Ext/Tra/Pos", [known[index], m[0][3], m[1][3], -m[2][3], -x, -y, z, w])
        time.sleep(1 / choices.rate)


if __name__ == "__main__":
    main()
