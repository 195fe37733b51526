#!/bin/bash
# Inside of the container of run.sh, a clean Debian 12 under systemd without network: installs, upgrades, removes and purges the packages, and
# looks at what users notice. What apt would download is in its cache. In /root/built are the packages, in /root/new the same with a higher version.
run=/run/prismesh
export DEBIAN_FRONTEND=noninteractive LC_ALL=C
failed=0
ok() { echo "ok: $*"; }
bad() {
  echo "FAILED: $*"
  failed=1
}
check() {
  local what=$1
  shift
  if "$@" >/tmp/said 2>&1; then ok "$what"; else
    bad "$what"
    sed 's/^/    /' /tmp/said | tail -n 30
  fi
}
now_ms() { echo $(($(date +%s%N) / 1000000)); }
until_ms() {
  local limit=$1 began
  began=$(now_ms)
  shift
  until "$@" >/tmp/tried 2>&1; do
    [ $(($(now_ms) - began)) -lt "$limit" ] || return 1
    sleep 0.05
  done
  echo $(($(now_ms) - began))
}
is() { [ "$1" = "$2" ] || { echo "\"$1\" instead of \"$2\""; return 1; }; }
# As an unattended upgrade does: settings that both sides changed stay the user's.
apt() { apt-get --yes -o Dpkg::Options::=--force-confdef -o Dpkg::Options::=--force-confold "$@"; }
installed() { dpkg-query -W -f '${db:Status-Abbrev}${Version} ' prismesh prismesh-station 2>&1; }
services="prismesh-modeld prismesh-deviced prismesh-kiosk"
all_active() { for each in $services; do [ "$(systemctl is-active "$each")" = active ] || return 1; done; }
starts() { for each in $services; do echo "$each $(journalctl --no-pager --quiet _PID=1 --unit "$each" | grep -c ' Started ')"; done; }
pids() { for each in $services; do systemctl show -P MainPID "$each"; done; }
as_engineer() { runuser -u engineer -- "$@"; }
session() { as_engineer timeout 30 prismesh session --runtime-dir $run "$@"; }
state() { session state; }
without_count() { sed 's/; [0-9]* edits* w[a-z]* recovered.*//' "$1"; }
same_state() { state >/tmp/after && diff <(without_count /tmp/before) <(without_count /tmp/after); }
# Everything that users and administrators made, with owner, rights and text, and modeld's journals. Each start of modeld writes two small
# files of its own.
work_of_users() {
  find /var/lib/prismesh /var/lib/prismesh-modeld /home/engineer /etc/systemd/system/prismesh-kiosk.service.d /etc/prismesh/our-display.toml \
    -type f ! -name modeld.lock ! -name numbers -printf '%u %g %m ' -exec sha256sum {} \;
}
version=$(dpkg-deb --field /root/built/prismesh.deb Version) higher=$(dpkg-deb --field /root/new/prismesh.deb Version)
find / -xdev \( -path /proc -o -path /sys -o -path /root -o -path /out -o -path /tmp -o -path /var/cache -o -path /var/lib/apt \) -prune -o -iname '*prismesh*' -print >/tmp/found_before
check "the system knows nothing of Prismesh" is "$(cat /tmp/found_before)" ""

# --- installing: nothing is prepared, and there is no display for the kiosk ---
began=$(now_ms)
check "both are installed, though the kiosk can't start" apt install /root/built/prismesh.deb /root/built/prismesh-station.deb
ok "that took $(($(now_ms) - began)) ms"
check "dpkg calls them installed" is "$(installed)" "ii $version ii $version "
check "the kiosk isn't running" bash -c '[ "$(systemctl is-active prismesh-kiosk)" != active ]'
check "both daemons and the target run" systemctl is-active prismesh-modeld prismesh-deviced prismesh.target
check "all will start with the machine" systemctl is-enabled prismesh.target prismesh-modeld.socket prismesh-deviced.socket
check "the files are those of the packages" bash -c 'said=$(dpkg --verify prismesh prismesh-station); echo "$said"; [ -z "$said" ]'
check "the units are sound" bash -c 'said=$(systemd-analyze verify --man=no /lib/systemd/system/prismesh* 2>&1 | grep prismesh); echo "$said"; [ -z "$said" ]'
check "settings are the packages' configuration files" is "$(dpkg-query -W -f '${Conffiles}' prismesh-station | awk 'NF { print $1 }' | sort | xargs)" \
  "/etc/prismesh/prismesh.toml /etc/prismesh/roles.toml"
check "the version is the package's" is "$(prismesh --version)" "prismesh ${version%%[-~+]*}"
check "users' names are told" getent passwd prismesh-modeld prismesh-deviced prismesh-kiosk
check "the folder of decks belongs to the group" is "$(stat -c '%U %G %a' /var/lib/prismesh/models)" "root prismesh 2775"
check "the rules of devices are there" test -f /lib/udev/rules.d/60-prismesh.rules
check "the desktop entry starts a program" test -x "$(sed -n 's/^Exec=\([^ ]*\) .*/\1/p' /usr/share/applications/prismesh.desktop)"

# --- an administrator sets it up, an engineer works ---
sed -i 's/^#latency_ms = 10$/latency_ms = 12/' /etc/prismesh/prismesh.toml
sed -i 's/^\[eye_tracker\]$/[eye_tracker]\ndriver = "dynasight"\nsimulated = true/; s/^\[prism_servo\]$/[prism_servo]\ndriver = "dynamixel"\nsimulated = true/' /etc/prismesh/prismesh.toml
echo 'engineer = ["edit"]' >>/etc/prismesh/roles.toml
echo '# A display of our own.' >/etc/prismesh/our-display.toml
mkdir -p /etc/systemd/system/prismesh-kiosk.service.d
cat >/etc/systemd/system/prismesh-kiosk.service.d/headless.conf <<'UNIT'
[Service]
ExecStart=
ExecStart=/usr/bin/prismesh-kiosk --runtime-dir /run/prismesh --size 640x480 --headless-frames 100000 --pace 0.5 --shots /var/lib/prismesh-kiosk
UNIT
systemctl daemon-reload
useradd --create-home --groups prismesh engineer
as_engineer prismesh sample --elements 2000 -o /home/engineer/own.k >/dev/null
as_engineer cp /home/engineer/own.k /var/lib/prismesh/models/rail.k
as_engineer chmod g+w /var/lib/prismesh/models/rail.k
systemctl restart prismesh.target
check "the target is up, with a picture" until_ms 30000 all_active
check "a picture of a deck is drawn" as_engineer prismesh render /home/engineer/own.k -o /home/engineer/own.png --size 320x240
check "a deck is opened" session open /var/lib/prismesh/models/rail.k
check "a patch is selected" session edit '{"edit":"select","expr":"5000001-5000040"}'
check "and lifted" session edit '{"edit":"lift","distance":6}'
check "and saved" session save
check "it is lifted again, and not saved" session edit '{"edit":"lift","distance":3}'
check "the devices are there" timeout 5 prismesh devices --runtime-dir $run
prismesh --json doctor --runtime-dir $run --state-dir /var/lib/prismesh-modeld >/tmp/doctor
for good in units roles modeld deviced; do
  check "the doctor finds nothing wrong with $good" grep -q "\"what\":\"$good\",\"grade\":\"good\"" /tmp/doctor
done

# --- upgrading while clients ask ---
state >/tmp/before
work_of_users >/tmp/work_before
pids >/tmp/pids_before
starts >/tmp/starts_before
sha256sum /etc/prismesh/*.toml >/tmp/settings
(
  asked=0
  while [ ! -e /tmp/upgraded ]; do
    state >/tmp/asked 2>&1 || cat /tmp/asked >>/tmp/refused
    asked=$((asked + 1))
  done
  echo $asked >/tmp/asked_times
) &
asking=$!
check "both are upgraded" apt install /root/new/prismesh.deb /root/new/prismesh-station.deb
check "all run again" until_ms 30000 all_active
touch /tmp/upgraded
wait $asking
check "dpkg calls them upgraded" is "$(installed)" "ii $higher ii $higher "
check "each service was started again" bash -c 'for each in $(cat /tmp/pids_before); do [ ! -d /proc/$each ] || { echo "process $each still runs"; exit 1; }; done'
check "and once only" is "$(starts)" "$(while read -r each count; do echo "$each $((count + 1))"; done </tmp/starts_before)"
check "none of $(cat /tmp/asked_times) requests meanwhile was refused" bash -c '[ ! -s /tmp/refused ] || { sort /tmp/refused | uniq -c; exit 1; }'
check "the document is as it was" same_state
check "files of users are as they were" bash -c "$(declare -f work_of_users)"'; diff /tmp/work_before <(work_of_users)'
check "the settings are as the administrator left them" sha256sum --check --quiet /tmp/settings
check "the new settings lie beside them" test -f /etc/prismesh/prismesh.toml.dpkg-dist
check "an edit from before is undone" session undo
check "and done again" session redo
check "edits go on" session edit '{"edit":"lift","distance":-1}'

# --- a station that was switched off stays off ---
systemctl disable --now --quiet prismesh.target prismesh-modeld.socket prismesh-deviced.socket
check "the services end with their target" bash -c 'for each in '"$services"'; do [ "$(systemctl is-active $each)" != active ] || { echo $each; exit 1; }; done'
check "they are installed again" apt install --reinstall /root/new/prismesh.deb /root/new/prismesh-station.deb
check "and stay off" bash -c 'for each in '"$services"'; do [ "$(systemctl is-active $each)" != active ] || { echo $each; exit 1; }; done'
systemctl enable --now --quiet prismesh.target prismesh-modeld.socket prismesh-deviced.socket
check "until they are switched on" until_ms 30000 all_active
check "the document is open again" bash -c "timeout 20 runuser -u engineer -- prismesh session --runtime-dir $run state | grep -q rail.k"

# --- removing: programs go, settings and work stay ---
state >/tmp/before
work_of_users >/tmp/work_before
check "both are removed" apt remove prismesh prismesh-station
check "no process of theirs is left" bash -c '! ps -o pid=,args= -u prismesh-modeld,prismesh-deviced,prismesh-kiosk'
check "no socket is left" bash -c '! ls /run/prismesh/*.sock'
check "programs and units are gone" bash -c '! ls /usr/bin/prismesh* /lib/systemd/system/prismesh* /lib/udev/rules.d/*prismesh* /usr/share/prismesh 2>/dev/null'
check "settings stay" sha256sum --check --quiet /tmp/settings
check "files of users stay" bash -c "$(declare -f work_of_users)"'; diff /tmp/work_before <(work_of_users)'

# --- and back: unsaved edits are there ---
check "both are installed again" apt install /root/new/prismesh.deb /root/new/prismesh-station.deb
check "all run, with the settings and the unit's drop-in from before" until_ms 30000 all_active
check "the deck is opened with its unsaved edits" session open /var/lib/prismesh/models/rail.k
check "which are all there" same_state
check "and can be saved" session save

# --- purging: their settings go too, work stays ---
work_of_users >/tmp/work_before
check "both are purged" apt purge prismesh prismesh-station
check "their settings are gone" bash -c '! ls /etc/prismesh/prismesh.toml* /etc/prismesh/roles.toml*'
check "files of users stay" bash -c "$(declare -f work_of_users)"'; diff /tmp/work_before <(work_of_users)'
check "so do the users who own them" getent passwd prismesh-modeld prismesh-deviced prismesh-kiosk
find / -xdev \( -path /proc -o -path /sys -o -path /root -o -path /out -o -path /tmp -o -path /var/cache -o -path /var/lib/apt \
  -o -path '/var/lib/prismesh*' -o -path /home -o -path /etc/systemd/system/prismesh-kiosk.service.d -o -path /etc/prismesh \) -prune \
  -o -iname '*prismesh*' -print >/tmp/found_after
check "nothing else is left" is "$(cat /tmp/found_after)" ""
check "in /etc/prismesh only what the administrator put there" is "$(ls /etc/prismesh)" "our-display.toml"
check "dpkg doesn't know them" bash -c '! dpkg-query -W -f "\${db:Status-Abbrev}" prismesh prismesh-station 2>/dev/null | grep -v "^un"'
check "no unit has failed" bash -c 'said=$(systemctl list-units --failed --no-legend); echo "$said"; [ -z "$said" ]'

# --- the command line alone ---
check "the command line is installed alone" apt install /root/new/prismesh.deb
check "it edits a deck" as_engineer prismesh edit /home/engineer/own.k --edit '{"edit":"select","expr":"5000001-5000040"}' --edit '{"edit":"lift","distance":6}' -o /home/engineer/pulled.k
check "it says what draws pictures" bash -c 'said=$(prismesh render /home/engineer/own.k -o /tmp/a.png 2>&1); echo "$said"; [[ "$said" == *"package prismesh-station"* ]]'
check "no daemon came with it" bash -c '! ls /lib/systemd/system/prismesh*'
[ $failed -eq 0 ] && echo "all is well"
exit 0
