#!/bin/sh
# The contact of a cylinder at the nodes of paper.nc, by ncdump alone.
#
#     sh read_tables.sh [TABLES [CHECKS]]         default: data/tables docs/loading
#
# ncdump -h shows what a file is; -v NAME the values of a variable, the last dimension fastest.
# Exit code 1 where a check state that is a node is further from its check value than is stated there.

tables=${1:-data/tables} checks=${2:-docs/loading}
ncdump -h "$tables/atlas.nc" && ncdump -h "$tables/paper.nc" || exit 2

# one number a line, after the name of its variable
values() { ncdump -p 9,17 -v "$1" "$tables/paper.nc" | sed '1,/^data:/d; s/[,;}]/ /g' | tr -s ' ' '\n' | sed '/^$/d; /^=$/d'; }

{ values V,delta,alpha,beta,Q,M; echo end; cat "$checks/check_paper.csv"; } | awk -F, '
  function difference(x, y) { return x > y ? x - y : y - x }
  function node(name, x,    n) {
    for (n = 0; n < size[name]; n++) if (difference(x, value[name, n]) <= 1e-12 * difference(x, 0)) return n
    return -1
  }
  function wrong(name, index_, exact, allowed) {
    printf " %s %.9f", name, value[name, index_]
    return difference(value[name, index_], exact) > allowed
  }
  $1 == "end" { rows = 1; getline; next }
  !rows && /^[A-Za-z]/ { name = $1; next }
  !rows { value[name, size[name]++] = $1 + 0; next }
  {
    v = node("V", $4); d = node("delta", $5); a = node("alpha", $1)
    if (v < 0 || d < 0 || a < 0) next
    printf "paper %s %s %s %s %s:", $1, $2, $3, $4, $5
    volume = (v * size["delta"] + d) * size["alpha"] + a
    bad = wrong("beta", volume, $6, $9) + wrong("Q", volume, $7, $10) + wrong("M", v * size["alpha"] + a, $8, $11)
    print bad ? " WRONG" : " ok"
    states++; failed += bad
  }
  END { exit failed || !states }'
