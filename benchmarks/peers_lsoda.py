"""Steady flapping of the designs of a CSV file by SciPy's LSODA, iterates in crank angle until periodic.

    python3 peers_lsoda.py DESIGNS.csv RTOL

Prints one row per design: mean lift [N], mean electrical power [W], frequency [Hz], seconds that the solve took.
benchmark_peers writes the file and runs this script; the equations are those of docs/model.md section 2.
"""
import csv
import math
import sys
import time
import warnings

from scipy.integrate import odeint

COARSE = 1e-4     # tolerance of the first iterates, which only approach the orbit
PERIODIC = 1e-6   # an iterate that returns to its start within this, relatively, is the orbit
LAPS = 60


def rates_of(d, scale):
    """d(state)/d(theta) of crank speed, current, time, lift impulse and charge, each divided by its scale."""
    J, b, K = d["inertia"], d["damping"], d["torque_constant"]
    R_a, L_a, v = d["resistance"], d["inductance"], d["voltage"]
    T_c, mu_r = d["friction_torque"], d["friction_radius"]
    r_c, l, H, y_0 = d["crank_radius"], d["rod_length"], d["hinge_offset"], d["mid_stroke_height"]
    NJ, Nk = d["wing_count"] * d["wing_inertia"], d["wing_count"] * d["stiffness"]
    half_rho_S2, half_rho_S3, C_alpha = 0.5 * d["air_density"] * d["s2"], 0.5 * d["air_density"] * d["s3"], d["pitch"]
    L0, L1, L2, L3 = (d["lift%d" % n] for n in range(4))
    D0, D1, D2, D3 = (d["drag%d" % n] for n in range(4))
    rod_force = d["rod_force"] > 0.5
    sin, cos, sqrt, atan = math.sin, math.cos, math.sqrt, math.atan
    ratio = r_c / l
    half_pi = 0.5 * math.pi
    w_scale, i_scale, t_scale, lift_scale, charge_scale = scale

    def rates(u, theta):
        omega, i = u[0] * w_scale, u[1] * i_scale
        s, c = sin(theta), cos(theta)
        sin_g = ratio * c
        cos_g = sqrt(1.0 - sin_g * sin_g)
        tan_g = sin_g / cos_g
        dy = r_c * (c + s * tan_g)
        ddy = r_c * (c * tan_g - s - ratio * s * s / cos_g ** 3)
        tan_b = (r_c * s + l * cos_g - y_0) / H
        cos2_b = 1.0 / (1.0 + tan_b * tan_b)
        B1 = dy / H * cos2_b
        B2 = ddy / H * cos2_b - 2.0 * tan_b * B1 * B1
        g = H * (sin_g * tan_b + cos_g) if rod_force else H * cos_g / cos2_b
        h = cos_g * dy

        beta_rate = B1 * omega
        alpha = half_pi - C_alpha * abs(beta_rate)
        M_aero = half_rho_S3 * (D0 + D1 * cos(D2 * alpha + D3)) * beta_rate * abs(beta_rate)
        lift = half_rho_S2 * (L0 + L1 * sin(L2 * alpha + L3)) * beta_rate * beta_rate
        drive = K * i - b * omega - T_c
        A = NJ * B1 / g
        C = (NJ * B2 * omega * omega + M_aero + (Nk * atan(tan_b) if Nk > 0.0 else 0.0)) / g
        sign = 1.0 if J * C + A * drive >= 0.0 else -1.0
        lever = h + sign * mu_r
        omega_rate = (drive - C * lever) / (J + A * lever)
        dt = 1.0 / omega
        return (omega_rate * dt / w_scale, (v - R_a * i - K * omega) / L_a * dt / i_scale, dt / t_scale,
                lift * dt / lift_scale, i * dt / charge_scale)

    return rates


def steady(d, rtol):
    v, K, R_a = d["voltage"], d["torque_constant"], d["resistance"]
    w = 0.6 * K * v / (K * K + R_a * d["damping"])
    iterate_time = 2.0 * math.pi / w
    beta_rate = d["crank_radius"] / d["hinge_offset"] * w
    scale = (w, v / R_a, iterate_time, 0.5 * d["air_density"] * d["s2"] * beta_rate ** 2 * iterate_time, v / R_a * iterate_time)
    rates = rates_of(d, scale)
    ends = [-0.5 * math.pi, 1.5 * math.pi]
    u, tolerance = [1.0, 1.0 - K * w / v, 0.0, 0.0, 0.0], max(COARSE, rtol)
    for _ in range(LAPS):
        end = odeint(rates, u, ends, rtol=tolerance, atol=tolerance, mxstep=100000)[-1]
        change = max(abs(end[0] - u[0]) / end[0], abs(end[1] - u[1]))
        if tolerance > rtol:
            if change < 3e-2:
                tolerance = rtol
        elif change < PERIODIC:
            break
        u = [end[0], end[1], 0.0, 0.0, 0.0]
    else:
        return math.nan, math.nan, math.nan
    period = end[2] * scale[2]
    return end[3] * scale[3] / period, v * end[4] * scale[4] / period, 1.0 / period


def main():
    warnings.simplefilter("ignore")
    rtol = float(sys.argv[2])
    with open(sys.argv[1], newline="") as file:
        designs = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
    for d in designs:
        start = time.process_time()
        lift, power, frequency = steady(d, rtol)
        print("%.17g %.17g %.17g %.9g" % (lift, power, frequency, time.process_time() - start))


if __name__ == "__main__":
    main()
