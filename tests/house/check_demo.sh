#!/usr/bin/env bash
# tools/demo tells its story to the end and leaves nothing behind. Exit code 77: there is no bunny here.
# usage: check_demo.sh SOURCE_ROOT BUILD_FOLDER
set -euo pipefail
bunny=/usr/share/glmark2/models/bunny.obj
[ -f "$bunny" ] || { echo "skipped: glmark2-data is not installed"; exit 77; }

TMPDIR=$(mktemp -d)
export TMPDIR
trap 'rm -rf "$TMPDIR"' EXIT
"$1/tools/demo" --programs "$2" "$bunny" | tee "$TMPDIR.story"
story=$(<"$TMPDIR.story")
rm "$TMPDIR.story"
[ -z "$(ls -A "$TMPDIR")" ] || { echo "the demo left files behind"; exit 1; }
for word in 'first scan' 'a bump' 'read: ' 'the repository grew by'; do
  [[ $story == *"$word"* ]] || { echo "the demo did not get to: $word"; exit 1; }
done
