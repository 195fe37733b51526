#!/bin/bash
# In a container that has started an image's root: the health check says yes, and finds each planted illness. Called by image_test.py; prints
# "ok: .." or "FAILED: ..".
check=/usr/lib/prismesh/update/health
printf 'patience=6\nlate_percent=50\n' >/etc/prismesh/health.conf
# says WHAT STATUS WORDS
says() {
  local said status
  said=$($check 2>&1)
  status=$?
  if [ $status -eq "$2" ] && [[ $said == *"$3"* ]]; then echo "ok: $1: $said"; else echo "FAILED: $1: status $status, $said"; fi
}
for unit in prismesh-modeld prismesh-deviced prismesh-kiosk; do
  for _ in {1..200}; do [ "$(systemctl is-active $unit)" != active ] || break; sleep 0.1; done
done
says "a healthy station" 0 "a picture is shown, an edit outlives its server"

systemctl stop prismesh-kiosk
says "without a picture" 1 "prismesh-kiosk doesn't run"
systemctl start prismesh-kiosk

# plant NAME TEXT: this program in place of the real one, which it may call as NAME.real
plant() {
  cp /usr/bin/"$1" /tmp/"$1".real
  printf '%s\n' "$2" >/tmp/"$1"
  chmod 755 /tmp/"$1" /tmp/"$1".real
  mount --bind /tmp/"$1" /usr/bin/"$1"
}
heal() { umount /usr/bin/"$1"; }
plant prismesh-modeld $'#!/bin/sh\nexit 1'
says "a document daemon that ends at once" 1 "the document daemon doesn't start"
heal prismesh-modeld
plant prismesh-modeld $'#!/bin/sh\nrm -f /var/lib/prismesh-update/try/state/*.journal\nexec /tmp/prismesh-modeld.real "$@"'
says "a document daemon that forgets its journal" 1 "an acknowledged edit is lost"
heal prismesh-modeld
plant prismesh $'#!/bin/sh\n[ "$1" != devices ] || exec echo \'"loop":{"age_ms":3,"pid":1,"ticks":508,"ticks_late":0}\'\nexec /tmp/prismesh.real "$@"'
says "a device loop that stands" 1 "the device loop stands still"
heal prismesh
plant prismesh $'#!/bin/sh\n[ "$1" = devices ] || exec /tmp/prismesh.real "$@"\nn=$(cat /tmp/count 2>/dev/null || echo 0)\necho $((n + 100)) >/tmp/count\necho "\\"loop\\":{\\"age_ms\\":3,\\"ticks\\":$n,\\"ticks_late\\":$n}"'
echo 100 >/tmp/count
says "a device loop that is late" 1 "100 of 100 ticks"
heal prismesh
