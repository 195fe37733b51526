#!/bin/bash
# Makes an update of what seal.sh wrote. Usage: bundle.sh SEALED VERSION KEYS UPDATE.raucb.
set -euo pipefail
sealed=$(realpath "$1")
keys=$(realpath "$3")
out=$(realpath -m "$4")
work=$(mktemp -d "$(dirname "$out")/bundle-XXXXXX")
trap 'rm -rf "$work"' EXIT
mkdir "$work/in"
ln "$sealed/root.img" "$work/in/root.img" 2>/dev/null || cp "$sealed/root.img" "$work/in/root.img"
cp "$sealed/prismesh.efi" "$work/in/"
cp "$(dirname "$0")/hook" "$work/in/hook"
echo "$2" >"$work/in/version"
cat >"$work/in/manifest.raucm" <<MANIFEST
[update]
compatible=prismesh-station
version=$2

[bundle]
format=verity

[hooks]
filename=hook

[image.rootfs]
filename=root.img
hooks=post-install
MANIFEST
rm -f "$out"
# The root is packed already.
rauc bundle --cert="$keys/update.crt" --key="$keys/update.key" --mksquashfs-args='-comp zstd -Xcompression-level 1 -noD -no-progress' "$work/in" "$out" >"$work/log" 2>&1 ||
  { cat "$work/log" >&2; exit 1; }
