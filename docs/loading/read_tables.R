# The contact of a cylinder from atlas.nc and paper.nc, in R with ncdf4.
#
#     Rscript read_tables.R [TABLES [CHECKS]]         default: data/tables docs/loading
#
# ncdf4 gives the dimensions reversed: Q[alpha, delta, V].
# Exit code 1 where a value is further from its check value than is stated there.

library(ncdf4)

read_table <- function(path) {
  file <- nc_open(path)
  names <- c(names(file$dim), names(file$var))
  table <- sapply(unique(names), function(name) ncvar_get(file, name), simplify = FALSE)
  nc_close(file)
  table
}

# The polynomial through the six nodes around x, which are evenly spaced: which nodes, and their weights.
six_points <- function(nodes, x) {
  position <- (x - nodes[1]) / (nodes[length(nodes)] - nodes[1]) * (length(nodes) - 1)
  first <- max(0, min(floor(position) - 2, length(nodes) - 6))
  weight <- sapply(0:5, function(k) prod((position - first - setdiff(0:5, k)) / (k - setdiff(0:5, k))))
  list(which = first + 1:6, weight = weight)
}

# Linear between the two nodes around x.
two_points <- function(nodes, x) {
  first <- findInterval(x, nodes, all.inside = TRUE)
  share <- (x - nodes[first]) / (nodes[first + 1] - nodes[first])
  list(which = first + 0:1, weight = c(1 - share, share))
}

look_up <- function(values, a, b, c = NULL) {
  if (is.null(c)) return(sum(values[a$which, b$which, drop = FALSE] * outer(a$weight, b$weight)))
  sum(values[a$which, b$which, c$which, drop = FALSE] * outer(outer(a$weight, b$weight), c$weight))
}

u_of_s <- function(s) 1 - sqrt(1 - s)

# For any kappa and mu: the steps of README.md.
from_atlas <- function(t, x) {
  a <- six_points(log(t$alpha), log(x$alpha))
  v <- six_points(log(t$kappa_V), log(x$kappa * abs(x$V)))
  s <- abs(x$delta) / (x$mu / x$kappa * look_up(t$kappa_delta_star_over_mu, v, a))
  u <- six_points(u_of_s(t$s), u_of_s(min(s, 1)))
  beta <- if (s < 1) look_up(t$beta, u, v, a) else 0
  Q <- if (s < 1) x$mu * look_up(t$Q_over_mu, u, v, a) else x$mu
  c(beta, sign(x$delta * x$V) * Q, sign(x$V) * look_up(t$kappa_M, v, a) / x$kappa)
}

# At the kappa and mu of the file and one of its alphas.
from_paper <- function(t, x) {
  a <- list(which = match(x$alpha, t$alpha), weight = 1)
  v <- two_points(t$V, abs(x$V))
  d <- two_points(t$delta, x$delta)
  c(look_up(t$beta, a, d, v), sign(x$V) * look_up(t$Q, a, d, v), sign(x$V) * look_up(t$M, a, v))
}

check <- function(tables, checks, name, contact) {
  table <- read_table(file.path(tables, paste0(name, ".nc")))
  rows <- read.csv(file.path(checks, paste0("check_", name, ".csv")))
  good <- sapply(seq_len(nrow(rows)), function(n) {
    x <- rows[n, ]
    found <- contact(table, x)
    ok <- all(abs(found - unlist(x[c("beta", "Q", "M")])) <= unlist(x[c("allowed_beta", "allowed_Q", "allowed_M")]))
    cat(sprintf("%s %g %g %g %g %g: beta %.9f Q %.9f M %.9f %s\n", name, x$alpha, x$kappa, x$mu, x$V, x$delta,
                found[1], found[2], found[3], if (ok) "ok" else "WRONG"))
    ok
  })
  all(good)
}

given <- commandArgs(trailingOnly = TRUE)
folders <- c("data/tables", "docs/loading")
folders[seq_along(given)] <- given
passed <- c(check(folders[1], folders[2], "atlas", from_atlas), check(folders[1], folders[2], "paper", from_paper))
quit(status = if (all(passed)) 0 else 1)
