#!/usr/bin/env python3
"""The scripts of the network and the firewall, on folders and programs in place of the system's: which settings are tried, trusted or given up, and
which rules are in force. image_test.py has the same with the real networkd and nft in a container; here each case costs a moment."""
import os
import pathlib
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2] / "scripts/image/root"
ROUTE = "default via 192.0.2.1 dev eth0 src 192.0.2.7"


class Scripts(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.top = pathlib.Path(self.folder.name)
        for name in ("bin", "site", "run", "boot", "state", "image"):
            (self.top / name).mkdir()
        (self.top / "image/70-wired.network").write_text("[Match]\nType=ether\n")
        (self.top / "image/nftables.conf").write_text("good\n")

    def tearDown(self):
        self.folder.cleanup()

    def program(self, name, text):
        path = self.top / "bin" / name
        path.write_text(f"#!/bin/sh\n{text}\n")
        path.chmod(0o755)

    def run_script(self, name, patience=1):
        text = (ROOT / "usr/lib/prismesh" / name).read_text()
        for real, here in (("/etc/systemd/network", "site"), ("/run/systemd/network", "run"), ("/run/prismesh-boot", "boot"), ("/var/lib/prismesh-update", "state"),
                           ("/usr/lib/systemd/network", "image"), ("/etc/nftables.conf", "site/nftables.conf"), ("/usr/lib/prismesh", "image")):
            text = text.replace(real, str(self.top / here))
        script = self.top / "script"
        script.write_text(text.replace("patience=60", f"patience={patience}").replace("cable=10", "cable=0"))
        script.chmod(0o755)
        return subprocess.run([script], capture_output=True, text=True, env={**os.environ, "PATH": f"{self.top / 'bin'}:{os.environ['PATH']}"}, timeout=60)

    def text(self, name):
        path = self.top / name
        return path.read_text() if path.exists() else ""


class Network(Scripts):
    def network(self, links, route="", answers=True, links_by_dhcp=None):
        """What networkd and the network say: lines of networkctl, the default route, whether a gateway answers; and the lines while the fallback is in force."""
        (self.top / "links").write_text(links)
        (self.top / "links.dhcp").write_text(links if links_by_dhcp is None else links_by_dhcp)
        fallback = self.top / "run/00-prismesh.network"
        self.program("networkctl", f'case "$*" in reload) echo reload >>{self.top}/log ;; *list*) if [ -e {fallback} ]; then cat {self.top}/links.dhcp; else cat {self.top}/links; fi ;; esac')
        self.program("busybox", f'case $1 in ip) echo "{route}" ;; arping) echo arping >>{self.top}/log; [ -e {fallback} ] || exit {0 if answers else 1} ;; esac')

    def settings(self, text="[Match]\nName=eth0\n[Network]\nAddress=192.0.2.7/24\n"):
        (self.top / "site/10-site.network").write_text(text)

    GOOD = "  1 lo loopback carrier unmanaged\n  2 eth0 ether routable configured\n"
    NONE = "  1 lo loopback carrier unmanaged\n  2 eth0 ether degraded configuring\n"
    OFF = "  2 eth0 ether off unmanaged\n"
    CABLE = "  2 eth0 ether no-carrier configuring\n"

    def test_without_settings_of_a_site_nothing_is_tried(self):
        self.network(self.NONE)
        self.assertEqual(self.run_script("network").returncode, 0)
        self.assertEqual((self.text("boot/network"), self.text("log")), ("", ""))

    def test_settings_that_work_are_trusted_from_then_on(self):
        self.settings()
        self.network(self.GOOD, ROUTE)
        self.run_script("network")
        self.assertIn("10-site.network", self.text("state/network"))
        self.assertEqual(self.text("boot/network"), "")
        self.network(self.NONE)
        self.run_script("network")
        self.assertEqual(self.text("boot/network"), "", "a network that is away at this start isn't the settings' fault")
        self.settings("[Match]\nName=eth9\n")
        self.run_script("network")
        self.assertIn("eth0 has no address", self.text("boot/network"), "changed settings are tried anew")

    def test_a_gateway_that_does_not_answer_leads_to_dhcp(self):
        self.settings()
        self.network(self.GOOD, ROUTE, answers=False)
        self.run_script("network")
        self.assertIn("the gateway 192.0.2.1 doesn't answer", self.text("boot/network"))
        self.assertIn("takes its address by DHCP", self.text("boot/network"))
        self.assertEqual(self.text("run/00-prismesh.network"), self.text("image/70-wired.network"))
        self.assertIn("reload", self.text("log"))
        self.assertEqual(self.text("state/network"), "")

    def test_settings_that_fit_no_card_lead_to_dhcp(self):
        self.settings("[Match]\nName=eth9\n")
        self.network(self.OFF, ROUTE, links_by_dhcp=self.GOOD)
        self.run_script("network")
        self.assertIn("eth0 has no address (unmanaged)", self.text("boot/network"))
        self.assertNotEqual(self.text("run/00-prismesh.network"), "")

    def test_a_network_without_a_gateway_is_one(self):
        self.settings()
        self.network(self.GOOD, answers=False)
        self.run_script("network")
        self.assertIn("10-site.network", self.text("state/network"))

    def test_without_a_cable_the_settings_are_neither_trusted_nor_given_up(self):
        self.settings()
        self.network(self.CABLE)
        self.run_script("network", patience=3600)  # which isn't waited for
        self.assertEqual((self.text("state/network"), self.text("boot/network"), self.text("run/00-prismesh.network")), ("", "", ""))

    def test_without_an_answer_by_dhcp_the_settings_stay(self):
        self.settings()
        self.network(self.NONE)
        self.run_script("network")
        self.assertIn("DHCP gives no address either", self.text("boot/network"))
        self.assertEqual(self.text("run/00-prismesh.network"), "")
        self.assertEqual(self.text("log").count("reload"), 2)

    def test_the_fallback_ends_with_the_next_start(self):
        (self.top / "run/00-prismesh.network").write_text("old\n")
        (self.top / "boot/network").write_text("old\n")
        self.network(self.GOOD)
        self.run_script("network")
        self.assertEqual((self.text("run/00-prismesh.network"), self.text("boot/network")), ("", ""))


class Firewall(Scripts):
    def setUp(self):
        super().setUp()
        self.program("nft", f'grep -q good "$2" && {{ echo "$2" >>{self.top}/log; exit 0; }}; echo "$2:3:7-9: Error: syntax error" >&2; exit 1')

    def test_rules_of_the_site_are_in_force(self):
        (self.top / "site/nftables.conf").write_text("good, of the site\n")
        self.assertEqual(self.run_script("firewall").returncode, 0)
        self.assertEqual((self.text("boot/firewall"), self.text("log").split()), ("", [str(self.top / "site/nftables.conf")]))

    def test_with_a_fault_in_them_those_of_the_image_are(self):
        (self.top / "site/nftables.conf").write_text("bad\n")
        self.assertEqual(self.run_script("firewall").returncode, 0)
        self.assertIn("nftables.conf:3:7-9: Error: syntax error", self.text("boot/firewall"))
        self.assertEqual(self.text("log").split(), [str(self.top / "image/nftables.conf")])

    def test_without_any_it_fails_and_says_so(self):
        (self.top / "site/nftables.conf").write_text("bad\n")
        (self.top / "image/nftables.conf").write_text("bad\n")
        self.assertNotEqual(self.run_script("firewall").returncode, 0)
        self.assertIn("the network stays off", self.text("boot/firewall"))


if __name__ == "__main__":
    unittest.main()
