"""Traces of axes, made by a simulator of its own: semi-implicit Euler at 10 us, friction by clamping the speed at 0.

    simulate.py KIND SEED OUT        KIND is belt, linear or bench

The loop is closed by a cascade every 1 ms. What a scope would store is written every 1 ms, with noise and quantisation.
"""
import math
import random
import sys

STEP = 1e-5
# Of every current loop.
LAG = 2e-3


def stroke(distance, speed, acceleration, t):
    """The place on a trapezoidal motion."""
    sign, d = math.copysign(1, distance), abs(distance)
    rise = min(speed / acceleration, math.sqrt(d / acceleration))
    top = acceleration * rise
    whole = d / top + rise
    if t <= 0:
        return 0.0
    if t >= whole:
        return distance
    if t < rise:
        return sign * acceleration * t * t / 2
    if t < whole - rise:
        return sign * (top * t - top * rise / 2)
    return sign * (d - acceleration * (whole - t) ** 2 / 2)


def reference(moves, t):
    place, begin = 0.0, 0.1
    for distance, speed, acceleration in moves:
        place += stroke(distance, speed, acceleration, t - begin)
        begin += abs(distance) / speed + speed / acceleration + 0.15
    return place


class Friction:
    """Coulomb and viscous friction of a body; the speed stays 0 while the rest is smaller than the friction."""

    def __init__(self, inertia, coulomb, viscous):
        self.inertia, self.coulomb, self.viscous = inertia, coulomb, viscous
        self.v = 0.0

    def move(self, force):
        v = self.v + STEP * (force - self.viscous * self.v) / self.inertia
        most = STEP * self.coulomb / self.inertia
        self.v = math.copysign(max(abs(v) - most, 0.0), v)
        return self.v


def belt(moves, seconds):
    """Motor with a pulley, belt, carriage: motor angle, position, current."""
    K, J, lead = 0.62, 1.1e-3, 0.045 / (2 * math.pi)
    c, d = 9.0e5, 900.0
    carriage = Friction(34.0, 62.0, 210.0)
    w = phi = x = old = integral = demand = i = 0.0
    for n in range(round(seconds / STEP)):
        t = n * STEP
        if n % 100 == 0:
            yield t, (reference(moves, t) * 1e3, math.degrees(phi), x * 1e3, i)
            e = reference(moves, t) / lead - phi
            slope = (reference(moves, t + 1e-3) - reference(moves, t)) / lead / 1e-3
            missing = 30 * e + slope - (phi - old) / 1e-3
            old = phi
            integral = max(-15.0, min(15.0, integral + 10 * missing * 1e-3))
            demand = max(-15.0, min(15.0, 0.35 * missing + integral))
        i += STEP * (demand - i) / LAG
        pull = c * (lead * phi - x) + d * (lead * w - carriage.v)
        w += STEP * (K * i - lead * pull) / J
        phi += STEP * w
        x += STEP * carriage.move(pull)


def linear(moves, seconds):
    """Slide of a linear motor: position, current."""
    K = 88.0
    slide = Friction(21.0, 18.0, 60.0)
    x = old = integral = demand = i = 0.0
    for n in range(round(seconds / STEP)):
        t = n * STEP
        if n % 100 == 0:
            yield t, (reference(moves, t) * 1e3, x * 1e3, i)
            e = reference(moves, t) - x
            slope = (reference(moves, t + 1e-3) - reference(moves, t)) / 1e-3
            missing = 40 * e + slope - (x - old) / 1e-3
            old = x
            integral = max(-14.0, min(14.0, integral + 1500 * missing * 1e-3))
            demand = max(-14.0, min(14.0, 40 * missing + integral))
        i += STEP * (demand - i) / LAG
        x += STEP * slide.move(K * i)


def bench(moves, seconds):
    """Motor, flexible shaft, load: both angles, current."""
    K, J, c, d = 0.11, 2.2e-4, 31.0, 0.012
    load = Friction(5.6e-4, 0.045, 2.5e-4)
    w = phi = psi = old = integral = demand = i = 0.0
    for n in range(round(seconds / STEP)):
        t = n * STEP
        if n % 100 == 0:
            yield t, (phi, psi, i)
            e = 60 * reference(moves, t) - phi
            slope = 60 * (reference(moves, t + 1e-3) - reference(moves, t)) / 1e-3
            missing = 25 * e + slope - (phi - old) / 1e-3
            old = phi
            integral = max(-20.0, min(20.0, integral + 2.5 * missing * 1e-3))
            demand = max(-20.0, min(20.0, 0.1 * missing + integral))
        i += STEP * (demand - i) / LAG
        twist = c * (phi - psi) + d * (w - load.v)
        w += STEP * (K * i - twist) / J
        phi += STEP * w
        psi += STEP * load.move(twist)


# For each kind: the simulator, the header, separator and decimal sign, and of each column the step and the noise.
KINDS = {
    "belt": (
        belt,
        "Zeit [ms];Sollposition [mm];Motorwinkel [deg];Istposition [mm];Strom [A]",
        (";", ","),
        [(0, 0), (0.005, 0), (0.001, 0.0003), (0, 0.02)],
    ),
    "linear": (linear, "t [s],pos_cmd [mm],pos_act [mm],current [A]", (",", "."), [(0, 0), (1e-4, 5e-5), (0, 0.015)]),
    "bench": (bench, "t [s]\tmotor [rad]\tload [rad]\tiq [A]", ("\t", "."), [(1e-4, 0), (1e-4, 0), (0, 0.01)]),
}


def main():
    kind, seed, out = sys.argv[1], int(sys.argv[2]), sys.argv[3]
    simulate, header, (separator, decimal), channels = KINDS[kind]
    random.seed(seed)
    moves = []
    for k in range(6):
        distance = random.uniform(0.05, 0.3) * (-1) ** k
        moves.append((distance, random.uniform(0.1, 0.6), random.uniform(1, 5)))
    milliseconds = "[ms]" in header
    lines = [header]
    for t, values in simulate(moves, 6.0):
        cells = [f"{t * 1e3:.0f}" if milliseconds else f"{t:.3f}"]
        for value, (step, noise) in zip(values, channels):
            value += random.gauss(0, noise)
            value = step * math.floor(value / step) if step else value
            cells.append(f"{value:.6g}" if not step else f"{value:.6f}")
        lines.append(separator.join(cells).replace(".", decimal))
    with open(out, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")


main()
