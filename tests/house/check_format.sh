#!/usr/bin/env bash
# Every C++ file that git tracks is as clang-format leaves it. Exit code 77: cannot tell here.
# usage: check_format.sh SOURCE_ROOT
set -euo pipefail
cd "$1"
command -v clang-format >/dev/null || { echo "skipped: no clang-format"; exit 77; }
git rev-parse --git-dir >/dev/null 2>&1 || { echo "skipped: not a git checkout"; exit 77; }

mapfile -t bad < <(git ls-files -z '*.h' '*.cpp' | xargs -0 clang-format --dry-run 2>&1 |
                   sed -n 's/^\([^:]*\):[0-9]*:[0-9]*: warning: .*/\1/p' | sort -u)
wait $!  # what could not be read is no success
[ ${#bad[@]} -gt 0 ] || exit 0
printf '%d files are not formatted:\n' ${#bad[@]}
printf '  %s\n' "${bad[@]}"
echo "put right by: clang-format -i ${bad[*]}"
exit 1
