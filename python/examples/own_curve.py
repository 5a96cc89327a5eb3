"""A curve of one's own: two functions of the position, flown in wind by the supervised law.

    python own_curve.py
"""

import numpy as np

import slung


def superellipse_on_a_wave(x, y, z):
    """Both are zero on the curve, in N: z points down. They are called once, and evaluated on series from then on."""
    return (x / 5) ** 4 + (y / 4) ** 4 - 1, z + 10 - 0.5 * np.sin(x / 2)


path = slung.path_of(superellipse_on_a_wave, speed=lambda x, y, z: 1.5 + 0.1 * x, yaw="tangent")
print(path.check())

scenario = slung.Scenario(
    path=path,
    duration_s=60.0,
    initial={"position": [5.6, 0.4, -9.0]},
    controller={"rate_hz": 500.0, "observer": {"payload": 8.0, "rod": 8.0, "torque": 8.0}},
    environment={"air": {"wind": [3.0, 0.0, 0.0], "payload_drag_area": 0.01, "uav_drag_area": 0.05}},
)
flight = slung.run(scenario)
late = flight.log["t_s"] >= 45.0
print(flight, f"farthest from the curve in the last quarter: {1e3 * flight.log['d_c'][late].max():.2f} mm")
