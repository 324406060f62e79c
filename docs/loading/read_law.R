# contact <- read_law("rubber.nc");  contact(kappa, mu, V, slip)      slip = omega - V
# With ncdf4, which gives arrays as [power, octave].
library(ncdf4)

read_law <- function(path) {
  file <- nc_open(path)
  read <- function(names) sapply(names, function(name) ncvar_get(file, name, collapse_degen = FALSE),
                                      simplify = FALSE)
  names <- c("lam", "epsilon", "m_half_space", "m_cylinder", "N", "share", "press")
  if ("limits" %in% names(file$var)) {
    # A layer: shear acts back on the pressure, and N is not known.
    law <- read(c("e0", "limits"))
    ends <- law$limits
    law$alpha <- ends[1]^-2
    law$fast_limit <- rbind(c(0, 0, 0), c(4 * ends[9], 8 * ends[18], 8 * ends[19]))
    law$c <- read(names[-5])
    law$c$N <- NaN * law$c$lam
    law$c <- law$c[names]
    law$shear <- read(c("limit", "free_half_space", "free_cylinder", "excess_half_space", "excess_cylinder", "lam_Q",
                        "epsilon_Q"))
  } else {
    law <- read(c("e0", "alpha", "fast_limit"))
    law$c <- read(names)
  }
  nc_close(file)
  function(kappa, mu, V, slip) contact_state(law, kappa, mu, V, slip)
}

# Row 0 is that of the slow end.
place <- function(law, x) {
  e <- if (x > 0) floor(log2(x)) + 1 else law$e0
  if (e <= law$e0) return(list(row = 0, t = x * 2^-law$e0, dt_dx = 2^-law$e0))
  t <- 4 * (x / 2^e) - 3
  list(row = e - law$e0, t = t, dt_dx = (t + 3) / x)
}
value <- function(law, name, p) sum(law$c[[name]][, p$row + 1] * p$t^(0:23))
fast <- function(law, p) p$row >= ncol(law$c$lam)

speed <- function(law, u) {
  p <- place(law, u)
  if (!fast(law, p)) return(sapply(names(law$c)[1:5], function(name) value(law, name, p)))
  z <- 0.5 / (u * sqrt(law$alpha))
  half <- 0.5 * law$alpha * z
  W <- law$fast_limit[1, ]
  C <- law$fast_limit[2, ]
  m <- half * z * (C - W * (log(z) - 0.25))
  e <- law$limits
  if (!is.null(e))
    return(c(lam = e[2] + e[10] / u, epsilon = e[17] / u, m_half_space = m[2], m_cylinder = m[3], N = NaN))
  c(lam = law$alpha^-0.5, epsilon = half * (C[1] - W[1] * log(z)), m_half_space = m[2], m_cylinder = m[3],
    N = 0.25 * (law$alpha - 1) * z^2)
}

# Of a layer: L, f and g of half-space and cylinder, slopes of lam and epsilon in Q.
shear <- function(law, u) {
  p <- place(law, u)
  if (!fast(law, p)) return(unname(sapply(law$shear, function(c) sum(c[, p$row + 1] * p$t^(0:23)))))
  n <- c(1, 3:8)
  law$limits[n] + law$limits[n + 8] / u
}

stick <- function(law, v) {
  p <- place(law, v)
  if (!fast(law, p)) return(c(value(law, "share", p), value(law, "press", p)))
  share <- 1 - 0.5 * law$alpha / v * (law$fast_limit[2, 1] + law$fast_limit[1, 1] * log(v))
  press <- law$alpha * share^2
  e <- law$limits
  if (!is.null(e)) share <- e[2] / e[1] + 2 * (e[10] * e[1] - e[2] * e[9]) / e[1]^3 / v
  c(share, press)
}

# Mean slope of press between v1 and v2.
secant <- function(law, v1, v2) {
  a <- place(law, v1)
  b <- place(law, v2)
  if (fast(law, b)) {
    W <- law$fast_limit[1, 1]
    C <- law$fast_limit[2, 1]
    x <- (v2 - v1) / v1
    shares <- 2 - 0.5 * law$alpha * ((C + W * log(v1)) / v1 + (C + W * log(v2)) / v2)
    return(0.5 * law$alpha^2 * shares * (C - W * ((if (x > 0) log1p(x) / x else 1) - log(v1))) / v1 / v2)
  }
  if (a$row == b$row) return(chord(law, a, b$t) * a$dt_dx)
  part <- min(max((2^(law$e0 + b$row - 1) - v1) / (v2 - v1), 0), 1)
  part * chord(law, a, 1) * a$dt_dx + (1 - part) * chord(law, b, -1) * b$dt_dx
}
chord <- function(law, p, s) {
  total <- last <- law$c$press[24, p$row + 1]
  for (k in 23:2) {
    last <- last * p$t + law$c$press[k, p$row + 1]
    total <- total * s + last
  }
  total
}

# NaN where one of these is NaN or infinite, kappa or mu is not above 0, or kappa |V| is above 1e300.
contact_state <- function(law, kappa, mu, V, slip) {
  u <- kappa * abs(V)
  if (!isTRUE(kappa > 0 && mu > 0 && mu < Inf && u <= 1e300 && abs(slip) < Inf)) {
    names <- c("lam", "epsilon", "delta_star", "beta", "Q", "M", "M_half_space", "M_cylinder", "N")
    return(as.list(setNames(rep(NaN, 9), names)))
  }
  f <- as.list(speed(law, u))
  h <- if (is.null(law$limits)) c(f$lam * (1 + f$epsilon), 0, 0, 0, 0, 0, 0) else shear(law, u)
  L <- h[1]
  creepage <- if (slip == 0) 0 else if (V == 0) sign(slip) * Inf else slip / V
  own <- creepage - 0.5 * (h[2] + h[3]) / kappa
  delta <- abs(own)
  delta_star <- 0.5 * mu * L / kappa
  # The onsets of full slip of a layer lie unlike far from free rolling.
  excess <- 2 * (h[4] + h[5]) / (mu * L)
  c <- -sign(own) * excess / (1 + (2 * excess)^6)
  D <- 4 * kappa * delta / mu / (1 + sqrt(max(1 + 4 * c * delta / delta_star, 0)))
  w <- L - D
  beta <- 0
  used <- 1
  if (delta < delta_star * (1 + c) && w > 0) {
    at <- stick(law, 2 * u / w)
    q <- if (D < L / 8) D * ((2 * L - D) * at[2] - 2 * u * L / w * secant(law, 2 * u / L, 2 * u / w)) else 1 - w^2 * at[2]
    beta <- min(at[1] * w / f$lam, 1)
    used <- min(q, 1)
  }
  along <- sign(own) * mu * used
  Q <- if (V < 0) -along else along
  more <- used * (1 + excess^4)^-0.25
  Mh <- V * f$m_half_space - Q * (h[2] + more * h[4]) / (2 * kappa)
  Mc <- V * f$m_cylinder - Q * (h[3] + more * h[5]) / (2 * kappa + h[2] + h[3])
  list(lam = f$lam + h[6] * along, epsilon = f$epsilon + h[7] * along, delta_star = delta_star, beta = beta, Q = Q,
       M = Mh + Mc, M_half_space = Mh, M_cylinder = Mc, N = f$N)
}
