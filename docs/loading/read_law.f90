! type(law) :: rubber;  rubber = read_law('rubber.nc');  s = contact(rubber, kappa, mu, V, slip)      slip = omega - V
! gfortran -c read_law.f90 $(nf-config --fflags);  link with $(nf-config --flibs).  Arrays come as (power, octave).
module read_law_file
  use netcdf
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite, ieee_quiet_nan, ieee_value
  implicit none
  type law
    integer :: e0, rows
    real(8) :: alpha, limit(2, 3), ends(0:18)
    real(8), allocatable :: c(:, :, :) ! power, octave, function
    logical :: layer ! of finite thickness: shear acts back on the pressure, and N is not known
  end type
  type state
    real(8) :: lam, epsilon, delta_star, beta, Q, M, M_half_space, M_cylinder, N
  end type
  type place
    integer :: row
    real(8) :: t, dt_dx
  end type
contains
  subroutine check(status)
    integer, intent(in) :: status
    if (status /= nf90_noerr) error stop 'not read: no law file, or none of netCDF'
  end subroutine

  function read_law(path) result(a)
    character(*), intent(in) :: path
    character(17), parameter :: names(14) = [character(17) :: 'lam', 'epsilon', 'm_half_space', 'm_cylinder', 'N', &
      'share', 'press', 'limit', 'free_half_space', 'free_cylinder', 'excess_half_space', 'excess_cylinder', 'lam_Q', &
      'epsilon_Q']
    type(law) :: a
    integer :: file, id, n
    call check(nf90_open(path, nf90_nowrite, file))
    call check(nf90_inq_dimid(file, 'octave', id))
    call check(nf90_inquire_dimension(file, id, len=a%rows))
    a%layer = nf90_inq_varid(file, 'limits', id) == nf90_noerr
    if (a%layer) call check(nf90_get_var(file, id, a%ends))
    allocate(a%c(0:23, 0:a%rows - 1, 14))
    a%c = 0
    do n = 1, merge(14, 7, a%layer)
      if (a%layer .and. n == 5) cycle
      call check(nf90_inq_varid(file, trim(names(n)), id))
      call check(nf90_get_var(file, id, a%c(:, :, n)))
    end do
    call check(nf90_inq_varid(file, 'e0', id))
    call check(nf90_get_var(file, id, a%e0))
    if (a%layer) then
      a%alpha = 1/a%ends(0)**2
      a%limit = 0
      a%limit(2, :) = [4*a%ends(8), 8*a%ends(17), 8*a%ends(18)]
    else
      call check(nf90_inq_varid(file, 'alpha', id))
      call check(nf90_get_var(file, id, a%alpha))
      call check(nf90_inq_varid(file, 'fast_limit', id))
      call check(nf90_get_var(file, id, a%limit))
    end if
    call check(nf90_close(file))
  end function

  pure type(place) function at(a, x) result(p) ! row 0 is that of the slow end
    type(law), intent(in) :: a
    real(8), intent(in) :: x
    p%row = exponent(x) - a%e0
    if (p%row <= 0 .or. x == 0) then
      p = place(0, scale(x, -a%e0), scale(1d0, -a%e0))
    else
      p%t = 4*fraction(x) - 3
      p%dt_dx = (p%t + 3)/x
    end if
  end function

  pure real(8) function value(c, t)
    real(8), intent(in) :: c(0:23), t
    integer :: k
    value = c(23)
    do k = 22, 0, -1
      value = value*t + c(k)
    end do
  end function

  pure real(8) function chord(c, t, s) result(total) ! (p(t) - p(s))/(t - s)
    real(8), intent(in) :: c(0:23), t, s
    real(8) :: last
    integer :: k
    last = c(23)
    total = last
    do k = 22, 1, -1
      last = last*t + c(k)
      total = total*s + last
    end do
  end function

  pure real(8) function secant(a, v1, v2) result(S) ! mean slope of press between v1 and v2
    type(law), intent(in) :: a
    real(8), intent(in) :: v1, v2
    type(place) :: p, q
    real(8) :: x, ratio, part
    p = at(a, v1)
    q = at(a, v2)
    if (q%row >= a%rows) then
      x = (v2 - v1)/v1
      ratio = 1
      if (x > 0) ratio = log(1 + x)/x
      if (x < 1d-3) ratio = 1 - x/2 + x*x/3 - x**3/4 + x**4/5
      associate (W => a%limit(1, 1), C => a%limit(2, 1))
        S = 2 - a%alpha/2*((C + W*log(v1))/v1 + (C + W*log(v2))/v2)
        S = a%alpha**2/2*S*(C - W*(ratio - log(v1)))/v1/v2
      end associate
    else if (p%row == q%row) then
      S = chord(a%c(:, p%row, 7), p%t, q%t)*p%dt_dx
    else
      part = min(max((scale(1d0, a%e0 + q%row - 1) - v1)/(v2 - v1), 0d0), 1d0)
      S = part*chord(a%c(:, p%row, 7), p%t, 1d0)*p%dt_dx + (1 - part)*chord(a%c(:, q%row, 7), q%t, -1d0)*q%dt_dx
    end if
  end function

  ! NaN where one of these is NaN or infinite, kappa or mu is not above 0, or kappa |V| is above 1e300
  pure type(state) function contact(a, kappa, mu, V, slip) result(s)
    type(law), intent(in) :: a
    real(8), intent(in) :: kappa, mu, V, slip
    type(place) :: p
    real(8) :: u, f(7), h(7), z, L, own, delta, star, excess, c, D, w, used, along, share, more, beta, Q, Mh, Mc
    integer :: k
    u = kappa*abs(V)
    if (.not. (kappa > 0 .and. mu > 0 .and. ieee_is_finite(mu) .and. u <= 1d300 .and. ieee_is_finite(slip))) then
      z = ieee_value(z, ieee_quiet_nan)
      s = state(z, z, z, z, z, z, z, z, z)
      return
    end if
    p = at(a, u)
    h = 0
    if (p%row < a%rows) then
      f = [(value(a%c(:, p%row, k), p%t), k=1, 7)]
      if (a%layer) h = [(value(a%c(:, p%row, k), p%t), k=8, 14)]
    else
      z = 0.5d0/(u*sqrt(a%alpha))
      f(1) = 1/sqrt(a%alpha)
      f(2) = a%alpha/2*z*(a%limit(2, 1) - a%limit(1, 1)*log(z))
      f(3:4) = a%alpha/2*z*z*(a%limit(2, 2:3) - a%limit(1, 2:3)*(log(z) - 0.25d0))
      f(5) = (a%alpha - 1)/4*z*z
      if (a%layer) then
        f(1:2) = [a%ends(1) + a%ends(9)/u, a%ends(16)/u]
        h = [a%ends(0) + a%ends(8)/u, a%ends(2:7) + a%ends(10:15)/u]
      end if
    end if
    L = merge(h(1), f(1)*(1 + f(2)), a%layer)
    if (a%layer) f(5) = ieee_value(z, ieee_quiet_nan)
    own = 0
    if (slip /= 0) own = slip/V ! at V = 0 infinite
    if (slip /= 0 .and. V == 0) own = sign(huge(own), slip)
    own = own - 0.5d0*(h(2) + h(3))/kappa
    delta = abs(own)
    star = mu*L/(2*kappa)
    excess = 2*(h(4) + h(5))/(mu*L)
    c = -sign(excess, excess*own)/(1 + (2*excess)**6) ! onsets of full slip lie unlike far from free rolling
    D = 4*kappa*delta/mu/(1 + sqrt(max(1 + 4*c*delta/star, 0d0)))
    w = L - D
    beta = 0
    used = 1
    if (delta < star*(1 + c) .and. w > 0) then
      p = at(a, 2*u/w)
      if (p%row < a%rows) then
        f(6:7) = [value(a%c(:, p%row, 6), p%t), value(a%c(:, p%row, 7), p%t)]
      else
        share = 1 - a%alpha/2*w/(2*u)*(a%limit(2, 1) + a%limit(1, 1)*log(2*u/w))
        f(6:7) = [share, a%alpha*share**2]
        if (a%layer) f(6) = a%ends(1)/a%ends(0) + 2*(a%ends(9)*a%ends(0) - a%ends(1)*a%ends(8))/a%ends(0)**3*w/(2*u)
      end if
      used = 1 - w*w*f(7)
      if (D < L/8) used = D*((2*L - D)*f(7) - 2*u*L/w*secant(a, 2*u/L, 2*u/w))
      used = min(used, 1d0)
      beta = min(f(6)*w/f(1), 1d0)
    end if
    along = merge(0d0, sign(mu*used, own), own == 0)
    Q = merge(-along, along, V < 0)
    more = used*(1 + excess**4)**(-0.25d0)
    Mh = V*f(3) - Q*(h(2) + more*h(4))/(2*kappa)
    Mc = V*f(4) - Q*(h(3) + more*h(5))/(2*kappa + h(2) + h(3))
    s = state(f(1) + h(6)*along, f(2) + h(7)*along, star, beta, Q, Mh + Mc, Mh, Mc, f(5))
  end function
end module
