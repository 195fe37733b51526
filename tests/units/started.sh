#!/bin/bash
# Starts the station's units for real: in a container with the host's /usr, the programs of a build folder and a fresh /etc and /var. Prints
# what inside.sh found. Usage: started.sh BUILD. Needs root and systemd-nspawn (systemd-container); exit status 77: they are missing.
set -euo pipefail
build=$(realpath "$1")
here=$(cd "$(dirname "$0")" && pwd)

skip() {
  echo "SKIPPED ALOUD: the units weren't started: $*"
  exit 77
}
[ "$(id -u)" -eq 0 ] || skip "that needs root"
command -v systemd-nspawn >/dev/null || skip "systemd-nspawn is missing (Debian's systemd-container)"
[ -x /lib/systemd/systemd ] || skip "systemd isn't installed"
[ -x "$build/bin/prismesh-kiosk" ] || skip "prismesh-kiosk isn't built"

work=$(mktemp -d /tmp/prismesh-units-XXXXXX)
trap 'rm -rf "$work"' EXIT
root=$work/root
mkdir -p "$root"/{usr,etc/prismesh,etc/systemd/system/multi-user.target.wants,var/lib,run,tmp,proc,sys,dev,root,out} "$work/out"
for folder in bin sbin lib lib64; do ln -s usr/$folder "$root/$folder"; done
cp /usr/lib/os-release "$root/etc/os-release"
cp -r /etc/ld.so.conf /etc/ld.so.conf.d /etc/ld.so.cache /etc/nsswitch.conf /etc/alternatives "$root/etc/"
[ ! -d /etc/fonts ] || cp -r /etc/fonts "$root/etc/"
: >"$root/etc/machine-id"
printf 'root:x:0:0:root:/root:/bin/bash\nnobody:x:65534:65534:nobody:/nonexistent:/usr/sbin/nologin\n' >"$root/etc/passwd"
printf 'root:x:0:\nnogroup:x:65534:\ndialout:x:20:\nvideo:x:44:\ninput:x:105:\nrender:x:106:\n' >"$root/etc/group"

DESTDIR=$work/stage cmake --install "$build" --prefix /usr >/dev/null
stage=$work/stage/usr
systemd-sysusers --root="$root" "$stage"/lib/sysusers.d/prismesh.conf
cp "$stage"/share/prismesh/roles.toml "$root/etc/prismesh/"
cat >"$root/etc/prismesh/prismesh.toml" <<'SETTINGS'
[eye_tracker]
driver = "dynasight"
simulated = true
[prism_servo]
driver = "dynamixel"
simulated = true
[haptic_pen]
driver = "simulated"
[remote]
listen = "127.0.0.1:7443"
SETTINGS
chmod -R go-w "$root/etc/prismesh"
"$build/bin/prismesh" sample --elements 2000 -o "$root/root/sample.k" >/dev/null

# The kiosk has no display here: it draws headless, a picture each fifth of a second.
mkdir -p "$root/etc/systemd/system/prismesh-kiosk.service.d"
cat >"$root/etc/systemd/system/prismesh-kiosk.service.d/headless.conf" <<'UNIT'
[Service]
ExecStart=
ExecStart=/usr/bin/prismesh-kiosk --runtime-dir /run/prismesh --size 640x480 --headless-frames 100000 --pace 0.2 --shots /var/lib/prismesh-kiosk
UNIT
cat >"$root/etc/systemd/system/test.service" <<'UNIT'
[Unit]
After=basic.target
[Service]
Type=oneshot
ExecStart=/bin/bash /root/inside.sh
StandardOutput=file:/out/log
StandardError=inherit
ExecStopPost=/bin/systemctl exit
TimeoutStartSec=100s
UNIT
cp "$here/inside.sh" "$root/root/"
ln -s ../test.service "$root/etc/systemd/system/multi-user.target.wants/test.service"
ln -s /lib/systemd/system/multi-user.target "$root/etc/systemd/system/default.target"
ln -s /dev/null "$root/etc/systemd/system/systemd-firstboot.service"

SYSTEMD_NSPAWN_UNIFIED_HIERARCHY=1 timeout -k 5 120 systemd-nspawn -q -D "$root" --volatile=overlay --overlay-ro="/usr:$stage:/usr" \
  --bind="$work/out:/out" --register=no --keep-unit --private-network --console=pipe -b systemd.show_status=0 \
  </dev/null >"$work/console" 2>&1 || true
cat "$work/out/log" 2>/dev/null || { cat "$work/console"; echo "the container didn't start"; exit 1; }
grep -q '^all is well$' "$work/out/log"
