"""The loops of spindle.hyde by python-control: phase margin in degrees, its frequency in Hz, Ms, and the last loop gain."""

import json
import math

import control
import numpy

J1, J2, c, d, b, Kp, Ki, T = 4e-3, 8e-3, 900, 0.15, 2e-3, 0.5, 20, 0.5e-3
A = [[-(d + b) / J1, d / J1, -c / J1], [d / J2, -d / J2, c / J2], [1, -1, 0]]
plant = control.ss(A, [[1 / J1], [0], [0]], [[1, 0, 0]], 0)


def told(loop, places):
    _, phase, _, _, at, _ = control.stability_margins(loop)
    largest = max(abs(1 / (1 + loop(place))) for place in places)
    return [phase, at / (2 * math.pi), largest, abs(loop(places[-1]))]


rates = numpy.logspace(0, math.log10(math.pi / T), 20_001)
continuous = control.tf([Kp, Ki], [1, 0]) * control.tf(plant)
sampled = control.tf([Kp + Ki * T, -Kp], [1, -1], T) * control.tf(control.c2d(plant, T))
print(json.dumps({
    "continuous": told(continuous, 1j * rates),
    "sampled": told(sampled, numpy.exp(1j * rates * T)),
}))
