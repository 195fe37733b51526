#!/bin/bash
# Makes a disk of what seal.sh wrote: boot partition, two slots for the root, an empty data partition. Uses no loop device and mounts nothing.
# Usage: disk.sh SEALED VERSION KEYS DISK. Needs SOURCE_DATE_EPOCH.
set -euo pipefail
sealed=$1
version=$2
keys=$3
image=$(realpath -m "$4")
: "${SOURCE_DATE_EPOCH:?}"
work=$(mktemp -d "$(dirname "$image")/disk-XXXXXX")
trap 'rm -rf "$work"' EXIT

mib() { echo $(($1 * 1024 * 1024)); }
boot_mib=256  # three kernels
slot_mib=1024 # a root twice as large as today's
data_mib=${PRISMESH_DATA_MIB:-512} # grows to the rest of the disk at the first boot
[ "$(stat -c %s "$sealed/root.img")" -le "$(mib $slot_mib)" ] || { echo "disk.sh: the root doesn't fit into a slot of $slot_mib MB" >&2; exit 1; }

truncate -s $((1 + boot_mib + 2 * slot_mib + data_mib + 1))M "$work/disk"
# The same numbers on every disk: the station finds its parts by their names, on the disk that it starts from.
verified=4f68bce3-e8cd-4db1-96e7-fbcaf984b709
sfdisk --quiet "$work/disk" <<TABLE
label: gpt
label-id: 4d7bd8b9-6b4d-4c0e-9d5e-707269736d00
start=1MiB, size=${boot_mib}MiB, type=uefi, name=prismesh-boot, uuid=4d7bd8b9-6b4d-4c0e-9d5e-707269736d01
size=${slot_mib}MiB, type=$verified, name=prismesh-root-a, uuid=4d7bd8b9-6b4d-4c0e-9d5e-707269736d02
size=${slot_mib}MiB, type=$verified, name=prismesh-root-b, uuid=4d7bd8b9-6b4d-4c0e-9d5e-707269736d03
type=linux, name=prismesh-data, uuid=4d7bd8b9-6b4d-4c0e-9d5e-707269736d04
TABLE

part="$work/disk@@$(mib 1)"
mformat -i "$part" -T $((boot_mib * 2048)) -F -v PRISMESH -N 70726973 ::
put() { # put FILE NAME: with the image's time
  touch -d "@$SOURCE_DATE_EPOCH" "$1"
  mcopy -m -i "$part" "$1" "::$2"
}
mmd -i "$part" ::EFI ::EFI/BOOT ::EFI/Linux ::loader ::loader/keys ::loader/keys/prismesh
printf 'timeout 0\neditor no\nauto-firmware no\nauto-entries no\nsecure-boot-enroll manual\n' >"$work/loader.conf"
sbsign --key "$keys/boot-db.key" --cert "$keys/boot-db.crt" --output "$work/loader.efi" "$sealed/boot/systemd-bootx64.efi" 2>/dev/null
put "$work/loader.efi" EFI/BOOT/BOOTX64.EFI
put "$work/loader.conf" loader/loader.conf
cp "$sealed/prismesh.efi" "$work/kernel.efi"
put "$work/kernel.efi" "EFI/Linux/prismesh-$version-A.efi"
# The firmware takes them in its set-up, in this order: db, KEK, PK.
for key in db KEK PK; do
  cp "$keys/boot-$key.auth" "$work/$key.auth"
  put "$work/$key.auth" "loader/keys/prismesh/$key.auth"
done

dd if="$sealed/root.img" of="$work/disk" bs=1M seek=$((1 + boot_mib)) conv=notrunc,sparse status=none
printf 'prismesh: empty data partition\n' | dd of="$work/disk" bs=1M seek=$((1 + boot_mib + 2 * slot_mib)) conv=notrunc status=none
mv "$work/disk" "$image"
