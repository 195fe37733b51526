#!/bin/bash
# Makes the tree of an image's root: a Debian 12 from BASE.tar with the packages of a folder, locked down, without identity. Mounts nothing
# but the tree's /proc. Usage: tree.sh BASE.tar PACKAGES VERSION KEYS FOLDER. Needs root; SOURCE_DATE_EPOCH is the age of what it makes.
set -euo pipefail
base=$(realpath "$1")
packages=$(realpath "$2")
version=$3
keys=$(realpath "$4")
root=$(realpath -m "$5")
here=$(cd "$(dirname "$0")" && pwd)
log=$root.log
: "${SOURCE_DATE_EPOCH:?}"
[[ $version =~ ^[0-9]+(\.[0-9]+)*$ ]] || { echo "tree.sh: '$version' is no version: digits and points" >&2; exit 2; }
# shellcheck disable=SC2317  # called by the trap
end() { ! mountpoint -q "$root/proc" || umount "$root/proc"; }
trap end EXIT

mkdir -p "$root"
tar -xf "$base" -C "$root"
mount --bind /proc "$root/proc"
mkdir "$root/tmp/packages"
cp "$packages"/prismesh_*.deb "$packages"/prismesh-station_*.deb "$root/tmp/packages/"
printf '#!/bin/sh\nexit 101\n' >"$root/usr/sbin/policy-rc.d" # starts no service in here
chmod 755 "$root/usr/sbin/policy-rc.d"
DEBIAN_FRONTEND=noninteractive chroot "$root" sh -c 'dpkg --install /tmp/packages/*.deb' >"$log" 2>&1 || { cat "$log" >&2; exit 1; }
rm -rf "$root/tmp/packages" "$root/usr/sbin/policy-rc.d"

cp -a --no-preserve=ownership "$here/root/." "$root/"
install -m 644 "$keys/update-ca.crt" "$root/etc/rauc/keyring.pem"
cp "$here/root/etc/nftables.conf" "$root/usr/lib/prismesh/nftables.conf" # what stays in force when a site's own has a fault
sed -i '/^IMAGE_/d' "$root/usr/lib/os-release"
printf 'IMAGE_ID=prismesh\nIMAGE_VERSION=%s\n' "$version" >>"$root/usr/lib/os-release"
mkdir -p "$root/data" "$root/etc/prismesh/ssh"
chroot "$root" passwd --quiet --lock root

# --- what runs ---
units() { chroot "$root" systemctl --quiet "$@"; }
units enable prismesh.target seatd.service nftables.service systemd-networkd.service systemd-timesyncd.service \
  tmp.mount prismesh-setup.socket prismesh-identity.service prismesh-network.service prismesh-lockdown.service prismesh-ssh.service prismesh-notice.service prismesh-update-confirm.service
units set-default graphical.target
# Logins and shells, what would write to the disk, and what waits for something that a station hasn't.
units mask getty.target getty@.service autovt@.service serial-getty@.service console-getty.service container-getty@.service debug-shell.service \
  ssh.service ssh.socket ctrl-alt-del.target kbrequest.target apt-daily.timer apt-daily-upgrade.timer dpkg-db-backup.timer e2scrub_all.timer \
  e2scrub_reap.service fstrim.timer man-db.timer systemd-networkd-wait-online.service systemd-firstboot.service systemd-repart.service systemd-binfmt.service \
  systemd-remount-fs.service systemd-fsckd.socket
mkdir -p "$root/etc/systemd/system-generators"
for generator in systemd-getty-generator systemd-debug-generator systemd-gpt-auto-generator systemd-fstab-generator systemd-bless-boot-generator; do
  ln -sf /dev/null "$root/etc/systemd/system-generators/$generator"
done

# --- the initial disk ---
sed -i 's/^MODULES=.*/MODULES=list/; s/^COMPRESS=.*/COMPRESS=zstd/; s/^BUSYBOX=.*/BUSYBOX=y/' "$root/etc/initramfs-tools/initramfs.conf"
kernel=$(basename "$(ls -d "$root"/lib/modules/*)")
chroot "$root" env SOURCE_DATE_EPOCH="$SOURCE_DATE_EPOCH" update-initramfs -c -k "$kernel" >>"$log" 2>&1 || { cat "$log" >&2; exit 1; }
umount "$root/proc"
mkdir -p "$root.boot"
mv "$root/boot/vmlinuz-$kernel" "$root.boot/vmlinuz"
mv "$root/boot/initrd.img-$kernel" "$root.boot/initrd.img"
cp "$root/usr/lib/systemd/boot/efi/linuxx64.efi.stub" "$root/usr/lib/systemd/boot/efi/systemd-bootx64.efi" "$root.boot/"

# --- no rights that a station doesn't need, no identity, nothing of this building ---
find "$root" -xdev -type f -perm /6000 -exec chmod ug-s {} +
mkdir -p "$root/usr/share/prismesh/image"
chroot "$root" dpkg-query -W -f '${Package} ${Version}\n' | LC_ALL=C sort >"$root/usr/share/prismesh/image/packages"
rm -rf "${root:?}"/boot/* "$root"/vmlinuz* "$root"/initrd.img* "$root"/etc/ssh/ssh_host_* "$root"/etc/hostname "$root"/etc/hosts "$root"/etc/resolv.conf \
  "$root"/etc/*- "$root"/etc/ld.so.cache.* "$root"/var/lib/dbus/machine-id "$root"/var/lib/systemd/random-seed "$root"/tmp/* "$root"/run/*
find "$root/var" -mindepth 1 -delete # it is on the data partition
rm -rf "$root"/etc/initramfs-tools "$root"/etc/cron.* "$root"/etc/apt "$root"/etc/init.d "$root"/etc/rc?.d "$root"/usr/share/prismesh/desktop
find "$root/usr/lib/python3" -name __pycache__ -prune -exec rm -rf {} + 2>/dev/null || true
: >"$root/etc/machine-id"
# The day of a password's last change is the day of building.
awk -F: -v OFS=: -v day=$((SOURCE_DATE_EPOCH / 86400)) '{ $3 = day; print }' "$root/etc/shadow" >"$root/etc/shadow.new"
cat "$root/etc/shadow.new" >"$root/etc/shadow"
rm "$root/etc/shadow.new"
