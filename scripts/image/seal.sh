#!/bin/bash
# Seals a tree of tree.sh: FOLDER/root.img (squashfs, then the hash tree of dm-verity), FOLDER/root.hash, and FOLDER/prismesh.efi (kernel, initial
# disk and the command line that names the root's hash, in one signed file). Usage: seal.sh TREE KEYS FOLDER. Needs SOURCE_DATE_EPOCH.
set -euo pipefail
root=$(realpath "$1")
keys=$(realpath "$2")
out=$(realpath -m "$3")
boot=$root.boot
: "${SOURCE_DATE_EPOCH:?}"
mkdir -p "$out"
[ "$boot" -ef "$out/boot" ] || { rm -rf "${out:?}/boot"; cp -a "$boot" "$out/boot"; }
rm -f "$out/root.img"
mksquashfs "$root" "$out/root.img" -comp zstd -Xcompression-level "${PRISMESH_COMPRESSION:-12}" -b 256K -noappend -no-progress -quiet >/dev/null
size=$(stat -c %s "$out/root.img")
tree=$(((size + 4095) / 4096 * 4096))
truncate -s $tree "$out/root.img"
# The salt and the name come from the content: the same tree is the same image.
digest=$(sha256sum <"$out/root.img" | cut -c 1-64)
hex() { echo "${digest:$1:$2}"; }
veritysetup format "$out/root.img" "$out/root.img" --hash-offset=$tree --salt="$digest" \
  --uuid="$(hex 0 8)-$(hex 8 4)-$(hex 12 4)-$(hex 16 4)-$(hex 20 12)" >"$out/verity"
hash=$(sed -n 's/^Root hash:[[:space:]]*//p' "$out/verity")
echo "$hash $tree" >"$out/root.hash"

printf '%s' "boot=prismesh ro prismesh.hash=$hash prismesh.tree=$tree quiet loglevel=3 panic=30 vt.global_cursor_default=0 systemd.show_status=false rd.shell=0${PRISMESH_BOOT_ARGUMENTS:+ $PRISMESH_BOOT_ARGUMENTS}" >"$out/cmdline"
"$(dirname "$0")/kernel.sh" "$boot/linuxx64.efi.stub" "$root/usr/lib/os-release" "$out/cmdline" "$boot/vmlinuz" "$boot/initrd.img" "$out/prismesh.unsigned.efi"
sbsign --key "$keys/boot-db.key" --cert "$keys/boot-db.crt" --output "$out/prismesh.efi" "$out/prismesh.unsigned.efi" 2>/dev/null
