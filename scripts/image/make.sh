#!/bin/bash
# Makes a disk image: a Debian 12 from BASE.tar with the packages of a folder, that boots by UEFI straight to the kiosk. Uses no loop device and
# mounts nothing but the root's /proc. Usage: make.sh BASE.tar PACKAGES IMAGE. Needs root.
set -euo pipefail
base=$(realpath "$1")
packages=$(realpath "$2")
image=$(realpath -m "$3")
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d "$(dirname "$image")/make-XXXXXX")
root=$work/root
end() {
  ! mountpoint -q "$root/proc" || umount "$root/proc"
  rm -rf "$work"
}
trap end EXIT

mib() { echo $(($1 * 1024 * 1024)); }
esp_mib=96
root_mib=3072 # of the partition: the decks and journals of a station lie on it

# --- the root file system ---
mkdir "$root"
tar -xf "$base" -C "$root"
mount --bind /proc "$root/proc"
mkdir "$root/tmp/packages"
cp "$packages"/prismesh_*.deb "$packages"/prismesh-station_*.deb "$root/tmp/packages/"
printf '#!/bin/sh\nexit 101\n' >"$root/usr/sbin/policy-rc.d" # starts no service in here
chmod 755 "$root/usr/sbin/policy-rc.d"
DEBIAN_FRONTEND=noninteractive chroot "$root" sh -c 'dpkg --install /tmp/packages/*.deb' >"$work/dpkg.log" 2>&1 ||
  { cat "$work/dpkg.log" >&2; exit 1; }
rm -rf "$root/tmp/packages" "$root/usr/sbin/policy-rc.d"

cp -a "$here/root/." "$root/"
chown -R root:root "$root/etc/fstab" "$root/etc/hostname" "$root/etc/hosts"
echo uninitialized >"$root/etc/machine-id"
chroot "$root" passwd --quiet --lock root
chroot "$root" systemctl --quiet enable prismesh.target seatd.service
chroot "$root" systemctl --quiet set-default graphical.target
# What would write to the disk, or wait for something that a station hasn't.
chroot "$root" systemctl --quiet mask apt-daily.timer apt-daily-upgrade.timer dpkg-db-backup.timer e2scrub_all.timer e2scrub_reap.service \
  fstrim.timer man-db.timer systemd-networkd-wait-online.service systemd-firstboot.service
chroot "$root" systemctl --quiet disable systemd-networkd.service systemd-networkd.socket 2>/dev/null || true

# The initial disk has the drivers of the disks that workstations have.
sed -i 's/^MODULES=.*/MODULES=list/; s/^COMPRESS=.*/COMPRESS=zstd/' "$root/etc/initramfs-tools/initramfs.conf"
kernel=$(basename "$(ls -d "$root"/lib/modules/*)")
chroot "$root" update-initramfs -c -k "$kernel" >"$work/initramfs.log" 2>&1 || { cat "$work/initramfs.log" >&2; exit 1; }
cp "$root/boot/vmlinuz-$kernel" "$work/vmlinuz"
cp "$root/boot/initrd.img-$kernel" "$work/initrd.img"
umount "$root/proc"
rm -rf "$root"/boot/* "$root"/vmlinuz* "$root"/initrd.img* "$root"/var/cache/* "$root"/var/lib/apt/lists/* "$root"/var/log/*.log "$root"/var/log/apt

# --- the disk: a table, the boot partition, the root partition ---
disk_mib=$((1 + esp_mib + root_mib + 1))
rm -f "$work/disk"
truncate -s ${disk_mib}M "$work/disk"
sfdisk --quiet "$work/disk" <<TABLE
label: gpt
start=1MiB, size=${esp_mib}MiB, type=uefi, name=boot
start=$((1 + esp_mib))MiB, size=${root_mib}MiB, type=4f68bce3-e8cd-4db1-96e7-fbcaf984b709, name=prismesh
TABLE

esp="$work/disk@@$(mib 1)"
mformat -i "$esp" -T $((esp_mib * 2048)) -F -v PRISMESH ::
for folder in EFI EFI/BOOT loader loader/entries; do mmd -i "$esp" "::$folder"; done
printf 'timeout 0\neditor no\n' >"$work/loader.conf"
printf 'title Prismesh\nlinux /vmlinuz\ninitrd /initrd.img\noptions root=PARTLABEL=prismesh rw quiet loglevel=3 vt.global_cursor_default=0 systemd.show_status=false\n' \
  >"$work/prismesh.conf"
mcopy -i "$esp" "$root/usr/lib/systemd/boot/efi/systemd-bootx64.efi" ::EFI/BOOT/BOOTX64.EFI
mcopy -i "$esp" "$work/loader.conf" ::loader/loader.conf
mcopy -i "$esp" "$work/prismesh.conf" ::loader/entries/prismesh.conf
mcopy -i "$esp" "$work/vmlinuz" "$work/initrd.img" ::

mke2fs -q -t ext4 -L prismesh -d "$root" -E offset="$(mib $((1 + esp_mib)))" "$work/disk" ${root_mib}M
mv "$work/disk" "$image"
echo "$image: $(du --block-size=1M "$image" | cut -f1) MB of $disk_mib MB are used"
