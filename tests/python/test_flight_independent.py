"""A flight by the program beside the same flight by SciPy, on equations that are written here once more: slider-crank,
motor, friction that follows the rod force, and wings by many strips in vectors of three components."""

import math
import unittest

import numpy as np

import wingbeat as wb

try:
    from scipy.integrate import solve_ivp
except ImportError:
    solve_ivp = None

HALF_PI = 0.5 * math.pi


class Flapper:
    """data/designs/flight-friction2022.toml."""

    voltage, R_a, L_a, K, J, b = 6.0, 9.0, 29e-3, 0.01, 1.5e-7, 3.6e-6
    r_c, l, H, mu_r = 5e-3, 20e-3, 6e-3, 2.5e-3
    J_w, k = 7.205e-8, 1.377e-3
    rho, C_alpha = 1.225, 5e-3
    length, root_chord = 62.8127e-3, 25.2466e-3
    mass, gravity = 3.34e-3, 9.80665
    inertia = np.diag([6e-7, 5e-7, 3e-7])
    shoulder = np.array([0.0, 6e-3, -8e-3])

    def __init__(self, strips=300):
        x, w = np.polynomial.legendre.leggauss(strips)
        angle = 0.25 * math.pi * (x + 1.0)  # r = R sin(angle)
        self.r = self.length * np.sin(angle)
        self.area = 0.25 * math.pi * w * self.root_chord * np.cos(angle) * self.length * np.cos(angle)

    @staticmethod
    def coefficients(alpha):
        """By the waves up to 90 degrees, turned round beyond 120, smoothly between."""
        degree = math.pi / 180.0

        def waves(a):
            return (0.225 + 1.58 * np.sin(2.13 * a - 7.2 * degree), 1.92 - 1.55 * np.cos(2.04 * a - 9.82 * degree))

        lift, drag = waves(alpha)
        back_lift, back_drag = waves(np.where(alpha > 0.0, math.pi, -math.pi) - alpha)
        part = np.clip((np.abs(alpha) - HALF_PI) / (math.pi / 6.0), 0.0, 1.0)
        share = part**3 * (10.0 - 15.0 * part + 6.0 * part**2)
        return lift + share * (-back_lift - lift), drag + share * (back_drag - drag)

    def wing(self, side, beta, beta_rate, V, W):
        """Force, moment about the centre of mass, and moment against the stroke."""
        span = np.array([math.sin(beta), side * math.cos(beta), 0.0])
        ahead = np.array([math.cos(beta), -side * math.sin(beta), 0.0])
        down = np.array([0.0, 0.0, 1.0])
        place = self.shoulder * [1.0, side, 1.0] + self.r[:, None] * span
        moves = V + np.cross(W, place)
        u = self.r * beta_rate + moves @ ahead
        w = moves @ down
        sign = 1.0 if beta_rate >= 0.0 else -1.0
        psi = -self.C_alpha * beta_rate
        alpha = np.arctan2(sign * (u * math.cos(psi) - w * math.sin(psi)), -(u * math.sin(psi) + w * math.cos(psi)))
        speed = np.hypot(u, w) + 1e-150
        C_L, C_D = self.coefficients(alpha)
        C_L = C_L - self.coefficients(np.array([0.0]))[0][0] * (w / speed) ** 2
        q = 0.5 * self.rho * speed * self.area
        f_ahead, f_down = q * (sign * C_L * w - C_D * u), q * (-sign * C_L * u - C_D * w)
        force = f_ahead[:, None] * ahead + f_down[:, None] * down
        return force.sum(axis=0), np.cross(place, force).sum(axis=0), -(self.r * f_ahead).sum()

    def rates(self, _, y):
        theta, omega, i = y[:3]
        V, W, q = y[3:6], y[6:9], y[9:13]
        s, c = math.sin(theta), math.cos(theta)
        ratio = self.r_c / self.l
        sin_g = ratio * c
        cos_g = math.sqrt(1.0 - sin_g**2)
        tan_g = sin_g / cos_g
        dy = self.r_c * (c + s * tan_g)
        ddy = self.r_c * (c * tan_g - s - ratio * s * s / cos_g**3)
        tan_b = (self.r_c * s + self.l * cos_g - self.l) / self.H
        cos2_b = 1.0 / (1.0 + tan_b**2)
        B1 = dy / self.H * cos2_b
        B2 = ddy / self.H * cos2_b - 2.0 * tan_b * B1**2
        g, h = self.H * (sin_g * tan_b + cos_g), cos_g * dy
        beta, beta_rate = math.atan(tan_b), B1 * omega
        wings = [self.wing(side, beta, beta_rate, V, W) for side in (1.0, -1.0)]
        force, moment = wings[0][0] + wings[1][0], wings[0][1] + wings[1][1]
        stroke_moment = wings[0][2] + wings[1][2]
        drive = self.K * i - self.b * omega
        A = 2.0 * self.J_w * B1 / g
        C = (2.0 * self.J_w * B2 * omega**2 + stroke_moment + 2.0 * self.k * beta) / g
        lever = h + (1.0 if self.J * C + A * drive >= 0.0 else -1.0) * self.mu_r
        omega_rate = (drive - C * lever) / (self.J + A * lever)
        w, x, y_, z = q
        turn = np.array([
            [1 - 2 * (y_ * y_ + z * z), 2 * (x * y_ - w * z), 2 * (x * z + w * y_)],
            [2 * (x * y_ + w * z), 1 - 2 * (x * x + z * z), 2 * (y_ * z - w * x)],
            [2 * (x * z - w * y_), 2 * (y_ * z + w * x), 1 - 2 * (x * x + y_ * y_)]])  # fmt: skip
        acceleration = force / self.mass + turn.T @ [0.0, 0.0, self.gravity] - np.cross(W, V)
        turns = np.linalg.solve(self.inertia, moment - np.cross(W, self.inertia @ W))
        q_rate = 0.5 * np.array([
            -x * W[0] - y_ * W[1] - z * W[2], w * W[0] + y_ * W[2] - z * W[1],
            w * W[1] + z * W[0] - x * W[2], w * W[2] + x * W[1] - y_ * W[0]])  # fmt: skip
        current_rate = (self.voltage - self.R_a * i - self.K * omega) / self.L_a
        return np.concatenate([[omega, omega_rate, current_rate], acceleration, turns, q_rate, turn @ V])


@unittest.skipUnless(solve_ivp, "SciPy is not installed")
class Independent(unittest.TestCase):
    def test_two_wingbeats(self):
        body = wb.BodyState.at(velocity=[0.4, -0.2, 0.1], rates=[1.0, -2.0, 0.5], euler_angles=[0.2, 0.1, 0.3])
        flight = wb.read("flight-friction2022").flight_simulation(tolerance=1e-9)
        flight.start(body, [[0.3, 200.0, 0.3, 0, 0, 0, 0, 0, 0]])
        start = np.concatenate([[0.3, 200.0, 0.3], body.velocity, body.rates, body.attitude, body.position])
        end = 0.05
        self.assertTrue(flight.step_to(end))
        found = solve_ivp(Flapper().rates, (0.0, end), start, method="DOP853", rtol=1e-9, atol=1e-11, max_step=2e-4)
        self.assertTrue(found.success)
        y = found.y[:, -1]
        now = flight.body
        np.testing.assert_allclose(flight.drives[0][:3], y[:3], rtol=1e-5)
        np.testing.assert_allclose(now.velocity, y[3:6], atol=5e-6)
        np.testing.assert_allclose(now.rates, y[6:9], atol=5e-4)
        np.testing.assert_allclose(now.attitude, y[9:13], atol=5e-6)
        np.testing.assert_allclose(now.position, y[13:16], atol=5e-7)
        self.assertGreater(abs(now.rates[1] + 2.0), 0.5)  # it has turned


if __name__ == "__main__":
    unittest.main()
