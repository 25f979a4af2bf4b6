#!/bin/bash
# level_symbols_test.sh NM NAMESPACE TABLES OBJECT…: what is compiled for a newer processor leaves
# nothing behind but its tables, so many, in the namespace of its level. Any other symbol, weak ones
# above all, could stand in for a function of the same name elsewhere in a program and stop it on an
# older processor.

set -euo pipefail
nm=$1 namespace=$2 expected=$3
shift 3
[ $# -gt 0 ] || { echo "no objects" >&2; exit 1; }

# Lower-case letters are local symbols, except u, v and w. Under AddressSanitizer every exported
# variable has a mark of one byte.
exported=$("$nm" --defined-only --format=posix "$@" |
  awk 'NF >= 2 && $2 ~ /[A-Zuvw]/ { print $2, $1 }' | sed '/ __odr_asan\./d')
tables=0
while read -r kind symbol; do
  case "$kind $symbol" in
    [TDR]\ _ZN9locograph${#namespace}${namespace}*) tables=$((tables + 1)) ;;
    *)
      echo "$kind $(c++filt "$symbol") leaves an object of $namespace" >&2
      exit 1
      ;;
  esac
done <<<"$exported"
[ "$tables" -eq "$expected" ] || { echo "$tables tables, expected $expected" >&2; exit 1; }
