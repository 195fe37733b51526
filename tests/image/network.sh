#!/bin/bash
# In a container that has started an image's root with wrong network settings and a faulty firewall, on a network with DHCP (192.0.2.1, image_test.py):
# what the station made of it. Prints "ok: .." or "FAILED: ..".
check() { if eval "$2"; then echo "ok: $1"; else echo "FAILED: $1"; eval "${3:-true}" 2>&1 | sed 's/^/    /'; fi; }
wait_for() { for _ in {1..100}; do ! eval "$1" >/dev/null 2>&1 || return 0; sleep 0.1; done; return 1; }
address() { networkctl --no-pager status host0 | grep -oE '192\.0\.2\.[0-9]+'; }
told() { cat /run/prismesh-boot/firewall /run/prismesh-boot/network; }

check "faulty rules of the site are replaced by the image's own" 'nft list chain inet station input | grep -q "policy drop"' 'systemctl status nftables; nft list ruleset'
check "and the screen says so, with the line" 'grep -q "those of the image are in force: /etc/nftables.conf:1:" /run/prismesh-boot/firewall' told
check "settings whose gateway doesn't answer are given up for DHCP" 'wait_for "address | grep -qx 192.0.2.77"' 'told; networkctl --no-pager status host0'
check "and the screen says so" 'grep -q "host0 has an address, but the gateway 198.51.100.1 doesn.t answer.*takes its address by DHCP" /run/prismesh-boot/network' told
check "before the kiosk has it" 'journalctl -b -q -o cat --no-pager -u prismesh-notice | grep -q "takes its address by DHCP"' 'journalctl -b -q --no-pager -u prismesh-notice'
# timesyncd itself doesn't run in a container.
check "the clock has the server that DHCP names, and no other" 'wait_for "grep -qx NTP=192.0.2.9 /run/systemd/netif/state" && systemd-analyze cat-config systemd/timesyncd.conf | grep -qx FallbackNTP=' 'cat /run/systemd/netif/state; systemd-analyze cat-config systemd/timesyncd.conf'
check "this machine's own names need no resolver" 'getent hosts localhost && getent hosts "$(cat /etc/hostname)" | grep -q "^127.0.1.1 "' 'cat /etc/hosts'

printf '[Match]\nName=host0\n[Network]\nAddress=192.0.2.50/24\nGateway=192.0.2.1\n' >/etc/systemd/network/10-site.network
/usr/lib/prismesh/network >/dev/null 2>&1 # as at the next start, where the fallback in /run is gone
networkctl reload
check "settings that lead to a gateway are kept" 'wait_for "address | grep -qx 192.0.2.50" && /usr/lib/prismesh/network && [ ! -e /run/prismesh-boot/network ] && grep -q 10-site /var/lib/prismesh-update/network' 'told; networkctl --no-pager status host0'
printf '[Match]\nName=host0\n[Network]\nLinkLocalAddressing=ipv6\n' >/etc/systemd/network/10-site.network
networkctl reload
wait_for '! address'
/usr/lib/prismesh/network >/dev/null
check "settings without an address are given up for DHCP" 'grep -q "host0 has no address (.*takes its address by DHCP" /run/prismesh-boot/network && wait_for "address | grep -qx 192.0.2.77"' 'told; networkctl --no-pager status host0'

systemctl stop systemd-networkd.socket systemd-networkd.service nftables.service
check "a firewall that stops lets nothing more in" 'nft list chain inet station input | grep -q "policy drop"' 'nft list ruleset'
nft flush ruleset
echo bad >/tmp/bad
mount --bind /tmp/bad /usr/lib/prismesh/nftables.conf
systemctl start systemd-networkd.service 2>/tmp/said
check "without any firewall the network doesn't start" '[ "$(systemctl is-active systemd-networkd)" != active ] && grep -q "the network stays off" /run/prismesh-boot/firewall' 'cat /tmp/said; told; systemctl status systemd-networkd'
umount /usr/lib/prismesh/nftables.conf
systemctl start systemd-networkd.service
check "with one it does" '[ "$(systemctl is-active systemd-networkd)" = active ]' 'systemctl status systemd-networkd nftables'
