#!/bin/bash
# Makes a disk image and its update. Usage: make.sh BASE.tar PACKAGES VERSION KEYS FOLDER. Writes FOLDER/prismesh.img, FOLDER/prismesh-VERSION.raucb,
# and FOLDER/sealed. Needs root and SOURCE_DATE_EPOCH.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$5"
out=$(realpath "$5")
work=$(mktemp -d "$out/make-XXXXXX")
trap 'rm -rf "$work"' EXIT
"$here/keys.sh" "$4"
"$here/tree.sh" "$1" "$2" "$3" "$4" "$work/root"
python3 "$here/../../tests/image/audit.py" "$work/root" "$here/allowed.txt"
rm -rf "$out/sealed"
"$here/seal.sh" "$work/root" "$4" "$out/sealed"
"$here/disk.sh" "$out/sealed" "$3" "$4" "$out/prismesh.img"
"$here/bundle.sh" "$out/sealed" "$3" "$4" "$out/prismesh-$3.raucb"
