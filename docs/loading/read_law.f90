! type(law) :: rubber;  rubber = read_law('rubber.nc');  s = contact(rubber, kappa, mu, V, slip)      slip = omega - V
! gfortran -c read_law.f90 $(nf-config --fflags);  link with $(nf-config --flibs).  Arrays come as (power, octave).
module read_law_file
  use netcdf
  use, intrinsic :: ieee_arithmetic, only: ieee_is_finite, ieee_quiet_nan, ieee_value
  implicit none
  type law
    integer :: e0, rows
    real(8) :: alpha, limit(2, 3)
    real(8), allocatable :: c(:, :, :) ! power, octave, function
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
    character(12), parameter :: names(7) = [character(12) :: 'lam', 'epsilon', 'm_half_space', 'm_cylinder', 'N', 'share', 'press']
    type(law) :: a
    integer :: file, id, n
    call check(nf90_open(path, nf90_nowrite, file))
    call check(nf90_inq_dimid(file, 'octave', id))
    call check(nf90_inquire_dimension(file, id, len=a%rows))
    allocate(a%c(0:23, 0:a%rows - 1, 7))
    do n = 1, 7
      call check(nf90_inq_varid(file, trim(names(n)), id))
      call check(nf90_get_var(file, id, a%c(:, :, n)))
    end do
    call check(nf90_inq_varid(file, 'e0', id))
    call check(nf90_get_var(file, id, a%e0))
    call check(nf90_inq_varid(file, 'alpha', id))
    call check(nf90_get_var(file, id, a%alpha))
    call check(nf90_inq_varid(file, 'fast_limit', id))
    call check(nf90_get_var(file, id, a%limit))
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
    real(8) :: u, f(7), z, L, delta, D, w, r, turn
    integer :: k
    u = kappa*abs(V)
    if (.not. (kappa > 0 .and. mu > 0 .and. ieee_is_finite(mu) .and. u <= 1d300 .and. ieee_is_finite(slip))) then
      z = ieee_value(z, ieee_quiet_nan)
      s = state(z, z, z, z, z, z, z, z, z)
      return
    end if
    turn = merge(0d0, sign(1d0, slip), slip == 0)
    p = at(a, u)
    if (p%row < a%rows) then
      f = [(value(a%c(:, p%row, k), p%t), k=1, 7)]
    else
      z = 0.5d0/(u*sqrt(a%alpha))
      f(1) = 1/sqrt(a%alpha)
      f(2) = a%alpha/2*z*(a%limit(2, 1) - a%limit(1, 1)*log(z))
      f(3:4) = a%alpha/2*z*z*(a%limit(2, 2:3) - a%limit(1, 2:3)*(log(z) - 0.25d0))
      f(5) = (a%alpha - 1)/4*z*z
    end if
    L = f(1)*(1 + f(2))
    delta = 0
    if (slip /= 0) delta = abs(slip/V)
    D = 2*kappa*delta/mu
    w = L - D
    s = state(f(1), f(2), mu*L/(2*kappa), 0d0, turn*mu, V*(f(3) + f(4)), V*f(3), V*f(4), f(5))
    if (.not. (delta < s%delta_star .and. w > 0)) return
    p = at(a, 2*u/w)
    if (p%row < a%rows) then
      f(6:7) = [value(a%c(:, p%row, 6), p%t), value(a%c(:, p%row, 7), p%t)]
    else
      f(6) = 1 - a%alpha/2*w/(2*u)*(a%limit(2, 1) + a%limit(1, 1)*log(2*u/w))
      f(7) = a%alpha*f(6)**2
    end if
    r = 1 - w*w*f(7)
    if (D < L/8) r = D*((2*L - D)*f(7) - 2*u*L/w*secant(a, 2*u/L, 2*u/w))
    s%beta = min(f(6)*w/f(1), 1d0)
    s%Q = turn*mu*min(r, 1d0)
  end function
end module
