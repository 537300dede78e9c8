#!/usr/bin/env bash
# release_schema.sh VERSION: keeps a copy of today's schema as that of a released format version, for the
# test that later schemas still read its packs. A version that is there already is not overwritten.
#
# Kinds that no tool writes yet may still change: of their tables only the names are kept.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
settled="common column_grid scene pack"
open_to_change="render object robot episodes world policy"

version=${1:-}
if ! [[ "$version" =~ ^[1-9][0-9]*$ ]]; then
  echo "release_schema: found the version \"$version\"; give a format version, for example 1" >&2
  exit 1
fi
target=$root/schema/released/v$version
if [ -e "$target" ]; then
  echo "release_schema: schema/released/v$version is there already, and a released schema does not" \
    "change; release the next version, or delete the folder if it was never released" >&2
  exit 3
fi
for file in "$root"/schema/*.fbs; do
  name=$(basename "$file" .fbs)
  case " $settled $open_to_change " in
    *" $name "*) ;;
    *)
      echo "release_schema: schema/$name.fbs is new; list it in this script as settled or open" >&2
      exit 3
      ;;
  esac
done
mkdir -p "$target"
for name in $settled; do
  cp "$root/schema/$name.fbs" "$target/"
done
for name in $open_to_change; do
  {
    echo "// Not settled in format version $version: names only."
    grep -E '^(include|namespace) ' "$root/schema/$name.fbs"
    sed -nE 's/^table ([A-Za-z0-9]+) .*/table \1 {}/p' "$root/schema/$name.fbs"
  } >"$target/$name.fbs"
done
echo "release_schema: wrote schema/released/v$version"
