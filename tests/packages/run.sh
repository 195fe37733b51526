#!/bin/bash
# Tests the packages of a folder: lintian, their entries and types, and installing, upgrading, removing and purging them in a Debian 12 of
# its own (inside.sh). Usage: run.sh PACKAGES. Needs root. What can't run has failed: whoever asks for this test wants to know.
#
# Kept between runs, in PACKAGES/kept: the base system for a week, and what was downloaded.
set -euo pipefail
packages=$(realpath "$1")
here=$(cd "$(dirname "$0")" && pwd)
root_of_project=$(cd "$here/../.." && pwd)

give_up() {
  echo "FAILED: the packages weren't tested: $*"
  exit 1
}
[ "$(id -u)" -eq 0 ] || give_up "that needs root"
for tool in systemd-nspawn mmdebstrap lintian desktop-file-validate xmllint gio; do
  command -v $tool >/dev/null || give_up "$tool is missing"
done

failed=0
check() {
  local what=$1
  shift
  if "$@" >"$work/said" 2>&1; then echo "ok: $what"; else
    echo "FAILED: $what"
    sed 's/^/    /' "$work/said"
    failed=1
  fi
}

work=$(mktemp -d /tmp/prismesh-packages-XXXXXX)
trap 'rm -rf "$work"' EXIT
kept=$packages/kept
mkdir -p "$kept/archives" "$work/new" "$work/out"
version=$(dpkg-parsechangelog -l "$root_of_project/debian/changelog" -S Version)
built=("$packages"/prismesh_"${version}"_*.deb "$packages"/prismesh-station_"${version}"_*.deb)
[ -f "${built[0]}" ] && [ -f "${built[1]}" ] || give_up "there are no packages of version $version in $packages"

# --- what can be said without installing ---
lintian --fail-on error --tag-display-limit 0 "$packages"/*.changes >"$work/lintian" 2>&1 && status=0 || status=$?
grep '^[WE]:' "$work/lintian" || true
check "lintian finds no error ($(grep -c '^W:' "$work/lintian" || true) warnings)" [ "$status" -eq 0 ]
for each in "${built[@]}"; do dpkg-deb --extract "$each" "$work/files"; done
check "the desktop entry is valid" bash -c "said=\$(desktop-file-validate '$work/files/usr/share/applications/prismesh.desktop' 2>&1); echo \"\$said\"; [ -z \"\$said\" ]"
check "the icon and the types are well-formed" xmllint --noout "$work/files/usr/share/icons/hicolor/scalable/apps/prismesh.svg" \
  "$work/files/usr/share/mime/packages/prismesh.xml"
check "decks have their types, other files keep theirs" "$here/types.sh" "$work/files/usr/share/mime/packages/prismesh.xml"
check "the pages and the completion are there" bash -c "cd '$work/files/usr/share' && ls man/man1/prismesh{,-kiosk}.1.gz man/man8/prismesh-{modeld,deviced,import}.8.gz \
  bash-completion/completions/prismesh{,-kiosk,-modeld,-deviced,-import}"
check "each page that a unit names is there" bash -c "cd '$work/files' && sed -n 's|^Documentation=file:/||p' lib/systemd/system/* | sort -u |
  while read -r page; do cat \"\$page\" >/dev/null || exit 1; done"
check "programs are hardened" bash -c "for each in '$work/files'/usr/bin/*; do
  readelf -hlsdW \"\$each\" >'$work/elf'
  grep -q 'Type: *DYN' '$work/elf' && grep -q GNU_RELRO '$work/elf' && grep -q BIND_NOW '$work/elf' && grep -q __stack_chk_fail '$work/elf' || { echo \"\$each\"; exit 1; }
done"
check "nothing names the folder of the build" bash -c "! grep -rlF '$root_of_project' '$work/files'"

# The desktop entry's program: the user's own daemons and a window with the deck, from the files as they are packed; all end with the window.
from_the_desktop() (
  exec=$work/files$(sed -n 's/^Exec=\([^ ]*\) .*/\1/p' "$work/files/usr/share/applications/prismesh.desktop")
  export XDG_RUNTIME_DIR=$work/user/run XDG_STATE_HOME=$work/user/state XDG_CONFIG_HOME=$work/user/config HOME=$work/user
  mkdir -p "$work"/user/{run,state,config}
  chmod -R go= "$work/user"
  prismesh=$work/files/usr/bin/prismesh
  "$prismesh" sample --elements 2000 -o "$HOME/own deck.k" >/dev/null
  exec 3>"$work/display"
  Xvfb -displayfd 3 -screen 0 1280x1024x24 >/dev/null 2>&1 &
  x=$!
  until [ -s "$work/display" ]; do sleep 0.1; done
  DISPLAY=:$(cat "$work/display") "$exec" "$HOME/own deck.k" >"$work/desktop.log" 2>&1 &
  station=$!
  for _ in $(seq 300); do
    state=$("$prismesh" session state 2>/dev/null) && [[ "$state" == *"own deck.k"* ]] && break
    sleep 0.1
  done
  kiosk=$(pgrep -P $station -x prismesh-kiosk) && kill "$kiosk"
  wait $station
  kill $x
  echo "$state"
  cat "$work/desktop.log"
  [[ "$state" == *"own deck.k"* ]] && [ -n "$kiosk" ] && ! "$prismesh" session state 2>/dev/null
)
command -v Xvfb >/dev/null || give_up "Xvfb is missing"
check "the desktop entry opens a deck for its user" from_the_desktop

# --- the same packages with a higher version, and with changed settings: no compiler needed ---
higher=$version+test
for each in "${built[@]}"; do
  rm -rf "$work/tree"
  dpkg-deb --raw-extract "$each" "$work/tree"
  sed -i "s/^Version: .*/Version: $higher/; s/(= $version)/(= $higher)/" "$work/tree/DEBIAN/control"
  if [ -f "$work/tree/etc/prismesh/prismesh.toml" ]; then
    echo "# The settings of the next version." >>"$work/tree/etc/prismesh/prismesh.toml"
    (cd "$work/tree" && find . -path ./DEBIAN -prune -o -type f -printf '%P\0' | xargs -0 md5sum >DEBIAN/md5sums)
  fi
  name=$(basename "$each" | cut -d_ -f1)
  dpkg-deb --root-owner-group -Znone --build "$work/tree" "$work/new/$name.deb" >/dev/null
done

# --- a clean Debian 12 ---
base=$kept/base.tar
if [ -z "$(find "$base" -mtime -7 2>/dev/null)" ]; then
  # From the Debian sources of this machine, or else from Debian's own.
  apt-get indextargets --format 'deb $(SITE) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' 'Origin: Debian' 2>/dev/null |
    grep -E ' bookworm(-[a-z]+)? main$' | sort -u >"$work/sources" || true
  [ -s "$work/sources" ] && sources=("$work/sources") || sources=()
  mmdebstrap --quiet --variant=minbase --mode=root --skip=cleanup/apt/lists --include=systemd,systemd-sysv,dbus,udev,procps \
    --aptopt='APT::Install-Recommends "false"' bookworm "$base" "${sources[@]}" || { rm -f "$base"; give_up "Debian 12 couldn't be fetched"; }
fi
root=$work/root
mkdir "$root"
tar -xf "$base" -C "$root"
mkdir -p "$root/root/built" "$root/root/new" "$root/out"
for each in "${built[@]}"; do cp "$each" "$root/root/built/$(basename "$each" | cut -d_ -f1).deb"; done
cp "$work"/new/*.deb "$root/root/new/"
cp "$here/inside.sh" "$root/root/"
in_root() { systemd-nspawn -q -D "$root" --register=no --keep-unit --console=pipe --bind="$kept/archives:/var/cache/apt/archives" "$@" </dev/null; }
in_root apt-get install --yes --download-only /root/built/prismesh.deb /root/built/prismesh-station.deb >"$work/said" 2>&1 ||
  { tail -n 20 "$work/said"; give_up "their dependencies couldn't be fetched"; }

# --- in an image that is being made, without systemd running ---
cp -a --reflink=auto "$root" "$work/image"
in_image() { systemd-nspawn -q -D "$work/image" --register=no --keep-unit --console=pipe --private-network --bind="$kept/archives:/var/cache/apt/archives" "$@" </dev/null; }
check "they can be installed where systemd doesn't run" in_image env DEBIAN_FRONTEND=noninteractive \
  apt-get install --yes /root/built/prismesh.deb /root/built/prismesh-station.deb
check "with users, folders and units" in_image bash -c 'set -e; for user in modeld deviced kiosk; do getent passwd prismesh-$user; done
  [ "$(stat -c "%G %a" /var/lib/prismesh/models)" = "prismesh 2775" ]; systemctl is-enabled prismesh.target prismesh-modeld.socket prismesh-deviced.socket'
rm -rf "$work/image"

# --- with systemd ---
cat >"$root/etc/systemd/system/test.service" <<'UNIT'
[Unit]
After=basic.target
[Service]
Type=oneshot
ExecStart=/bin/bash /root/inside.sh
StandardOutput=file:/out/log
StandardError=inherit
ExecStopPost=/bin/systemctl exit
TimeoutStartSec=400s
UNIT
mkdir -p "$root/etc/systemd/system/multi-user.target.wants"
ln -s ../test.service "$root/etc/systemd/system/multi-user.target.wants/test.service"
ln -sf /lib/systemd/system/multi-user.target "$root/etc/systemd/system/default.target"
ln -sf /dev/null "$root/etc/systemd/system/systemd-firstboot.service"
SYSTEMD_NSPAWN_UNIFIED_HIERARCHY=1 timeout -k 5 420 systemd-nspawn -q -D "$root" --bind="$work/out:/out" --register=no --keep-unit --private-network \
  --bind="$kept/archives:/var/cache/apt/archives" --console=pipe -b systemd.show_status=0 </dev/null >"$work/console" 2>&1 || true
cat "$work/out/log" 2>/dev/null || { cat "$work/console"; echo "FAILED: the container didn't start"; exit 1; }
grep -q '^all is well$' "$work/out/log" || failed=1
[ $failed -eq 0 ] && echo "The packages are good." || echo "FAILED: the packages"
exit $failed
