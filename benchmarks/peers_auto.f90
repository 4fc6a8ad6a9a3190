! Steady flapping as a periodic boundary-value problem for AUTO-07p, continued in voltage; docs/model.md section 2.
!
! Unknowns over one iterate from the lower dead centre, each divided by its scale: crank speed, current, time, lift impulse,
! charge; and the iterate's fraction, because FUNC is not given its position. benchmark_peers writes design.txt (the vehicle's
! numbers and the scales), start.txt (one iterate of the orbit at the first voltage) and AUTO's constants, and builds this.
module vehicle
  implicit none
  integer, parameter :: rows = 201
  double precision, parameter :: pi = 3.14159265358979324d0
  double precision :: voltage, R_a, L_a, K_m, J_m, b_m, T_c, r_c, l_r, H_w, y_0, rod_force, mu_r, k_s, N_w, J_w
  double precision :: rho, C_alpha, S_2, S_3, lift(4), drag(4), scale(5), start(6, rows)
  logical :: loaded = .false.
contains
  subroutine load()
    if (loaded) return
    open(unit=31, file='design.txt', status='old')
    read(31, *) voltage, R_a, L_a, K_m, J_m, b_m, T_c, r_c, l_r, H_w, y_0, rod_force, mu_r, k_s, N_w, J_w, &
                rho, C_alpha, S_2, S_3, lift, drag, scale
    close(31)
    open(unit=31, file='start.txt', status='old')
    read(31, *) start
    close(31)
    loaded = .true.
  end subroutine load
end module vehicle

subroutine func(ndim, u, icp, par, ijac, f, dfdu, dfdp)
  use vehicle
  implicit none
  integer, intent(in) :: ndim, icp(*), ijac
  double precision, intent(in) :: u(ndim), par(*)
  double precision, intent(out) :: f(ndim)
  double precision, intent(inout) :: dfdu(ndim, ndim), dfdp(ndim, *)
  double precision :: w, i, v, s, c, sin_g, cos_g, tan_g, dy, ddy, tan_b, cos2_b, B1, B2, g, h, rate, alpha, M_aero, &
                      L_aero, drive, A, C_f, lever, w_rate, per_iterate

  call load()
  v = par(1)
  w = u(1) * scale(1)
  i = u(2) * scale(2)
  s = sin(2 * pi * u(6) - pi / 2)
  c = cos(2 * pi * u(6) - pi / 2)
  sin_g = r_c / l_r * c
  cos_g = sqrt(1 - sin_g**2)
  tan_g = sin_g / cos_g
  dy = r_c * (c + s * tan_g)
  ddy = r_c * (c * tan_g - s - r_c / l_r * s**2 / cos_g**3)
  tan_b = (r_c * s + l_r * cos_g - y_0) / H_w
  cos2_b = 1 / (1 + tan_b**2)
  B1 = dy / H_w * cos2_b
  B2 = ddy / H_w * cos2_b - 2 * tan_b * B1**2
  if (rod_force > 0.5d0) then
    g = H_w * (sin_g * tan_b + cos_g)
  else
    g = H_w * cos_g / cos2_b
  end if
  h = cos_g * dy

  rate = B1 * w
  alpha = pi / 2 - C_alpha * abs(rate)
  M_aero = 0.5d0 * rho * S_3 * (drag(1) + drag(2) * cos(drag(3) * alpha + drag(4))) * rate * abs(rate)
  L_aero = 0.5d0 * rho * S_2 * (lift(1) + lift(2) * sin(lift(3) * alpha + lift(4))) * rate**2
  drive = K_m * i - b_m * w - T_c
  A = N_w * J_w * B1 / g
  C_f = (N_w * J_w * B2 * w**2 + M_aero) / g
  if (k_s > 0) C_f = C_f + N_w * k_s * atan(tan_b) / g
  lever = h + sign(mu_r, J_m * C_f + A * drive)
  w_rate = (drive - C_f * lever) / (J_m + A * lever)

  per_iterate = 2 * pi / w
  f(1) = w_rate * per_iterate / scale(1)
  f(2) = (v - R_a * i - K_m * w) / L_a * per_iterate / scale(2)
  f(3) = per_iterate / scale(3)
  f(4) = L_aero * per_iterate / scale(4)
  f(5) = i * per_iterate / scale(5)
  f(6) = 1
end subroutine func

subroutine stpnt(ndim, u, par, t)
  use vehicle
  implicit none
  integer, intent(in) :: ndim
  double precision, intent(inout) :: u(ndim), par(*)
  double precision, intent(in) :: t
  integer :: row
  double precision :: part

  call load()
  par(1) = voltage
  row = min(int(t * (rows - 1)) + 1, rows - 1)
  part = t * (rows - 1) - (row - 1)
  u = (1 - part) * start(:, row) + part * start(:, row + 1)
end subroutine stpnt

subroutine bcnd(ndim, par, icp, nbc, u0, u1, fb, ijac, dbc)
  implicit none
  integer, intent(in) :: ndim, icp(*), nbc, ijac
  double precision, intent(in) :: par(*), u0(ndim), u1(ndim)
  double precision, intent(out) :: fb(nbc)
  double precision, intent(inout) :: dbc(nbc, *)
  fb(1:2) = u1(1:2) - u0(1:2)
  fb(3:6) = u0(3:6)
end subroutine bcnd

subroutine icnd(ndim, par, icp, nint, u, uold, udot, upold, fi, ijac, dint)
  implicit none
  integer, intent(in) :: ndim, icp(*), nint, ijac
  double precision, intent(in) :: par(*), u(ndim), uold(ndim), udot(ndim), upold(ndim)
  double precision, intent(out) :: fi(nint)
  double precision, intent(inout) :: dint(nint, *)
end subroutine icnd

subroutine fopt(ndim, u, icp, par, ijac, fs, dfdu, dfdp)
  implicit none
  integer, intent(in) :: ndim, icp(*), ijac
  double precision, intent(in) :: u(ndim), par(*)
  double precision, intent(out) :: fs
  double precision, intent(inout) :: dfdu(ndim), dfdp(*)
  fs = 0
end subroutine fopt

! Mean lift [N], mean electrical power [W] and frequency [Hz] stand beside every point.
subroutine pvls(ndim, u, par)
  use vehicle
  implicit none
  integer, intent(in) :: ndim
  double precision, intent(in) :: u(ndim)
  double precision, intent(inout) :: par(*)
  double precision, external :: getp
  double precision :: period

  period = getp('BV1', 3, u) * scale(3)
  par(2) = getp('BV1', 4, u) * scale(4) / period
  par(3) = par(1) * getp('BV1', 5, u) * scale(5) / period
  par(4) = 1 / period
end subroutine pvls
