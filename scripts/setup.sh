#!/usr/bin/env bash
# setup.sh [--to-use] [PACKAGE...]: installs the Debian packages of scripts/packages.txt, and these, that are not there yet;
# with --to-use not those that are only to check changes. Asks no questions; as a user other than root it calls sudo.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
last='$'
if [ "${1:-}" = --to-use ]; then
  last='/^# ONLY TO CHECK/'
  shift
fi
mapfile -t wanted < <(sed -n "1,${last}p" "$here/packages.txt" | sed -e 's/#.*//' -e 's/[[:space:]]//g' -e '/^$/d')
wanted+=("$@")

if ! command -v apt-get >/dev/null; then
  echo "setup: found no apt-get; this script knows Debian 12 only. Install what" \
    "scripts/packages.txt lists with your own package manager" >&2
  exit 5
fi
missing=()
for package in "${wanted[@]}"; do
  status=$(dpkg-query -W -f='${Status}' "$package" 2>/dev/null || true)
  [ "$status" = "install ok installed" ] || missing+=("$package")
done
if [ ${#missing[@]} -eq 0 ]; then
  echo "setup: all ${#wanted[@]} packages are there"
  exit 0
fi
as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "setup: ${#missing[@]} packages are missing and there is no sudo; run this as root" >&2
    exit 2
  fi
  as_root=(sudo)
fi
echo "setup: installing ${missing[*]}"
apt() { "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -o Acquire::Retries=3 "$@"; }
apt update
apt install -y --no-install-recommends "${missing[@]}" >/dev/null
