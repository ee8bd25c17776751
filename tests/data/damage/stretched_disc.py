"""Writes stretched_disc.csv, with numpy 2.3: when delaminations of a disc grow that deflects by as much as it is thick.

Von Karman's plate, axisymmetric, simply supported at its edge and free to move in its plane; isotropic. Within a radius it is a stack of layers
that slide on each other, share one deflection and are held at the rim of the delamination. Deflections are Hermite cubics, displacements
in the plane linear; the load is spread evenly over a disc of 2 mm. The delamination grows where the energy that it releases at
a given deflection, by differences over 0.2 mm of its radius, is GIIc times the area.
"""

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.polynomial.legendre import leggauss

LOADED = 2e-3
POINTS, WEIGHTS = ((leggauss(4)[0] + 1) / 2, leggauss(4)[1] / 2)


@dataclass
class Disc:
    radius: float
    young: float
    poisson: float
    toughness: float
    layers: list  # thicknesses within the delamination, from the bottom

    @property
    def thickness(self):
        return sum(self.layers)

    def bending(self, layers):
        return self.young * sum(t**3 for t in layers) / 12 / (1 - self.poisson**2)

    @property
    def stretching(self):
        return self.young * self.thickness / (1 - self.poisson**2)

    def held(self):
        """Twice the energy of the layers whose middles turn with the rim, per square of its slope: uniform strains z w'/c."""
        bottoms = np.cumsum([0, *self.layers[:-1]])
        z = bottoms + np.array(self.layers) / 2 - self.thickness / 2
        return 2 * np.pi * self.young / (1 - self.poisson) * float(np.array(self.layers) @ z**2)


def nodes(disc, c):
    return np.unique(np.concatenate([np.linspace(0, 3e-3, 16), np.linspace(3e-3, c, 41), np.linspace(c, disc.radius, 61)]))


def equilibrium(disc, c, deflection, tension):
    """Force, N, and strain energy, J, at a mean deflection of what is loaded."""
    r = nodes(disc, c)
    n = len(r)
    rim = int(np.argmin(abs(r - c)))
    law = np.array([[1, disc.poisson], [disc.poisson, 1]])
    q, force = np.zeros(3 * n), 0.0
    load = np.zeros(3 * n)
    for e in range(n - 1):
        length = r[e + 1] - r[e]
        for x, w in zip(POINTS, WEIGHTS):
            radius = r[e] + x * length
            if radius < LOADED:
                hermite = [1 - 3 * x**2 + 2 * x**3, length * (x - 2 * x**2 + x**3), 3 * x**2 - 2 * x**3, length * (x**3 - x**2)]
                load[2 * e : 2 * e + 4] += np.array(hermite) * radius * w * length
    load /= load[0 : 2 * n : 2].sum()

    def forces(q):
        energy, f, k = 0.0, np.zeros(3 * n), np.zeros((3 * n, 3 * n))
        for e in range(n - 1):
            length = r[e + 1] - r[e]
            at = [2 * e, 2 * e + 1, 2 * e + 2, 2 * e + 3, 2 * n + e, 2 * n + e + 1]
            u = q[at]
            bending = disc.bending(disc.layers if e < rim else [disc.thickness])
            for x, w in zip(POINTS, WEIGHTS):
                radius = r[e] + x * length
                dv = 2 * np.pi * radius * w * length
                slope = np.array([6 * (x * x - x) / length, 1 - 4 * x + 3 * x * x, 6 * (x - x * x) / length, 3 * x * x - 2 * x, 0, 0])
                bent = np.zeros((2, 6))
                bent[0, :4] = [(12 * x - 6) / length**2, (6 * x - 4) / length, (6 - 12 * x) / length**2, (6 * x - 2) / length]
                bent[1] = slope / radius
                moments = bending * law @ bent @ u
                energy += 0.5 * moments @ bent @ u * dv
                f[at] += bent.T @ moments * dv
                k[np.ix_(at, at)] += bending * bent.T @ law @ bent * dv
                if tension:
                    stretched = np.zeros((2, 6))
                    stretched[0, 4:] = [-1 / length, 1 / length]
                    stretched[1, 4:] = [(1 - x) / radius, x / radius]
                    turned = slope @ u
                    strain = stretched @ u + [0.5 * turned**2, 0]
                    stretched[0] += turned * slope
                    stress = disc.stretching * law @ strain
                    energy += 0.5 * stress @ strain * dv
                    f[at] += stretched.T @ stress * dv
                    tangent = disc.stretching * stretched.T @ law @ stretched + stress[0] * np.outer(slope, slope)
                    k[np.ix_(at, at)] += tangent * dv
        turning = 2 * rim + 1
        energy += 0.5 * disc.held() * q[turning] ** 2
        f[turning] += disc.held() * q[turning]
        k[turning, turning] += disc.held()
        return energy, f, k

    fixed = {1, 2 * (n - 1), 2 * n} | (set() if tension else set(range(2 * n, 3 * n)))
    free = np.array([i for i in range(3 * n) if i not in fixed])
    for _ in range(60):
        _, f, k = forces(q)
        left = np.concatenate([f[free] - force * load[free], [load @ q - deflection]])
        both = np.block([[k[np.ix_(free, free)], -load[free, None]], [load[None, free], np.zeros((1, 1))]])
        change = np.linalg.solve(both, -left)
        q[free] += change[:-1]
        force += change[-1]
        if np.linalg.norm(change[:-1]) < 1e-10 * np.linalg.norm(q):
            return force, forces(q)[0]
    raise ArithmeticError("no equilibrium")


def onset(disc, c, tension):
    """Force, N, and deflection, m, at which the delaminations of radius c grow, all alike; None where they do not up to 8 mm."""

    def grows(deflection):
        energies = [equilibrium(disc, c + dc, deflection, tension)[1] for dc in (-1e-4, 1e-4)]
        return (energies[0] - energies[1]) / 2e-4 > disc.toughness * 2 * np.pi * c * (len(disc.layers) - 1)

    low, high = 0.5e-3, 8e-3
    if not grows(high):
        return None
    while high - low > 1e-7:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if grows(middle) else (middle, high)
    return equilibrium(disc, c, high, tension)[0], high


def main():
    plate = Disc(45e-3, 60e9, 0.3, 800, [2e-3, 2e-3])
    # As stiff as the coupon of T700/M21; delaminated between all plies of two angles, or between two of them.
    double = 0.52e-3
    young = 295 * 12 * (1 - 0.3**2) / (8 * double) ** 3
    all_six = Disc(48e-3, young, 0.3, 2100, [double] * 3 + [2 * double] + [double] * 3)
    one = Disc(48e-3, young, 0.3, 2100, [3 * double, 5 * double])
    cases = [("plate", plate, c, tension) for tension in (False, True) for c in (14e-3, 18e-3, 22e-3, 26e-3)]
    cases += [(name, disc, c, tension) for name, disc in (("one of coupon", one), ("six of coupon", all_six)) for c in (9e-3, 14e-3) for tension in (False, True)]
    with open(Path(__file__).with_suffix(".csv"), "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["disc", "branch", "radius_mm", "force_N", "deflection_mm"])
        for name, disc, c, tension in cases:
            found = onset(disc, c, tension)
            if found is None:
                continue
            force, deflection = found
            out.writerow([name, "stretching" if tension else "bending", f"{c * 1e3:g}", f"{force:.1f}", f"{deflection * 1e3:.4f}"])


if __name__ == "__main__":
    main()
